from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.plan.context import NoRoute, Route
from chatrobot.plan.route import GridRoutePlanner
from tests.plan.robots import MECANUM
from tests.plan.worlds import NOTHING, BoxWorld, flat

ROUND = replace(
    MECANUM, footprint=((0.1768, -0.1768), (0.1768, 0.1768), (-0.1768, 0.1768), (-0.1768, -0.1768))
)
"""Its circle has a radius of 0.25 m."""


def route(
    world: BoxWorld, goal: tuple[float, float], start: Pose = ORIGIN, *, named: bool = False
) -> Route | NoRoute:
    return GridRoutePlanner(world, ROUND).route(start, goal, named_place=named)


def along(start: Pose, found: Route) -> np.ndarray:
    points = np.array([(start.x_m, start.y_m), *found.waypoints])
    legs = [np.linspace(a, b, 200) for a, b in itertools.pairwise(points)]
    return np.concatenate(legs)


def test_an_empty_world_is_crossed_in_a_straight_line() -> None:
    assert route(NOTHING, (500.0, 500.0)) == Route(((500.0, 500.0),))


def test_a_free_straight_leg_needs_no_search() -> None:
    assert route(flat(), (0.0, 3.0)) == Route(((0.0, 3.0),))


def test_a_door_of_eighty_centimetres_is_passed_in_its_middle_in_few_legs() -> None:
    world = flat()
    found = route(world, (6.0, 0.0))
    assert isinstance(found, Route)
    assert found.waypoints[-1] == (6.0, 0.0)
    assert len(found.waypoints) <= 5
    path = along(ORIGIN, found)
    assert world.clearance_m(path).min() > 0.25 + 0.02
    in_door = path[np.abs(path[:, 0] - 4.0) < 0.05]
    assert np.abs(in_door[:, 1] - 3.0).max() < 0.08


def test_a_detour_is_no_longer_than_it_need_be() -> None:
    world = BoxWorld([(1.0, -1.0, 2.0, 1.0)])
    found = route(world, (3.0, 0.0))
    assert isinstance(found, Route)
    points = [(0.0, 0.0), *found.waypoints]
    length = sum(np.hypot(b[0] - a[0], b[1] - a[1]) for a, b in itertools.pairwise(points))
    around_the_corners = 2 * np.hypot(1.0, 1.25) + 1.0
    assert length < 1.25 * around_the_corners


def test_no_way_is_said_and_not_forced() -> None:
    found = route(flat(door_m=0.45), (6.0, 0.0))
    assert isinstance(found, NoRoute)
    assert found.reason.code == "no_route"


@pytest.mark.parametrize("named", [True, False])
def test_a_goal_inside_something_is_refused_with_the_free_point_nearest_to_it(named: bool) -> None:
    blocked = route(flat(), (2.0, 1.5), named=named)
    assert isinstance(blocked, NoRoute)
    assert blocked.reason.code == "target_blocked"
    values = blocked.reason.values
    assert values["obstacle"] == "box 6"
    end = float(values["nearest_x_m"]), float(values["nearest_y_m"])
    assert values["short_m"] == pytest.approx(np.hypot(end[0] - 2.0, end[1] - 1.5))
    assert flat().clearance_m(np.array([end]))[0] >= 0.25
    assert isinstance(route(flat(), end), Route)


def test_a_place_that_is_a_little_too_tight_is_gone_to_all_the_same() -> None:
    world = BoxWorld([(2.0, -1.0, 2.1, 1.0)])
    place = route(world, (1.72, 0.0), named=True)
    assert isinstance(place, Route)
    end = place.waypoints[-1]
    assert 0.0 < np.hypot(end[0] - 1.72, end[1]) <= 0.1


def test_of_points_that_are_as_near_the_one_on_the_robots_side_is_named() -> None:
    blocked = route(BoxWorld([(1.7, -0.3, 2.3, 0.3)]), (2.0, 0.0), named=True)
    assert isinstance(blocked, NoRoute)
    assert blocked.reason.values["nearest_x_m"] < 2.0
    assert blocked.reason.values["nearest_y_m"] == pytest.approx(0.0, abs=0.05)


WALLED_IN = [
    (1.5, -0.9, 1.6, 0.9),
    (2.9, -0.9, 3.0, 0.9),
    (1.5, -1.0, 3.0, -0.9),
    (1.5, 0.9, 3.0, 1.0),
    (2.1, -0.1, 2.3, 0.1),
]
"""A box in a room without a door, around (2.2, 0)."""


@pytest.mark.parametrize("boxes", [[(0.5, -2.5, 6.0, 2.5)], WALLED_IN], ids=["far", "walled in"])
def test_no_point_is_named_that_is_far_away_or_has_no_way_to_it(boxes: list[tuple[float, ...]]) -> None:
    found = route(BoxWorld(boxes), (3.0, 0.0) if boxes is not WALLED_IN else (2.2, 0.0), named=True)  # type: ignore[arg-type]
    assert isinstance(found, NoRoute)
    assert found.reason.code == "target_blocked"
    assert "nearest_x_m" not in found.reason.values


def test_a_robot_parked_at_a_wall_finds_its_way_out_and_back() -> None:
    parked = Pose(-1.0 + 0.2, 0.0, 0.0)
    assert isinstance(route(flat(), (6.0, 0.0), parked), Route)
    assert isinstance(route(flat(), (parked.x_m, parked.y_m), Pose(6, 0, 0)), Route)


def test_a_goal_absurdly_far_behind_a_wall_is_refused_without_a_grid() -> None:
    found = route(flat(), (1e6, 0.0))
    assert isinstance(found, NoRoute)


def test_the_same_question_gets_the_same_answer() -> None:
    planner = GridRoutePlanner(flat(), ROUND)
    first = planner.route(ORIGIN, (6.0, 0.0), named_place=False)
    planner.route(Pose(6, 0, 0), (0.0, 4.0), named_place=False)
    assert planner.route(ORIGIN, (6.0, 0.0), named_place=False) == first


boxes = st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(0.1, 1.5), st.floats(0.1, 1.5)).map(
    lambda b: (b[0], b[1], b[0] + b[2], b[1] + b[3])
)
points = st.tuples(st.floats(-4, 4), st.floats(-4, 4))


@settings(max_examples=60, deadline=None)
@given(st.lists(boxes, min_size=1, max_size=8), points, points)
def test_a_route_never_leads_through_anything(
    found_boxes: list[tuple[float, float, float, float]],
    start: tuple[float, float],
    goal: tuple[float, float],
) -> None:
    world = BoxWorld(found_boxes)
    ends = world.clearance_m(np.array([start, goal]))
    assume(ends.min() > 0.29)
    found = route(world, goal, Pose(*start))
    if isinstance(found, Route):
        assert found.waypoints[-1] == goal
        assert world.clearance_m(along(Pose(*start), found)).min() >= 0.24


@pytest.mark.parametrize("goal", [(6.0, 0.0), (6.5, 4.5), (4.0, 3.0), (-0.5, 4.5)])
def test_every_corner_of_the_flat_is_reached(goal: tuple[float, float]) -> None:
    assert isinstance(route(flat(), goal), Route)
