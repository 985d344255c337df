"""Where a profile limits jerk, what gains speed eases in and out; zero and a rule's braking are never made softer."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import pytest
from tests.governor.situations import ANGULAR_JERK_RADPS3, JERK_MPS3, MECANUM, smooth

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.governor.governor import Governor
from chatrobot.governor.kernel import JerkLimit, _most
from chatrobot.robots.profile import RobotProfile


class Driven:
    """A governor without a lidar, asked every 20 ms."""

    def __init__(self, profile: RobotProfile) -> None:
        self.epoch = StopEpoch()
        self.governor = Governor(replace(profile, lidar=None), self.epoch)
        self.now_s = 0.0
        self.governor.leases.open("lease", "console", math.inf, self.now_s)
        self.governor.begin("lease", self.now_s)

    def ask(self, *asked: float) -> Twist:
        self.now_s += TICK_S
        return self.governor.govern(Twist(*asked), "lease", self.now_s).sent.twist

    def until_steady(self, *asked: float) -> list[Twist]:
        sent = [ZERO_TWIST]
        while len(sent) < 2 or sent[-1] != sent[-2]:
            sent.append(self.ask(*asked))
        return sent


def accelerations(speeds: list[float]) -> list[float]:
    return [(after - before) / TICK_S for before, after in itertools.pairwise(speeds)]


def test_a_start_eases_in_and_out_of_its_acceleration() -> None:
    sent = Driven(smooth()).until_steady(0.6, 0.0, 0.0)
    gained = [0.0, *accelerations([twist.vx_mps for twist in sent])]
    assert sent[-1] == Twist(0.6, 0.0, 0.0)
    assert max(gained) == pytest.approx(MECANUM.limits.acceleration_mps2)
    for before, after in itertools.pairwise(gained):
        assert after - before <= JERK_MPS3 * TICK_S + 1e-9
        assert after - before >= -2.0 * JERK_MPS3 * TICK_S - 1e-9
    assert gained[1] == pytest.approx(JERK_MPS3 * TICK_S)
    assert gained[-2] < 0.2


def test_a_turn_eases_in_too() -> None:
    sent = Driven(smooth()).until_steady(0.0, 0.0, -1.0)
    gained = [0.0, *accelerations([-twist.wz_radps for twist in sent])]
    assert sent[-1] == Twist(0.0, 0.0, -1.0)
    assert max(gained) == pytest.approx(MECANUM.limits.angular_acceleration_radps2)
    for before, after in itertools.pairwise(gained):
        assert after - before <= ANGULAR_JERK_RADPS3 * TICK_S + 1e-9
    assert gained[1] == pytest.approx(ANGULAR_JERK_RADPS3 * TICK_S)
    assert gained[-2] < 0.5


def test_a_curve_keeps_its_shape_while_it_eases() -> None:
    for twist in Driven(smooth()).until_steady(0.4, 0.2, 0.8)[1:]:
        assert (twist.vy_mps, twist.wz_radps) == pytest.approx((0.5 * twist.vx_mps, 2.0 * twist.vx_mps))


def test_without_limits_a_start_is_the_kernels_ramp() -> None:
    sent = Driven(MECANUM).until_steady(0.6, 0.0, 0.0)
    gained = accelerations([twist.vx_mps for twist in sent])
    assert gained[:-1] == pytest.approx([MECANUM.limits.acceleration_mps2] * 30)


def test_only_the_limit_that_is_set_binds() -> None:
    linear_alone = replace(MECANUM, limits=replace(MECANUM.limits, jerk_mps3=JERK_MPS3))
    assert Driven(linear_alone).ask(0.0, 0.0, 1.0).wz_radps == pytest.approx(0.04)
    angular_alone = replace(MECANUM, limits=replace(MECANUM.limits, angular_jerk_radps3=ANGULAR_JERK_RADPS3))
    assert Driven(angular_alone).ask(1.0, 0.0, 0.0).vx_mps == pytest.approx(0.02)


def test_zero_is_exempt() -> None:
    robot = Driven(smooth())
    robot.until_steady(0.6, 0.0, 1.0)
    assert robot.ask(0.0, 0.0, 0.0).is_zero


def test_slowing_down_is_the_kernels_ramp_from_its_first_tick() -> None:
    robot = Driven(smooth())
    robot.until_steady(0.6, 0.0, 0.0)
    assert robot.ask(0.3, 0.0, 0.0).vx_mps == pytest.approx(0.6 - TICK_S * MECANUM.limits.acceleration_mps2)


def test_after_a_stop_it_eases_in_from_nothing_again() -> None:
    robot = Driven(smooth())
    first = [robot.ask(0.6, 0.0, 0.0).vx_mps for _ in range(3)]
    robot.epoch.stop()
    robot.governor.begin("lease", robot.now_s)
    assert [robot.ask(0.6, 0.0, 0.0).vx_mps for _ in range(3)] == pytest.approx(first)
    robot.ask(0.0, 0.0, 0.0)
    assert [robot.ask(0.6, 0.0, 0.0).vx_mps for _ in range(3)] == pytest.approx(first)


def test_where_a_rule_brakes_into_a_curve_the_braking_is_not_eased() -> None:
    jerk = JerkLimit(smooth().limits)
    before, wanted, target = Twist(0.5, 0.0, 0.0), Twist(0.48, 0.0, 0.04), Twist(0.1, 0.0, 0.8)
    assert jerk.eased(before, wanted, target, TICK_S, urgent=True) == wanted
    eased = jerk.eased(before, wanted, target, TICK_S, urgent=False)
    assert eased.wz_radps == pytest.approx(ANGULAR_JERK_RADPS3 * TICK_S * TICK_S)
    assert before.vx_mps - eased.vx_mps == pytest.approx(0.02 * eased.wz_radps / 0.04)


@pytest.mark.parametrize("left", [0.001, 0.02, 0.3])
@pytest.mark.parametrize("jerk", [2.0, 5.0, 40.0])
def test_no_step_adds_more_than_can_be_eased_out_again(left: float, jerk: float) -> None:
    """At the acceleration a, easing out by steps of jerk takes a²/2j + a dt/2 of what is left: just all of it."""
    step = _most(1e6, left, jerk, TICK_S)
    acceleration = step / TICK_S
    assert acceleration**2 / (2.0 * jerk) + acceleration * TICK_S / 2.0 == pytest.approx(left)


def test_no_step_adds_more_acceleration_than_the_jerk_allows() -> None:
    assert _most(0.3, 1e6, 5.0, TICK_S) == pytest.approx((0.3 + 0.1) * TICK_S)
    assert _most(-0.3, 1e6, 5.0, TICK_S) == pytest.approx(0.1 * TICK_S)


def test_where_a_rule_brakes_what_only_gains_is_eased_all_the_same() -> None:
    jerk = JerkLimit(smooth().limits)
    turns_in = jerk.eased(
        Twist(0.5, 0.0, 0.0), Twist(0.5, 0.0, 0.04), Twist(0.5, 0.0, 0.8), TICK_S, urgent=True
    )
    assert turns_in.wz_radps == pytest.approx(ANGULAR_JERK_RADPS3 * TICK_S * TICK_S)
    gains = jerk.eased(Twist(0.1, 0.0, 0.5), Twist(0.12, 0.0, 0.5), Twist(0.9, 0.0, 0.5), TICK_S, urgent=True)
    assert gains.vx_mps == pytest.approx(0.1 + JERK_MPS3 * TICK_S * TICK_S)


def test_it_goes_on_from_the_acceleration_it_has_sideways_too() -> None:
    jerk = JerkLimit(smooth().limits)
    first = Twist(0.0, 0.01, 0.0)
    jerk.note(ZERO_TWIST, first, TICK_S)
    eased = jerk.eased(first, Twist(0.0, 0.05, 0.0), Twist(0.0, 1.0, 0.0), TICK_S, urgent=False)
    assert eased.vy_mps - first.vy_mps == pytest.approx((0.5 + JERK_MPS3 * TICK_S) * TICK_S)


def test_no_time_no_easing() -> None:
    jerk = JerkLimit(smooth().limits)
    ahead = Twist(0.02, 0.0, 0.0)
    assert jerk.eased(ZERO_TWIST, ahead, Twist(1.0, 0.0, 0.0), 0.0, urgent=False) == ahead
    assert jerk.eased(ZERO_TWIST, ZERO_TWIST, Twist(1.0, 0.0, 0.0), 0.0, urgent=False) == ZERO_TWIST
    jerk.note(ZERO_TWIST, Twist(0.02, 0.0, 0.0), TICK_S)
    jerk.note(Twist(0.02, 0.0, 0.0), Twist(0.02, 0.0, 0.0), 0.0)
    first = Twist(0.02, 0.0, 0.0)
    eased = jerk.eased(first, Twist(0.06, 0.0, 0.0), Twist(1.0, 0.0, 0.0), TICK_S, urgent=False)
    assert eased.vx_mps - first.vx_mps == pytest.approx((1.0 + JERK_MPS3 * TICK_S) * TICK_S)
