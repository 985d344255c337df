"""The executor drives what the plan says, and says what it saw where the robot does not."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable

import pytest

from chatrobot.core.clock import TICK_S
from chatrobot.plan.steps import Drive, ObstacleWithin, Plan, RawTwist, Repeat, Turn, Wait
from chatrobot.sim.shapes import rectangle
from chatrobot.testing.rig import Rig
from chatrobot.wire.messages import Message
from chatrobot.wire.wire import M, Wire

SQUARE = Plan((Repeat(4, (Drive(distance_m=1.0), Turn(angle_rad=math.pi / 2))),))


def home_error(rig: Rig, turns: float = 0.0) -> tuple[float, float]:
    """Metres and degrees the robot truly stands off its start, after so many full turns."""
    pose = rig.robot.true_pose
    return math.hypot(pose.x_m, pose.y_m), math.degrees(pose.yaw_rad) - 360.0 * turns


def test_a_metre_is_a_metre() -> None:
    rig = Rig()
    executor = rig.run(Plan((Drive(distance_m=1.0),)))
    assert executor.outcome == "completed"
    assert rig.robot.true_pose.x_m == pytest.approx(1.0, abs=0.006)
    assert executor.planned == (pytest.approx(1.0), 0.0)


@pytest.mark.parametrize("seed", range(10))
def test_a_square_closes_although_wheels_slip_odometry_is_late_and_everything_is_noisy(seed: int) -> None:
    rig = Rig(faults=f"slip=0.03,latency_s=0.05,noise=on,seed={seed}")
    assert rig.run(SQUARE).outcome == "completed"
    off_m, off_deg = home_error(rig, turns=1)
    assert off_m < 0.03
    assert abs(off_deg) < 2.0


@pytest.mark.parametrize(
    "profile", ["wheeltec_mini_diff", "turtlebot3_burger", "turtlebot4", "originbot", "generic_diff"]
)
def test_a_square_closes_on_a_base_that_cannot_slide_sideways(profile: str) -> None:
    rig = Rig(profile)
    assert rig.run(SQUARE).outcome == "completed"
    off_m, off_deg = home_error(rig, turns=1)
    assert off_m < 0.03
    assert abs(off_deg) < 2.0


def test_timed_motion_covers_velocity_times_time() -> None:
    rig = Rig()
    rig.run(Plan((Drive(duration_s=3.0, speed_mps=0.4),)))
    assert rig.robot.true_pose.x_m == pytest.approx(1.2, abs=0.01)


def test_feedback_never_asks_for_more_than_five_percent_over_the_asked_speed() -> None:
    rig = Rig(faults="slip=0.05,noise=on,seed=3")
    rig.run(Plan((Drive(distance_m=2.0, speed_mps=0.4), Turn(angle_rad=3.0, rate_radps=0.8))))
    assert max(twist.speed_mps for twist in rig.sent) <= 0.4 * 1.05 + 1e-9
    assert max(abs(twist.wz_radps) for twist in rig.sent) <= 0.8 * 1.05 + 1e-9


def test_a_step_costs_no_time_beyond_its_trapezoid() -> None:
    rig = Rig()
    plan = Plan((Drive(distance_m=0.3), Wait(1.0), Drive(distance_m=0.3)))
    rig.run(plan)
    moving = sum(not twist.is_zero for twist in rig.sent) * 0.02
    assert moving <= 2 * (1.0 + 0.3) + 2 * 0.03


def test_silent_odometry_stops_the_robot_and_is_named() -> None:
    rig = Rig(faults="odom_silent_after_s=1.5")
    executor = rig.run(Plan((Drive(distance_m=3.0),)))
    assert executor.outcome == "failed"
    assert executor.reason is not None
    assert executor.reason.code == "odometry_silent"
    assert rig.robot.true_pose.x_m < 0.6


def test_a_robot_that_does_not_move_is_not_said_to_have_moved() -> None:
    rig = Rig(faults="stuck_after_m=0.0,blocked=stall")
    executor = rig.run(Plan((Drive(distance_m=1.0),)))
    assert executor.outcome == "failed"
    assert executor.reason is not None
    assert executor.reason.code == "does_not_move"
    assert executor.reason.values["seen_m"] == pytest.approx(0.0, abs=0.02)


def test_odometry_that_runs_backwards_is_noticed_within_half_a_metre() -> None:
    rig = Rig(faults="odom_wrong=reversed")
    executor = rig.run(Plan((Drive(distance_m=2.0),)))
    assert executor.reason is not None
    assert executor.reason.code == "moves_the_other_way"
    assert rig.robot.true_pose.x_m < 0.5


def test_wheels_that_turn_while_the_robot_does_not_are_given_away_by_the_gyro() -> None:
    rig = Rig(faults="stuck_after_m=0.0")
    executor = rig.run(Plan((Turn(angle_rad=math.pi),)))
    assert executor.reason is not None
    assert executor.reason.code == "wheels_slip"


def test_odometry_that_jumps_stops_the_robot() -> None:
    rig = Rig(faults="odom_jump_after_s=2.0")
    executor = rig.run(Plan((Drive(distance_m=3.0),)))
    assert executor.reason is not None
    assert executor.reason.code == "odometry_jumped"


def test_until_an_obstacle_stops_short_of_it() -> None:
    rig = Rig()
    rig.robot.add_obstacle("wall", rectangle(2.0, 0.0, 0.2, 2.0))
    rig.live(0.3)
    executor = rig.run(Plan((Drive(until=ObstacleWithin(0.5)), Drive(distance_m=0.2, direction_rad=math.pi))))
    assert executor.outcome == "completed"
    front = max(x for x, _ in rig.profile.footprint)
    assert 1.9 - front - (rig.robot.true_pose.x_m + 0.2) == pytest.approx(0.5, abs=0.06)


def test_a_raw_twist_beyond_the_limits_is_scaled_and_its_direction_kept() -> None:
    rig = Rig()
    assert rig.run(Plan((RawTwist(2.0, 0.0, 1.0, 1.0),))).outcome == "completed"
    fastest = max(rig.sent, key=lambda twist: twist.speed_mps)
    assert fastest.speed_mps <= 1.0 + 1e-9
    assert fastest.wz_radps / fastest.vx_mps == pytest.approx(0.5, abs=0.06)


class LateBase(Rig):
    """Its motor board does what it is told 60 ms later."""

    LATE_S = 0.06

    def wired(self, wire: Wire) -> Wire:
        self._inner, self._late = wire, deque[tuple[float, str, Message]]()
        return self

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        self._inner.subscribe(topic, kind, callback)

    def publish(self, topic: str, message: Message) -> None:
        self._late.append((self.clock.now_s() + self.LATE_S, topic, message))

    def close(self) -> None:
        self._inner.close()

    def live(self, duration_s: float) -> None:
        for _ in range(round(duration_s / TICK_S)):
            while self._late and self._late[0][0] <= self.clock.now_s() + 1e-9:
                self._inner.publish(*self._late.popleft()[1:])
            super().live(TICK_S)


@pytest.mark.parametrize("angle_deg", [30.0, 90.0, 180.0])
@pytest.mark.parametrize("kind", [Rig, LateBase])
def test_a_base_that_does_late_what_it_is_told_does_not_go_too_far(kind: type[Rig], angle_deg: float) -> None:
    rig = kind()
    turn = Plan((Turn(angle_rad=math.radians(angle_deg)),))
    rig.run(turn)
    assert math.degrees(rig.robot.true_pose.yaw_rad) == pytest.approx(angle_deg, abs=0.15)
    began_s = rig.clock.now_s()
    rig.run(turn)
    assert math.degrees(rig.robot.true_pose.yaw_rad) == pytest.approx(2.0 * angle_deg, abs=0.15)
    expected_s = math.radians(angle_deg) / 0.6 + 0.3
    assert rig.clock.now_s() - began_s == pytest.approx(expected_s, abs=0.15), "it went right there"
