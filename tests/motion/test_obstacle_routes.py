"""A way leads around what the lidar has seen and the map does not know; where none does it says what is in the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.dialogue.test_session import Talk

from chatrobot.core.events import Rehearsed, Result
from chatrobot.core.geometry import ORIGIN
from chatrobot.motion import planner
from chatrobot.motion.planner import Planner
from chatrobot.motion.remembered_obstacles import (
    ENOUGH_M,
    POINT_RADIUS_M,
    RememberedObstacles,
    RoutesAroundObstacles,
    _Field,
    with_seen,
)
from chatrobot.plan.context import Route
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.sim.world import EMPTY_WORLD, World

MECANUM = load_profile("wheeltec_mini_mec")
HOME = load_world("home")


def knows(monkeypatch: pytest.MonkeyPatch, world: World) -> None:
    """Motion's map, whatever stands around the robot."""
    make = planner.Planner.__init__
    monkeypatch.setattr(planner.Planner, "__init__", lambda self, profile, _: make(self, profile, world))


def go(talk: Talk, x_m: float, y_m: float) -> Result:
    turn = talk.session.say_plan(f"go to {x_m} {y_m}")
    talk.pump_until(lambda: turn in talk.results())
    return talk.results()[turn]


@pytest.mark.parametrize("place", ["kitchen", "desk", "door"])
def test_in_a_flat_without_a_map_it_goes_around_what_it_sees(
    monkeypatch: pytest.MonkeyPatch, place: str
) -> None:
    knows(monkeypatch, EMPTY_WORLD)
    talk = Talk(world="home")
    goal = HOME.places[place]
    end = go(talk, goal.x_m, goal.y_m)
    assert (end.outcome, end.pose.distance_to(goal) < 0.05) == ("completed", True), end.reply


@pytest.mark.parametrize(
    ("place", "missing"), [("table", "kitchen wall"), ("bedroom", "bedroom wall"), ("door", "sofa")]
)
def test_what_the_map_does_not_know_is_gone_around(
    monkeypatch: pytest.MonkeyPatch, place: str, missing: str
) -> None:
    """Nothing else of the flat is in the map's way to anywhere."""
    goal = HOME.places[place]
    unaware = replace(HOME, obstacles=tuple(one for one in HOME.obstacles if one.name != missing))
    lengths_m = [
        done.rehearsal.length_m
        for world in (unaware, HOME)
        if (done := Planner(MECANUM, world).plan(1, f"go to {goal.x_m} {goal.y_m}", ORIGIN)).rehearsal
    ]
    assert lengths_m[0] < lengths_m[1] - 0.05, "the map leads through it"
    knows(monkeypatch, unaware)
    end = go(Talk(world="home"), goal.x_m, goal.y_m)
    assert (end.outcome, end.pose.distance_to(goal) < 0.05) == ("completed", True), end.reply


def wall(x_m: float, low_m: float, high_m: float) -> list[tuple[float, float]]:
    return [(x_m, y_m) for y_m in np.arange(low_m, high_m, 0.05).tolist()]


def planned(points: list[tuple[float, float]], text: str, world: World = EMPTY_WORLD) -> planner.Planned:
    return Planner(MECANUM, world).plan(1, text, ORIGIN, seen=RememberedObstacles(MECANUM, np.array(points)))


def test_where_what_was_seen_leaves_no_way_it_says_what_is_in_it() -> None:
    box = [*wall(1.0, -1.0, 1.0), *wall(-1.0, -1.0, 1.0)]
    box += [(x_m, side) for x_m in np.arange(-1.0, 1.0, 0.05).tolist() for side in (-1.0, 1.0)]
    blocked = planned(box, "go to 3 0")
    assert blocked.refusal is not None
    assert blocked.refusal.code == "would_collide"
    assert blocked.possible == "go to 0.8 0" or blocked.possible


def test_a_goal_in_what_was_seen_is_refused_and_the_nearest_free_point_offered() -> None:
    blocked = planned([(x, y) for x, y in wall(2.0, -0.3, 0.3)], "go to 2 0")
    assert blocked.refusal is not None
    assert blocked.refusal.code == "target_blocked"
    assert "obstacle" not in blocked.refusal.values
    assert blocked.possible.startswith("go to ")


@settings(deadline=None, max_examples=60)
@given(st.lists(st.tuples(st.floats(0.4, 2.6), st.floats(-0.8, 0.8)), min_size=1, max_size=12))
def test_a_route_around_what_was_seen_passes_its_rehearsal(points: list[tuple[float, float]]) -> None:
    routes = RoutesAroundObstacles(MECANUM, EMPTY_WORLD, np.array(points), None)
    found = routes.route(ORIGIN, (3.0, 0.0), named_place=False)
    assert isinstance(found, Route)
    done = planned(points, "go to 3 0")
    assert done.ok, done.refusal
    assert RememberedObstacles(MECANUM, np.array(points)).first_contact(done.rehearsal.path[:, 1:]) is None  # type: ignore[union-attr]


@given(
    st.lists(st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)), min_size=1, max_size=20),
    st.lists(st.tuples(st.floats(-6.0, 6.0), st.floats(-6.0, 6.0)), min_size=1, max_size=20),
)
@settings(deadline=None, max_examples=60)
def test_the_field_never_promises_more_room_than_there_is(
    points: list[tuple[float, float]], asked: list[tuple[float, float]]
) -> None:
    seen, at = np.array(points), np.array(asked)
    truth = np.hypot(*(at[:, None, :] - seen[None, :, :]).transpose(2, 0, 1)).min(axis=1) - POINT_RADIUS_M
    found = _Field.of(seen).at(at)
    assert (found <= np.maximum(truth, ENOUGH_M) + 1e-9).all()
    assert (found >= np.minimum(truth, ENOUGH_M) - 0.06).all()
    assert (found[truth < ENOUGH_M] <= truth[truth < ENOUGH_M] + 1e-9).all()


def test_a_world_with_what_was_seen_keeps_what_it_knows() -> None:
    known = HOME.obstacles[0].shape.outline()[0]
    seen = np.array([known, (0.0, 0.7), (0.005, 0.7)])
    assert len(with_seen(HOME, seen).obstacles) == len(HOME.obstacles) + 1
    assert with_seen(HOME, seen[:1]) is HOME


def test_a_program_is_refused_for_what_only_the_lidar_has_seen(
    monkeypatch: pytest.MonkeyPatch, tmp_path: object
) -> None:
    knows(monkeypatch, EMPTY_WORLD)
    talk = Talk(world="home", programs=True, folder=tmp_path)
    blocked = talk.session.do("Generate a ROS 2 Python program to drive forward 4 m.")
    assert blocked.outcome == "refused"
    assert blocked.reason is not None
    assert blocked.reason.code == "would_collide"
    assert blocked.reason.values["total_m"] == pytest.approx(2.66, abs=0.05)
    assert [event.ok for event in talk.events if isinstance(event, Rehearsed)] == [False]
    talk.connection.close()
