"""What a verdict says is what was asked, what is allowed, what is sent and why; and how it comes about."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from tests.governor.situations import ANGULAR_JERK_RADPS3, MECANUM, smooth, with_safety

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.governor.governor import Governor, Verdict
from chatrobot.governor.kernel import make_kernel
from chatrobot.governor.rule import Ruling, Situation
from chatrobot.robots.profile import Circle, RobotProfile, Safety

BARE = replace(MECANUM, lidar=None)
SLOW = Twist(0.3, 0.0, 0.0)


class Wall:
    """A rule that allows a share, urgently."""

    name = "wall"

    def __init__(self) -> None:
        self.factor = 1.0

    def judge(self, asked: Twist, situation: Situation) -> Ruling:  # noqa: ARG002 - the protocol's
        return Ruling(self.factor)


def driven(profile: RobotProfile = BARE) -> tuple[Governor, StopEpoch]:
    governor = Governor(profile, epoch := StopEpoch())
    governor.leases.open("lease", "console", math.inf, 0.0)
    governor.begin("lease", 0.0)
    return governor, epoch


def said(verdict: Verdict) -> tuple[str, str, Twist, Twist, Twist]:
    return verdict.action, verdict.rule, verdict.asked, verdict.allowed, verdict.sent.twist


def test_a_pass() -> None:
    governor, _ = driven()
    tiny = Twist(0.01, 0.0, 0.0)
    verdict = governor.govern(tiny, "lease", 0.0)
    assert said(verdict) == ("passed", "", tiny, tiny, tiny)
    assert verdict.reason is None


def test_a_ramp() -> None:
    governor, _ = driven()
    assert said(governor.govern(SLOW, "lease", 0.0)) == (
        "limited", "acceleration", SLOW, SLOW, Twist(0.02, 0.0, 0.0),
    )  # fmt: skip


def test_what_rounding_leaves_is_no_speed_above_the_limit() -> None:
    """A millionth of what is asked, or a nanometre a second sideways of a base that cannot do it."""
    governor, _ = driven(replace(BARE, kinematics="differential"))
    assert governor.govern(Twist(0.3, 1e-12, 0.0), "lease", 0.0).rule == "acceleration"
    assert governor.govern(Twist(0.3, 1e-6, 0.0), "lease", 0.02).rule == "speed"


def test_a_speed_above_the_limit() -> None:
    governor, _ = driven()
    asked = Twist(2.0, 0.0, 0.0)
    verdict = governor.govern(asked, "lease", 0.0)
    assert said(verdict) == ("limited", "speed", asked, Twist(1.0, 0.0, 0.0), Twist(0.02, 0.0, 0.0))


def test_a_rule() -> None:
    governor, _ = driven(with_safety(Safety(fence=Circle(-100.0, 0.0, 100.1352)), BARE))
    verdict = governor.govern(SLOW, "lease", 0.0, ORIGIN)
    assert said(verdict) == ("limited", "fence", SLOW, ZERO_TWIST, ZERO_TWIST)
    assert verdict.reason is not None
    assert verdict.reason.code == "leaves_fence"


def test_refusals() -> None:
    governor, _ = driven()
    governor.leases.open("low", "agent", math.inf, 0.0)
    assert said(governor.govern(SLOW, "low", 0.0)) == ("refused", "outranked", SLOW, ZERO_TWIST, ZERO_TWIST)
    governor.end("lease")
    assert said(governor.govern(SLOW, "lease", 0.0)) == ("refused", "not_begun", SLOW, ZERO_TWIST, ZERO_TWIST)


def test_after_a_stop_and_a_new_beginning_the_ramp_begins_at_zero_and_not_where_it_was() -> None:
    governor, epoch = driven()
    for tick in range(60):
        governor.govern(Twist(1.0, 0.0, 0.0), "lease", tick * TICK_S)
    epoch.stop()
    governor.begin("lease", 60 * TICK_S)
    assert governor.govern(Twist(1.0, 0.0, 0.0), "lease", 60 * TICK_S).sent.twist.vx_mps <= 0.04


@pytest.mark.parametrize("full", [Twist(1.0, 0.0, 0.0), Twist(0.0, 0.0, 2.0)])
def test_a_rule_that_is_urgent_is_ramped_to_where_that_is_in_time_and_else_zero(full: Twist) -> None:
    governor, _ = driven()
    governor._rules.append(wall := Wall())
    for tick in range(60):
        governor.govern(full, "lease", tick * TICK_S)
    wall.factor = 0.97
    nearly = governor.govern(full, "lease", 60 * TICK_S).sent.twist
    assert nearly.speed_mps + abs(nearly.wz_radps) == pytest.approx(0.98 * (full.speed_mps + full.wz_radps))
    wall.factor = 0.8
    assert governor.govern(full, "lease", 61 * TICK_S).sent.twist.is_zero


def test_a_rule_that_is_not_urgent_leaves_braking_to_the_ramp_though_less_is_asked() -> None:
    governor, _ = driven()
    for tick in range(60):
        governor.govern(Twist(1.0, 0.0, 0.0), "lease", tick * TICK_S)
    governor.narrow(speed_mps=0.2)
    verdict = governor.govern(Twist(0.5, 0.0, 0.0), "lease", 60 * TICK_S)
    assert (verdict.rule, verdict.sent.twist.vx_mps) == ("narrowed", pytest.approx(0.98))


def test_braking_into_a_curve_is_eased_unless_a_rule_brakes() -> None:
    """With limited jerk a step that slows and turns in is eased as a whole; where it is urgent, not at all."""
    sent = {}
    for factor in (1.0, 0.99):
        governor, _ = driven(smooth(BARE))
        governor._rules.append(wall := Wall())
        for tick in range(60):
            governor.govern(Twist(0.5, 0.0, 0.0), "lease", tick * TICK_S)
        wall.factor = factor
        sent[factor] = governor.govern(Twist(0.47, 0.0, 0.8), "lease", 60 * TICK_S).sent.twist
    assert sent[1.0].wz_radps == pytest.approx(ANGULAR_JERK_RADPS3 * TICK_S**2)
    assert sent[0.99].wz_radps == pytest.approx(BARE.limits.angular_acceleration_radps2 * TICK_S)


def test_a_rule_at_half_speed_from_standing_is_ramped_up_to() -> None:
    governor, _ = driven()
    governor._rules.append(wall := Wall())
    wall.factor = 0.5
    for tick in range(60):
        verdict = governor.govern(Twist(1.0, 0.0, 0.0), "lease", tick * TICK_S)
        assert verdict.sent.twist.vx_mps == pytest.approx(min(0.5, 0.02 * (tick + 1)))


def test_sideways_is_ramped_like_forwards() -> None:
    kernel = make_kernel(MECANUM)
    sent = ZERO_TWIST
    for tick in range(1, 20):
        sent = kernel(sent, Twist(0.0, 0.5, 0.0), TICK_S)
        assert sent == pytest.approx(Twist(0.0, 0.02 * tick, 0.0))
    for _ in range(60):
        sent = kernel(sent, Twist(0.3, 0.1, 0.5), TICK_S)
    assert sent == pytest.approx(Twist(0.3, 0.1, 0.5), abs=1e-9)
