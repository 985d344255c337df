"""Rehearsal knows what the lidar has seen, by the governor's own measure: what passes is not stopped."""

from __future__ import annotations

import math
import random
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.dialogue.talk import Talk

from chatrobot.core.events import Finished, Rehearsed
from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.governor.contact import Footprint
from chatrobot.governor.kernel import make_kernel
from chatrobot.governor.space_rules import MARGIN_M
from chatrobot.motion import planner
from chatrobot.motion.remembered_obstacles import POINT_RADIUS_M, RememberedObstacles, Sight
from chatrobot.plan.rehearsal import MARGIN_M as REHEARSED_M
from chatrobot.plan.rehearsal import rehearse
from chatrobot.plan.text import parse_plan
from chatrobot.robots.load import load_profile
from chatrobot.sim.world import EMPTY_WORLD

MECANUM = load_profile("wheeltec_mini_mec")
FRONT_M, SIDE_M = 0.135, 0.111


def seen(*points: tuple[float, float]) -> RememberedObstacles:
    return RememberedObstacles(MECANUM, np.array(points, dtype=float).reshape(-1, 2))


def way(
    twist: Twist, duration_s: float, start: Pose = ORIGIN
) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Poses along a constant twist, as dense as a rehearsal's."""
    return np.array([start.moved(twist, t) for t in np.arange(0.0, duration_s + 1e-9, 0.02).tolist()])


def reached_m(points: RememberedObstacles, poses: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> float:
    """How far along the path nothing is too near; infinite where nothing is at all."""
    found = points.first_contact(poses)
    return math.inf if found is None else float(np.hypot(*poses[found.row, :2]))


def test_a_way_is_free_up_to_the_margin_before_what_was_seen() -> None:
    found = seen((1.0, 0.05)).first_contact(way(Twist(0.5), 4.0))
    assert found is not None
    assert (found.x_m, found.y_m) == (1.0, 0.05)
    assert reached_m(seen((1.0, 0.0)), way(Twist(0.5), 4.0)) == pytest.approx(
        1.0 - FRONT_M - REHEARSED_M, abs=0.02
    )
    assert reached_m(seen((1.0, 0.2)), way(Twist(0.5), 4.0)) == math.inf
    assert reached_m(seen((40.0, 0.0)), way(Twist(1.0), 60.0)) == pytest.approx(
        40.0 - FRONT_M - REHEARSED_M, abs=0.02
    )
    assert reached_m(seen(), way(Twist(1.0), 2.0)) == math.inf


def test_a_corner_that_swings_counts() -> None:
    beside = (0.0, SIDE_M + REHEARSED_M + 0.005)
    assert seen(beside).first_contact(way(Twist(0.0, 0.0, 0.6), 3.0)) is not None
    assert seen(beside).first_contact(way(Twist(0.3), 0.3)) is None


@pytest.mark.parametrize("gap_m", [0.005, 0.02, 0.035])
def test_from_a_wall_it_may_go_away_and_along_but_not_nearer(gap_m: float) -> None:
    wall = seen(*((x / 50.0, SIDE_M + gap_m) for x in range(-60, 61)))
    assert wall.first_contact(way(Twist(0.3), 1.0)) is None
    assert wall.first_contact(way(Twist(-0.3), 1.0)) is None
    assert wall.first_contact(way(Twist(0.0, -0.3, 0.0), 1.0)) is None
    assert wall.first_contact(way(Twist(0.0, 0.3, 0.0), 1.0)) is not None
    assert wall.first_contact(way(Twist(0.0, 0.0, 0.6), 1.0)) is not None
    there_and_back = np.vstack(
        [way(Twist(0.0, -0.3, 0.0), 1.0), way(Twist(0.0, 0.3, 0.0), 1.0, Pose(0.0, -0.3, 0.0))]
    )
    assert wall.first_contact(there_and_back) is not None, "what has left it may not come back so near"


def test_the_way_to_what_was_seen_straight_on() -> None:
    points = seen((2.0, 0.0), (1.5, 0.5), (-1.0, 0.0), (0.0, 3.0))
    assert points.free_ahead_m(ORIGIN, 0.0) == pytest.approx(2.0 - FRONT_M)
    assert points.free_ahead_m(ORIGIN, math.pi) == pytest.approx(1.0 - FRONT_M)
    assert points.free_ahead_m(ORIGIN, math.pi / 2) == pytest.approx(3.0 - SIDE_M)
    assert points.free_ahead_m(Pose(0.0, 0.5, 0.0), 0.0) == pytest.approx(1.5 - FRONT_M)
    assert points.free_ahead_m(Pose(2.0, -1.0, math.pi / 2), 0.0) == pytest.approx(1.0 - FRONT_M)
    assert points.free_ahead_m(ORIGIN, -math.pi / 2) == math.inf
    edge = SIDE_M + POINT_RADIUS_M
    assert seen((1.0, edge - 0.001)).free_ahead_m(ORIGIN, 0.0) < math.inf
    assert seen((1.0, edge + 0.001)).free_ahead_m(ORIGIN, 0.0) == math.inf


@settings(deadline=None, max_examples=100)
@given(
    st.lists(st.tuples(st.floats(-0.8, 0.8), st.floats(-0.8, 0.8)), min_size=1, max_size=8),
    st.floats(-0.5, 0.5),
    st.floats(-0.5, 0.5),
    st.floats(-1.0, 1.0),
)
def test_what_passes_keeps_the_governors_margin_or_what_there_was(
    points: list[tuple[float, float]], vx: float, vy: float, wz: float
) -> None:
    poses = way(Twist(vx, vy, wz), 1.5)
    if seen(*points).first_contact(poses) is not None:
        return
    body = Footprint(MECANUM.footprint)
    least = [body.nearest_m(local(points, Pose(*pose)), 1.0) for pose in poses.tolist()]
    assert min(least) >= min(MARGIN_M, least[0]) - 0.006, (
        "poses between two that were looked at are that near"
    )


def local(points: list[tuple[float, float]], pose: Pose) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    return np.array([Pose(x, y).relative_to(pose)[:2] for x, y in points])


# --- in a session: nothing is known of the flat but what the lidar sees ---


@pytest.fixture
def unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    """Motion knows no map of the furnished flat that the robot is in."""
    make = planner.Planner.__init__
    monkeypatch.setattr(
        planner.Planner, "__init__", lambda self, profile, _: make(self, profile, EMPTY_WORLD)
    )


@pytest.mark.usefixtures("unknown")
def test_what_only_the_lidar_sees_is_in_the_way_and_the_rest_is_offered() -> None:
    talk = Talk(world="home")
    blocked = talk.session.do("forward 5 m")
    assert (blocked.outcome, blocked.path_m) == ("refused", 0.0)
    assert re.match(
        r"Something is in the way: I would be within 0\.04 m of it after 2\.\d\d m, so I do not drive that\.",
        blocked.reply,
    )
    assert blocked.proposal is not None
    done = talk.session.do("yes")
    assert (done.outcome, done.path_m) == ("completed", pytest.approx(2.65, abs=0.02))
    assert talk.session.do("turn left 45 degrees").outcome == "refused", (
        "a corner would touch, and it is said before"
    )
    assert talk.session.do("back 50 cm").outcome == "completed"


@pytest.mark.usefixtures("unknown")
def test_a_drive_up_to_something_is_rehearsed_up_to_what_was_seen() -> None:
    talk = Talk(world="home")
    turn = talk.session.say_plan("drive forward until obstacle within 0.5 m")
    talk.pump_until(lambda: turn in talk.results())
    assert talk.results()[turn].outcome == "completed"
    assert talk.results()[turn].path_m == pytest.approx(2.2, abs=0.05)


# --- where the lidar does not see, the robot is slow, and the estimate knows it ---


@pytest.mark.parametrize(
    ("faults", "text", "at_least_s"),
    [
        ("lidar_zeros=on", "forward 1 m", 9.9),
        ("lidar_zeros=on", "turn left, then back 50 cm", 7.0),
        ("lidar_fov_deg=180", "back 1 m", 9.9),
        ("lidar_fov_deg=180", "forward 1 m", 3.0),
        ("lidar_fov_deg=180", "turn left, then circle with radius 50 cm, then back 50 cm", 15.0),
        ("", "back 1 m", 3.0),
    ],
)
def test_the_estimate_of_a_plan_s_time_is_that_of_the_speed_that_will_be_allowed(
    faults: str, text: str, at_least_s: float
) -> None:
    talk = Talk(sim=faults)
    result = talk.session.do(text)
    rehearsed = next(event for event in talk.events if isinstance(event, Rehearsed))
    assert result.outcome == "completed"
    assert result.duration_s > at_least_s
    assert rehearsed.duration_s == pytest.approx(result.duration_s, rel=0.03)


def test_a_blind_robot_that_may_not_go_blind_is_stopped_and_the_estimate_is_finite() -> None:
    careful = replace(MECANUM, safety=replace(MECANUM.safety, blind_speed_mps=0.0))
    assert MECANUM.lidar is not None
    blind = RememberedObstacles(careful, np.empty((0, 2)), Sight(careful, MECANUM.lidar, None))
    rehearsal = rehearse(parse_plan("drive 1 m"), careful, None, ORIGIN, make_kernel(careful), seen=blind)
    assert rehearsal.ok
    assert rehearsal.duration_s < 5.0


COMMANDS = (
    "forward 2 m", "forward 30 cm", "turn left 90", "turn right 45", "back 30 cm", "back 1 m", "turn left 30",
    "curve left radius 50 cm 90 degrees", "slide left 50 cm", "slide right 50 cm", "turn around",
)  # fmt: skip


@pytest.mark.usefixtures("unknown")
@pytest.mark.parametrize("seed", range(2))
def test_what_was_rehearsed_is_not_stopped_by_what_was_seen_before(seed: int) -> None:
    chance, talk = random.Random(seed), Talk(world="home")
    for _ in range(25):
        said = chance.choice(COMMANDS)
        result = talk.session.do(said)
        if result.proposal is not None:
            result = talk.session.do("yes")
        assert result.outcome in ("completed", "refused"), (said, result.reply)
    stops = [
        e for e in talk.events if isinstance(e, Finished) and e.reason and e.reason.code == "obstacle_ahead"
    ]
    assert not stops
