"""Limits can be narrowed at run time, and never widened."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.governor.situations import at

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.governor.governor import Governor
from chatrobot.governor.rule import FREE, NarrowedRule
from chatrobot.robots.load import load_profile

FULL = Twist(0.0, 1.0, 2.0)


def test_nothing_is_narrowed_at_first() -> None:
    assert NarrowedRule().judge(Twist(1e9, 0.0, 1e9), at()) is FREE


def test_speed_and_rate_are_narrowed_each_for_itself() -> None:
    rule = NarrowedRule()
    rule.narrow(0.5, math.inf)
    assert rule.judge(FULL, at()).factor == 0.5
    rule.narrow(math.inf, 0.2)
    ruling = rule.judge(FULL, at())
    assert ruling.factor == pytest.approx(0.1)
    assert ruling.urgent is False
    assert ruling.reason is not None
    assert (ruling.reason.code, ruling.reason.values) == ("narrowed", {"speed_mps": pytest.approx(0.1)})


@given(st.lists(st.tuples(st.floats(0.0, allow_nan=False), st.floats(0.0, allow_nan=False)), min_size=1))
def test_no_order_of_calls_widens_a_limit(calls: list[tuple[float, float]]) -> None:
    rule, before = NarrowedRule(), 1.0
    for speed, rate in calls:
        rule.narrow(speed, rate)
        factor = rule.judge(FULL, at()).factor
        assert factor <= before
        assert factor <= speed
        before = factor


@pytest.mark.parametrize("bad", [math.nan, -0.1, -math.inf])
def test_what_is_no_limit_is_refused_and_changes_nothing(bad: float) -> None:
    rule = NarrowedRule()
    rule.narrow(0.5, 1.0)
    for speed, rate in ((bad, 0.1), (0.1, bad)):
        with pytest.raises(ValueError, match="not a limit"):
            rule.narrow(speed, rate)
    assert rule.judge(FULL, at()).factor == 0.5


def test_narrowed_to_zero_nothing_moves() -> None:
    governor = Governor(load_profile("turtlesim"), StopEpoch())
    governor.leases.open("lease", "console", math.inf, 0.0)
    governor.narrow(speed_mps=0.0)
    governor.begin("lease", 0.0)
    verdict = governor.govern(Twist(1.0, 0.0, 0.0), "lease", TICK_S)
    assert (verdict.rule, verdict.sent.twist.is_zero) == ("narrowed", True)
    assert governor.govern(Twist(0.0, 0.0, 1.0), "lease", 2 * TICK_S).rule == "acceleration"
    governor.narrow(rate_radps=0.0)
    assert governor.govern(Twist(0.0, 0.0, 1.0), "lease", 3 * TICK_S).sent.twist.is_zero
