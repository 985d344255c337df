from __future__ import annotations

import math
import statistics
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.plan.context import Finding
from chatrobot.plan.lowering import CoreWalk, PlannedMotion
from chatrobot.plan.rehearsal import MARGIN_M, Rehearsal, rehearse
from chatrobot.plan.steps import Plan
from chatrobot.plan.swept_path import outline_points, transformed
from chatrobot.plan.text import parse_plan
from chatrobot.robots.profile import RobotProfile
from tests.plan.kernels import gentle_brake, half_speed, pass_all, steady
from tests.plan.plans import plans
from tests.plan.robots import ACKERMANN, DIFFERENTIAL, MECANUM
from tests.plan.worlds import NOTHING, WALL_AHEAD, BoxWorld, flat


def rehearsed(
    text: str, world: BoxWorld | None = NOTHING, start: Pose = ORIGIN, profile: RobotProfile = MECANUM
) -> Rehearsal:
    return rehearse(parse_plan(text), profile, world, start, pass_all)


def refusal(rehearsal: Rehearsal) -> Finding:
    assert rehearsal.refusal is not None
    assert not rehearsal.ok
    return rehearsal.refusal


SQUARE_AND_ARCS = """
repeat 4
  drive 0.5 m
  turn left 90 deg
end
arc left 180 deg radius 0.3 m
arc right 180 deg radius 0.3 m
"""


def test_a_square_ends_where_it_began_and_takes_its_time() -> None:
    result = rehearsed("repeat 4\n drive 1 m\n turn left 90 deg\nend")
    assert result.ok
    assert result.end_pose == pytest.approx((0, 0, 2 * math.pi), abs=1e-9)
    side_s = 1 / 0.3 + 0.3 / 1.0
    corner_s = math.pi / 2 / 0.6 + 0.6 / 2.0
    assert result.duration_s == pytest.approx(4 * (side_s + corner_s))
    assert result.length_m == pytest.approx(4.0, abs=1e-6)


def test_the_path_is_dense_and_in_order_even_through_waits() -> None:
    path = rehearsed('drive 1 m\nwait 2 s\nsay "hi"\narc left 90 deg radius 0.5 m').path
    gaps = np.diff(path[:, 0])
    assert path[0].tolist() == [0, 0, 0, 0]
    assert (gaps >= 0).all()
    assert gaps.max() <= 0.05 + 1e-9
    moved = np.hypot(*np.diff(path[:, 1:3], axis=0).T)
    assert moved.max() <= 0.3 * 0.02 + 1e-9


def test_a_wall_in_the_way_refuses_and_says_after_how_far() -> None:
    found = refusal(rehearsed("drive 0.5 m\nturn left 360 deg\ndrive 2 m", WALL_AHEAD))
    assert found.reason.code == "would_collide"
    assert found.index == (2,)
    assert found.reason.values["obstacle"] == "box 0"
    assert found.reason.values["distance_m"] == pytest.approx(2.0 - 0.5 - 0.2 - MARGIN_M, abs=0.02)
    assert found.reason.values["total_m"] == pytest.approx(1.78, abs=0.02)


def test_a_turn_that_swings_a_corner_into_a_wall_is_refused() -> None:
    close = Pose(2.0 - 0.23, 0, 0)
    assert rehearsed("drive 0.2 m left", WALL_AHEAD, close).ok
    assert refusal(rehearsed("turn left 90 deg", WALL_AHEAD, close)).reason.code == "would_collide"


def test_a_robot_at_a_wall_may_leave_it_but_not_push_on() -> None:
    touching = Pose(2.0 - 0.205, 0, 0)
    assert rehearsed("drive 1 m back", WALL_AHEAD, touching).ok
    assert not rehearsed("drive 0.05 m", WALL_AHEAD, touching).ok


def test_a_robot_deep_inside_something_stays_there() -> None:
    assert not rehearsed("drive 1 m back", WALL_AHEAD, Pose(2.05, 0, 0)).ok


def test_leaving_the_allowed_area_is_refused() -> None:
    world = BoxWorld([], area=[(-1, -1), (1, -1), (1, 1), (-1, 1)])
    assert rehearsed("drive 0.7 m", world).ok
    assert refusal(rehearsed("drive 1 m", world)).reason.code == "leaves_area"
    assert refusal(rehearsed("drive 1 m\ndrive 1 m back", world)).reason.code == "leaves_area"
    assert rehearsed("drive 1 m back", world, Pose(1.5, 0, 0)).ok


def test_an_area_with_a_corner_cut_out_is_seen_as_it_is() -> None:
    world = BoxWorld([], area=[(-1, -1), (3, -1), (3, 1), (1, 1), (1, 3), (-1, 3)])
    assert rehearsed("drive 2 m\ndrive 2 m back\ndrive 2 m left", world).ok
    assert not rehearsed("drive 1.5 m\ndrive 1.5 m left", world).ok


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("drive 1 m at 5 m/s", "speed_above_limit"),
        ("repeat 1000\nwait 10 s\nend", "lasts_too_long"),
        ("drive 3000 s", "lasts_too_long"),
        ("drive 1 m at 1e-300 m/s", "lasts_too_long"),
        ("drive 1e300 m", "lasts_too_long"),
        ("go to 1e300 1e300", "too_far"),
        ("go to 1100 0 at 1 m/s", "too_far"),
    ],
)
def test_what_cannot_be_done_is_refused(text: str, code: str) -> None:
    long_wait = "wait 1000 s\n" if code == "lasts_too_long" else ""
    assert refusal(rehearsed(long_wait + text)).reason.code == code


def test_a_raw_twist_beyond_the_limits_is_limited_not_refused() -> None:
    result = rehearsed("twist 2 0 0 for 1 s")
    assert result.ok
    (found,) = result.findings
    assert (found.severity, found.reason.code) == ("note", "limited")
    assert found.reason.values["possible_mps"] == pytest.approx(1.0)
    assert result.end_pose.x_m == pytest.approx(1.0)


def test_a_governor_that_lets_less_through_shortens_the_prediction() -> None:
    result = rehearse(parse_plan("drive 1 m\ndrive 1 m"), MECANUM, NOTHING, ORIGIN, half_speed)
    assert result.end_pose.x_m == pytest.approx(1.0, abs=0.02)
    assert [found.reason.code for found in result.findings] == ["limited", "limited"]


def test_a_governor_with_the_robots_own_accelerations_passes_every_ramp() -> None:
    result = rehearse(parse_plan(SQUARE_AND_ARCS), MECANUM, NOTHING, ORIGIN, steady)
    assert result.findings == ()


def test_a_governor_that_brakes_more_gently_than_the_plan_is_noticed_too() -> None:
    result = rehearse(parse_plan("drive 1 m"), MECANUM, NOTHING, ORIGIN, gentle_brake)
    assert result.end_pose.x_m > 1.02
    assert [found.reason.code for found in result.findings] == ["limited"]


def test_driving_until_an_obstacle_foresees_where_it_stops() -> None:
    result = rehearsed("drive forward until obstacle within 0.5 m\nturn left 90 deg\ndrive 1 m", WALL_AHEAD)
    assert result.ok
    assert result.end_pose[:2] == pytest.approx((2.0 - 0.2 - 0.5, 1.0), abs=0.03)
    sideways = rehearsed("drive left until obstacle within 0.3 m", WALL_AHEAD, Pose(0, 0, -math.pi / 2))
    assert sideways.end_pose.x_m == pytest.approx(2.0 - 0.15 - 0.3, abs=0.03)


def test_driving_until_an_obstacle_that_is_not_known_goes_all_the_way_and_says_so() -> None:
    result = rehearsed("drive 3 m until obstacle within 0.5 m")
    assert result.end_pose.x_m == pytest.approx(3.0)
    assert [found.reason.code for found in result.findings] == ["no_obstacle_known"]
    near = rehearsed("drive 0.5 m until obstacle within 0.5 m", WALL_AHEAD)
    assert near.end_pose.x_m == pytest.approx(0.5)


def test_go_finds_its_way_through_a_door_and_says_when_there_is_none() -> None:
    result = rehearsed("go to 6 0 facing 90 deg", flat())
    assert result.ok, result.findings
    assert result.end_pose == pytest.approx((6, 0, math.pi / 2), abs=1e-6)
    assert refusal(rehearsed("go to 6 0", flat(door_m=0.4))).reason.code == "no_route"


def test_the_frame_start_is_the_plans_own_even_when_it_is_continued() -> None:
    plan, here = parse_plan("go to 0 0 from start"), Pose(3, 1, 0)
    assert rehearse(plan, MECANUM, None, here, pass_all).end_pose == here
    continued = rehearse(plan, MECANUM, None, here, pass_all, plan_start=ORIGIN)
    assert continued.end_pose[:2] == pytest.approx((0, 0), abs=1e-9)


def test_the_executor_gets_the_motions_that_were_rehearsed() -> None:
    result = rehearsed("go to 6 0", flat())
    items = [item for item in CoreWalk(result.plan, result.context) if isinstance(item, PlannedMotion)]
    assert items[-1].end == pytest.approx(result.end_pose, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(
    plans, st.sampled_from([MECANUM, DIFFERENTIAL, ACKERMANN]), st.sampled_from([NOTHING, WALL_AHEAD, flat()])
)
def test_any_plan_is_rehearsed_or_refused_and_never_breaks(
    plan: Plan, profile: RobotProfile, world: BoxWorld
) -> None:
    result = rehearse(plan, profile, world, ORIGIN, pass_all)
    assert np.isfinite(result.path).all()
    assert result.duration_s <= 3600.0


near = st.builds(
    lambda x, y, left, angle: (
        f"drive {x} m\nturn {left} {angle} deg\ndrive {y} m\narc {left} {angle} deg radius 0.4 m"
    ),
    st.floats(0.05, 3),
    st.floats(0.05, 3),
    st.sampled_from(["left", "right"]),
    st.integers(1, 360),
)


@settings(max_examples=60, deadline=None)
@given(near)
def test_a_plan_that_would_touch_anything_is_always_refused(text: str) -> None:
    world = flat()
    result = rehearsed(text, world)
    placed = transformed(outline_points(MECANUM.footprint), result.path[:, 1:])
    touches = bool((world.clearance_m(placed.reshape(-1, 2)) <= 0.0).any())
    assert not (touches and result.ok)
    free = bool((world.clearance_m(placed.reshape(-1, 2)) > MARGIN_M + 0.001).all())
    assert result.ok or not free


def test_a_square_and_arcs_of_twenty_seconds_are_rehearsed_in_ten_milliseconds() -> None:
    world, plan = flat(), parse_plan(SQUARE_AND_ARCS)
    took = []
    for _ in range(11):
        began = time.perf_counter()
        result = rehearse(plan, MECANUM, world, ORIGIN, pass_all)
        took.append(time.perf_counter() - began)
    assert 20.0 <= result.duration_s <= 40.0
    assert statistics.median(took) < 0.050, (
        "ten milliseconds on an idle machine; this leaves room for a busy one"
    )


def test_the_samples_are_the_trajectorys_own() -> None:
    from chatrobot.plan.swept_path import sample_poses, sample_ramp, tick_times
    from chatrobot.plan.trajectory import RampedTwist, Segment

    for twist in (Twist(0.3, 0.1, 0.5), Twist(0.3, 0.1, 1e-7), Twist(0.2, 0, 0), Twist(0, 0, -1.0)):
        for hold_s in (0.01, 0.2, 3.0):
            segment = Segment(RampedTwist.within(MECANUM.limits, twist, hold_s), Pose(1, 2, 0.5))
            times = tick_times(segment.total_s, 0.02)
            s = sample_ramp(segment.ramp, times)
            poses = sample_poses(segment, s)
            for i, t in enumerate(times):
                assert s[i] == pytest.approx(segment.ramp.at(float(t))[0], abs=1e-9)
                assert poses[i] == pytest.approx(segment.at(float(t))[0], abs=1e-9)
