"""From the allowed share of a twist the robot comes to rest within the free way, and no sooner than it must."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.governor.situations import MECANUM

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Twist
from chatrobot.governor.kernel import CREEP_MPS, Braking

LIMITS = replace(
    MECANUM.limits,
    acceleration_mps2=1.0,
    deceleration_mps2=1.5,
    angular_acceleration_radps2=2.0,
    latency_s=0.05,
)
LATENCY_S = 0.05 + TICK_S


def test_the_slower_of_ramp_and_brakes_counts() -> None:
    weak = replace(LIMITS, deceleration_mps2=0.5)
    ahead = Twist(0.5, 0.0, 0.0)
    assert Braking(LIMITS, ahead).horizon_s == pytest.approx(LATENCY_S + 0.5 / 2.0 + 0.3)
    assert Braking(weak, ahead).horizon_s == pytest.approx(LATENCY_S + 0.5 / 1.0 + 0.3)


def test_the_slower_of_driving_and_turning_counts() -> None:
    assert Braking(LIMITS, Twist(0.0, 0.0, -2.0)).horizon_s == pytest.approx(LATENCY_S + 0.5 / 1.0 + 0.3)
    assert Braking(LIMITS, Twist(0.5, 0.0, 2.0)).horizon_s == pytest.approx(LATENCY_S + 0.5 / 1.0 + 0.3)
    assert Braking(LIMITS, Twist(0.0, 1.0, 0.2)).horizon_s == pytest.approx(LATENCY_S + 0.5 / 1.0 + 0.3)


@given(st.floats(0.05, 1.0), st.floats(0.0, 2.0), st.floats(0.0, 3.0))
def test_latency_and_braking_fit_into_the_free_way(speed: float, rate: float, free_s: float) -> None:
    braking = Braking(LIMITS, Twist(speed, 0.0, rate))
    factor = braking.factor_within(free_s)
    per_s = min(1.0 / speed, 2.0 / rate if rate else math.inf)
    needed_s = factor * LATENCY_S + factor**2 / (2.0 * per_s)
    assert needed_s <= free_s + 1e-9
    if 0.0 < factor < 1.0:
        assert needed_s == pytest.approx(free_s), "not slower than it must be"


def test_the_whole_way_is_all_there_is() -> None:
    braking = Braking(LIMITS, Twist(0.5, 0.0, 0.0))
    assert braking.factor_within(math.inf) == 1.0
    assert braking.factor_within(LATENCY_S + 0.25) == 1.0
    assert braking.factor_within(LATENCY_S + 0.5) == 1.0, "never more than was asked"
    assert braking.factor_within(LATENCY_S + 0.24) < 1.0
    assert braking.factor_within(0.0) == 0.0


def test_a_robot_does_not_crawl() -> None:
    creeping_s = CREEP_MPS / 0.5 * LATENCY_S
    assert Braking(LIMITS, Twist(0.5, 0.0, 0.0)).factor_within(0.9 * creeping_s) == 0.0
    assert Braking(LIMITS, Twist(0.5, 0.0, 0.0)).factor_within(1.1 * creeping_s) > 0.0
    assert Braking(LIMITS, Twist(0.5, 0.0, 2.0)).factor_within(0.9 * creeping_s) > 0.0, "it still turns"
    turning_s = 0.02 / 2.0 * LATENCY_S
    assert Braking(LIMITS, Twist(0.0, 0.0, -2.0)).factor_within(0.9 * turning_s) == 0.0
    assert Braking(LIMITS, Twist(0.0, 0.0, -2.0)).factor_within(1.1 * turning_s) > 0.0
    assert Braking(LIMITS, Twist(0.5, 0.0, 0.001)).factor_within(1.1 * creeping_s) > 0.0


@pytest.mark.parametrize("tiny", [5e-324, 1e-300, 1e-30])
def test_a_twist_of_next_to_nothing_gives_finite_numbers(tiny: float) -> None:
    for twist in (Twist(tiny, 0.0, 0.0), Twist(0.0, 0.0, tiny)):
        braking = Braking(LIMITS, twist)
        assert math.isfinite(braking.horizon_s)
        assert braking.factor_within(0.0) == 0.0
        assert braking.factor_within(0.5) == 1.0
