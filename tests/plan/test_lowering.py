from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

import pytest

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.plan.context import Impossible, LoweringContext, NoRoute, Route
from chatrobot.plan.lowering import CoreWalk, PlannedMotion, lower
from chatrobot.plan.steps import (
    Arc,
    Drive,
    Face,
    Go,
    ObstacleWithin,
    Plan,
    RawTwist,
    Remember,
    Repeat,
    Say,
    Step,
    Turn,
    Wait,
)
from chatrobot.plan.trajectory import CoreMotion, Emit, Pause, RampedTwist
from chatrobot.robots.profile import RobotProfile
from tests.plan.robots import ACKERMANN, DIFFERENTIAL, MECANUM


def motions(
    step: Step, profile: RobotProfile = MECANUM, pose: Pose = ORIGIN, start: Pose = ORIGIN
) -> list[CoreMotion]:
    lowered = lower(step, LoweringContext(profile, pose, start))
    assert not isinstance(lowered, Impossible), lowered
    return list(lowered)


def end(step: Step, profile: RobotProfile = MECANUM, pose: Pose = ORIGIN, start: Pose = ORIGIN) -> Pose:
    for motion in motions(step, profile, pose, start):
        pose = motion.end(pose)
    return pose


def refusal(step: Step, profile: RobotProfile = MECANUM, pose: Pose = ORIGIN) -> Reason:
    lowered = lower(step, LoweringContext(profile, pose))
    assert isinstance(lowered, Impossible), lowered
    return lowered.reason


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        (Drive(distance_m=1.5), Pose(1.5, 0, 0)),
        (Drive(distance_m=1, direction_rad=math.pi), Pose(-1, 0, 0)),
        (Drive(duration_s=2, direction_rad=math.pi / 2, speed_mps=0.2), Pose(0, 0.4, 0)),
        (Drive(duration_s=2), Pose(0.6, 0, 0)),
        (Turn(angle_rad=math.pi), Pose(0, 0, math.pi)),
        (Turn(duration_s=2, left=False, rate_radps=1.0), Pose(0, 0, -2)),
        (Arc(0.5, math.pi / 2), Pose(0.5, 0.5, math.pi / 2)),
        (Arc(0.5, math.pi / 2, left=False), Pose(0.5, -0.5, -math.pi / 2)),
        (Arc(0.5, math.pi / 2, left=True, backward=True), Pose(-0.5, 0.5, -math.pi / 2)),
        (Arc(0.5, math.pi / 2, left=False, backward=True), Pose(-0.5, -0.5, math.pi / 2)),
        (RawTwist(0.2, 0, 0, 3), Pose(0.6, 0, 0)),
        (Go(1, 1), Pose(1, 1, math.pi / 4)),
        (Go(1, 1, yaw_rad=0.0), Pose(1, 1, 0)),
        (Go(-1, 0), Pose(-1, 0, 0)),
        (Go(-4, 0), Pose(-4, 0, math.pi)),
        (Go(0, 0), Pose(0, 0, 0)),
        (Face(math.pi / 2), Pose(0, 0, math.pi / 2)),
        (Wait(2), ORIGIN),
    ],
)
def test_a_step_ends_where_it_says(step: Step, expected: Pose) -> None:
    assert end(step) == pytest.approx(expected, abs=1e-9)


def test_frames_start_and_odom_differ_once_the_plan_began_elsewhere() -> None:
    start = Pose(1, 2, math.pi / 2)
    assert end(Go(1, 0, frame="start"), pose=start, start=start)[:2] == pytest.approx((1, 3))
    assert end(Go(1, 0), pose=start, start=start)[:2] == pytest.approx((1, 0))
    assert end(Face(0.0), pose=Pose(1, 2, 2.0), start=start).yaw_rad == pytest.approx(math.pi / 2)
    assert end(Face(0.0, frame="odom"), pose=Pose(1, 2, 2.0), start=start).yaw_rad == pytest.approx(0)


def test_face_takes_the_short_way_and_keeps_whole_turns() -> None:
    assert end(Face(math.radians(-170)), pose=Pose(0, 0, math.radians(170))).yaw_rad == pytest.approx(
        math.radians(190)
    )


def test_a_target_slightly_off_straight_behind_is_reversed_to() -> None:
    made = motions(Go(-1, 0.1))
    assert isinstance(made[-1], RampedTwist)
    assert made[-1].twist.vx_mps < 0
    assert end(Go(-1, 0.1))[:2] == pytest.approx((-1, 0.1))


def test_defaults_are_the_profiles_and_never_above_a_sideways_limit() -> None:
    assert motions(Drive(distance_m=1))[0] == RampedTwist.within(MECANUM.limits, Twist(0.3), 1 / 0.3)
    slow = replace(MECANUM, limits=replace(MECANUM.limits, max_sideways_mps=0.1))
    sideways = motions(Drive(distance_m=1, direction_rad=math.pi / 2), slow)[0]
    assert isinstance(sideways, RampedTwist)
    assert sideways.twist == pytest.approx((0, 0.1, 0))


def test_limits_said_in_other_units_are_not_lost_to_rounding() -> None:
    assert motions(Drive(distance_m=1, speed_mps=1.0 + 1e-12))


@pytest.mark.parametrize(
    ("step", "profile", "code", "values"),
    [
        (Drive(distance_m=1, speed_mps=2), MECANUM, "speed_above_limit", {"asked_mps": 2, "max_mps": 1.0}),
        (
            Drive(distance_m=1, speed_mps=0.9, direction_rad=math.pi / 2),
            MECANUM,
            "speed_above_limit",
            {"asked_mps": 0.9, "max_mps": 0.6},
        ),
        (
            Drive(distance_m=1, speed_mps=0.9, direction_rad=math.pi / 4),
            MECANUM,
            "speed_above_limit",
            {"asked_mps": 0.9, "max_mps": pytest.approx(0.6 * math.sqrt(2))},
        ),
        (Drive(distance_m=1, direction_rad=math.pi / 2), DIFFERENTIAL, "sideways_impossible", None),
        (RawTwist(0, 0.2, 0), DIFFERENTIAL, "sideways_impossible", None),
        (Turn(angle_rad=1, rate_radps=3), MECANUM, "rate_above_limit", {"asked_radps": 3, "max_radps": 2.0}),
        (Face(1, rate_radps=3), MECANUM, "rate_above_limit", None),
        (Arc(0.2, 1, speed_mps=0.8), MECANUM, "rate_above_limit", None),
        (Arc(2, 1, speed_mps=1.8), MECANUM, "speed_above_limit", None),
        (Arc(0.2, 1), ACKERMANN, "turning_radius_too_small", {"radius_m": 0.2, "min_radius_m": 0.4}),
        (Turn(angle_rad=1), ACKERMANN, "cannot_turn_on_the_spot", {"angle_rad": 1, "min_radius_m": 0.4}),
        (Face(1), ACKERMANN, "cannot_turn_on_the_spot", None),
        (RawTwist(0, 0, 1), ACKERMANN, "cannot_turn_on_the_spot", None),
        (RawTwist(0.1, 0, 1), ACKERMANN, "turning_radius_too_small", None),
        (Go(1, 0, speed_mps=3), MECANUM, "speed_above_limit", None),
        (Drive(until=ObstacleWithin(0.5)), DIFFERENTIAL, "needs_lidar", None),
    ],
)
def test_the_impossible_is_refused_with_numbers(
    step: Step, profile: RobotProfile, code: str, values: dict[str, float] | None
) -> None:
    reason = refusal(step, profile)
    assert reason.code == code
    if values is not None:
        assert dict(reason.values) == values


def test_a_raw_twist_beyond_the_limits_is_scaled_in_its_direction() -> None:
    (motion,) = motions(RawTwist(2.0, 0.0, 1.0, 2.0))
    assert isinstance(motion, RampedTwist)
    assert motion.twist == Twist(1.0, 0.0, 0.5)
    assert motion.asked == Twist(2.0, 0.0, 1.0)
    assert motion.hold_s == 2.0


def test_standing_still_talking_and_remembering_are_no_motion() -> None:
    assert motions(RawTwist(0, 0, 0, 2)) == [Pause(2)]
    assert motions(Wait(3)) == [Pause(3)]
    assert motions(Say("hi")) == [Emit("say", "hi")]
    assert motions(Remember("dock")) == [Emit("remember", "dock")]


@pytest.mark.parametrize("goal", [(3.0, 1.0), (-2.0, 0.5), (0.1, 0.3), (0.0, -1.0)])
@pytest.mark.parametrize("yaw", [None, 2.0])
def test_a_steering_base_goes_there_forward_on_its_turning_circle(
    goal: tuple[float, float], yaw: float | None
) -> None:
    pose = Pose(0.2, -0.1, 0.7)
    made = motions(Go(*goal, yaw_rad=yaw), ACKERMANN, pose)
    for motion in made:
        assert isinstance(motion, RampedTwist)
        assert motion.twist.vx_mps > 0
        assert abs(motion.twist.wz_radps) <= motion.twist.vx_mps / 0.4 * (1 + 1e-9)
        pose = motion.end(pose)
    assert pose[:2] == pytest.approx(goal, abs=1e-6)
    if yaw is not None:
        assert math.cos(pose.yaw_rad - yaw) == pytest.approx(1.0, abs=1e-9)


class _Detour:
    def route(self, start: Pose, goal: tuple[float, float], *, named_place: bool) -> Route | NoRoute:
        assert start is not None
        return Route(((0.0, 1.0), goal)) if named_place else NoRoute(Reason("no_route"))


def test_go_follows_the_route_or_says_that_there_is_none() -> None:
    context = LoweringContext(MECANUM, route_planner=_Detour())
    lowered = lower(Go(1, 1, place="desk"), context)
    assert isinstance(lowered, Sequence)
    assert len(lowered) == 4
    assert lower(Go(1, 1), context) == Impossible(Reason("no_route"))


def test_the_walk_chains_ideal_ends_through_repeats() -> None:
    side = (Drive(distance_m=1), Turn(angle_rad=math.pi / 2))
    items = list(CoreWalk(Plan((Repeat(4, side), Say("done"))), LoweringContext(MECANUM)))
    assert all(isinstance(item, PlannedMotion) for item in items)
    planned = [item for item in items if isinstance(item, PlannedMotion)]
    assert [item.index for item in planned] == [(0, 0), (0, 1)] * 4 + [(1,)]
    assert [item.number for item in planned] == list(range(1, 10))
    assert {item.total_steps for item in planned} == {9}
    assert planned[-1].end == pytest.approx((0, 0, 2 * math.pi), abs=1e-9)
    for before, after in itertools.pairwise(planned):
        assert before.end == after.start


def test_the_walk_goes_on_from_where_a_motion_really_ended() -> None:
    walk = CoreWalk(
        Plan((Drive(until=ObstacleWithin(0.5)), Turn(angle_rad=1), Go(0, 0))), LoweringContext(MECANUM)
    )
    next(walk)
    walk.ended_at(Pose(2, 0, 0))
    turned = next(walk)
    assert isinstance(turned, PlannedMotion)
    assert turned.start == Pose(2, 0, 0)
    assert list(walk)[-1].end[:2] == pytest.approx((0, 0), abs=1e-9)  # type: ignore[union-attr]


def test_the_walk_ends_at_the_first_impossible_step_and_names_it() -> None:
    plan = Plan((Drive(distance_m=1), Repeat(2, (Wait(1), Turn(angle_rad=1, rate_radps=9)))))
    items = list(CoreWalk(plan, LoweringContext(MECANUM)))
    assert isinstance(items[-1], Impossible)
    assert items[-1].index == (1, 1)
    assert len(items) == 3


def test_a_step_without_motion_is_still_walked_over() -> None:
    (item,) = CoreWalk(Plan((Face(0.0),)), LoweringContext(MECANUM))
    assert isinstance(item, PlannedMotion)
    assert item.motion is None
    assert item.first
    assert item.last


def test_a_block_is_walked_not_lowered() -> None:
    with pytest.raises(TypeError, match="CoreWalk"):
        lower(Repeat(2, (Wait(1),)), LoweringContext(MECANUM))
