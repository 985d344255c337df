"""A battery that runs low."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from tests.governor.situations import MECANUM, battery, with_safety

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.governor.governor import Governor
from chatrobot.governor.rule import FREE, BatteryRule, Sensed, at_most
from chatrobot.robots.profile import Safety

FULL_SPEED = Twist(1.0, 0.0, 0.0)
RULE = BatteryRule(MECANUM, 20.0)


def test_below_the_mark_no_motion_begins() -> None:
    refused = RULE.judge(ZERO_TWIST, battery(19.9, begins=True))
    assert refused.factor == 0.0
    assert refused.reason is not None
    assert (refused.reason.code, refused.reason.values) == (
        "battery_low",
        {"percent": 19.9, "low_percent": 20.0},
    )
    assert RULE.judge(ZERO_TWIST, battery(20.0, begins=True)).factor == 1.0


def test_what_is_under_way_goes_on_at_half_speed_and_rate() -> None:
    assert RULE.judge(FULL_SPEED, battery(10.0)).factor == 0.5
    assert RULE.judge(Twist(0.0, 0.0, 2.0), battery(10.0)).factor == 0.5
    assert RULE.judge(Twist(0.5, 0.0, 1.0), battery(10.0)) is FREE
    ruling = RULE.judge(FULL_SPEED, battery(10.04))
    assert ruling.urgent is False
    assert ruling.reason == Reason("battery_low", {"percent": 10.0, "low_percent": 20.0})


def test_half_is_half_of_what_the_profile_allows() -> None:
    slow = replace(MECANUM, limits=replace(MECANUM.limits, max_speed_mps=0.4, max_rate_radps=0.5))
    rule = BatteryRule(slow, 20.0)
    assert rule.judge(Twist(0.4, 0.0, 0.0), battery(10.0)).factor == 0.5
    assert rule.judge(Twist(0.0, 0.0, -0.5), battery(10.0)).factor == 0.5


@pytest.mark.parametrize("percent", [None, math.nan, 20.0, 100.0])
def test_a_battery_that_is_full_or_unknown_limits_nothing(percent: float | None) -> None:
    assert RULE.judge(FULL_SPEED, battery(percent)).factor == 1.0


def test_it_slows_down_along_the_ramp_and_not_at_once() -> None:
    governor = Governor(
        with_safety(Safety(battery_low_percent=20.0, blind_speed_mps=9.0)), epoch := StopEpoch()
    )
    governor.leases.open("lease", "console", math.inf, 0.0)
    assert governor.begin("lease", 0.0, Sensed(battery_percent=50.0)).refusal is None
    now_s = 0.0
    for _ in range(80):
        now_s += TICK_S
        governor.govern(FULL_SPEED, "lease", now_s, None, Sensed(battery_percent=50.0))
    sent = [governor.govern(FULL_SPEED, "lease", now_s + TICK_S, None, Sensed(battery_percent=10.0))]
    for tick in range(2, 60):
        low = Sensed(battery_percent=10.0)
        sent.append(governor.govern(FULL_SPEED, "lease", now_s + tick * TICK_S, None, low))
    assert sent[0].sent.twist.vx_mps == pytest.approx(0.98)
    assert (sent[0].rule, sent[0].action) == ("battery", "limited")
    assert sent[-1].sent.twist.vx_mps == pytest.approx(0.5)
    assert epoch.value == 0


def test_the_share_that_keeps_to_a_speed_and_a_rate() -> None:
    assert at_most(Twist(0.3, 0.4, 0.0), 0.25, 9.0) == 0.5
    assert at_most(Twist(0.3, 0.4, 4.0), 0.25, 1.0) == 0.25
    assert at_most(Twist(0.3, 0.4, -4.0), 9.0, 1.0) == 0.25
    assert at_most(Twist(0.3, 0.4, 1.0), 0.5, 1.0) == 1.0
