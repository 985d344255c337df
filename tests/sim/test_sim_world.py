"""Worlds: what stands where, how far it is, what places are called, and what is said of a bad file."""

from __future__ import annotations

import contextlib
import math
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.core.errors import WorldError
from chatrobot.core.geometry import Pose
from chatrobot.sim.distance_field import FAR_M, RESOLUTION_M, DistanceField, build_distance_field
from chatrobot.sim.load import load_world, parse_world
from chatrobot.sim.shapes import Circle, Shape, polygon, rectangle
from chatrobot.sim.world import EMPTY_WORLD, World

HOME = load_world("home")
BODY_M = 0.25
"""Radius of a circle that holds any of the small bases, with room to spare."""


def test_the_empty_world_is_clear_everywhere() -> None:
    world = load_world("empty")
    assert world is EMPTY_WORLD
    assert world.is_empty
    assert world.clearance_m(np.array([[0.0, 0.0], [1e3, -1e3]])).min() > FAR_M / 2
    assert world.obstacle_names_at(0.0, 0.0) == ()
    assert world.bounds is None
    assert world.outline() == []


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ("kitchen", "kitchen"),
        ("Kitchen ", "kitchen"),
        ("厨房", "kitchen"),
        ("门口", "door"),
        ("门", "door"),
        ("沙发", "sofa"),
        ("couch", "sofa"),
        ("书桌", "desk"),
        ("桌子", "desk"),
        ("bed", "bedroom"),
        ("卧室", "bedroom"),
        ("充电桩", "charging dock"),
        ("tv", "TV"),
    ],
)
def test_places_of_the_home_are_known_by_many_names(said: str, name: str) -> None:
    assert HOME.place(said) == HOME.places[name]
    assert name in HOME.places


def test_a_place_nobody_knows_is_none() -> None:
    assert HOME.place("moon") is None


def reachable(world: World, radius_m: float) -> np.ndarray:
    """Grid points a disc gets to from the start."""
    field = world.distance_field
    free = field.values_m > radius_m
    seen = np.zeros_like(free)
    seen[cell(world, Pose())] = True
    while True:
        grown = seen.copy()
        grown[1:] |= seen[:-1]
        grown[:-1] |= seen[1:]
        grown[:, 1:] |= seen[:, :-1]
        grown[:, :-1] |= seen[:, 1:]
        grown &= free
        if np.array_equal(grown, seen):
            return seen
        seen = grown


def cell(world: World, pose: Pose) -> tuple[int, int]:
    field = world.distance_field
    return (
        round((pose.y_m - field.origin_y_m) / field.resolution_m),
        round((pose.x_m - field.origin_x_m) / field.resolution_m),
    )


def test_every_place_of_the_home_can_be_reached_through_its_doors() -> None:
    seen = reachable(HOME, BODY_M)
    assert [name for name, pose in HOME.places.items() if not seen[cell(HOME, pose)]] == []


def test_the_way_to_the_kitchen_leads_through_a_door() -> None:
    kitchen = HOME.places["kitchen"]
    straight = np.linspace((0.0, 0.0), (kitchen.x_m, kitchen.y_m), 200)
    assert HOME.clearance_m(straight).min() < 0.0


def test_there_is_room_to_practise_around_the_start_of_the_home() -> None:
    side = np.linspace(-1.25, 1.25, 50)
    around = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    assert HOME.clearance_m(around).min() > 0.0
    square = np.stack(np.meshgrid(np.linspace(0, 1, 30), np.linspace(0, 1, 30)), axis=-1).reshape(-1, 2)
    assert HOME.clearance_m(square).min() > BODY_M + 0.2
    ahead = np.stack((np.linspace(0.0, 2.0, 100), np.zeros(100)), axis=1)
    assert HOME.clearance_m(ahead).min() > BODY_M + 0.2


def test_the_home_knows_its_size_and_its_things() -> None:
    bounds = HOME.bounds
    assert bounds is not None
    assert bounds.max_x_m - bounds.min_x_m == pytest.approx(8.1)
    assert bounds.max_y_m - bounds.min_y_m == pytest.approx(6.1)
    sofa = HOME.places["sofa"]
    assert HOME.obstacle_names_at(sofa.x_m - 0.5, sofa.y_m) == ("sofa", "沙发")
    assert "fridge" in [name for name, _ in HOME.outline()]
    assert HOME.allowed_area is not None
    assert HOME.allowed_area.distance_m(0.0, 0.0) < 0.0


def test_the_field_of_the_home_is_computed_quickly() -> None:
    shapes = tuple(obstacle.shape for obstacle in HOME.obstacles)
    build_distance_field(shapes)
    taken_s = []
    for _ in range(3):
        start_s = time.process_time()
        build_distance_field(shapes)
        taken_s.append(time.process_time() - start_s)
    assert min(taken_s) < 0.05


SHAPES = st.lists(
    st.one_of(
        st.builds(
            rectangle,
            st.floats(-2.0, 2.0),
            st.floats(-2.0, 2.0),
            st.floats(0.02, 1.5),
            st.floats(0.02, 1.5),
            st.sampled_from([0.0, math.pi / 2, 0.3, 1.0, -2.0]),
        ),
        st.builds(Circle, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.floats(0.005, 0.8)),
        st.just(polygon(((0.0, 0.0), (1.0, 0.0), (0.2, 0.2), (0.0, 1.0)))),
    ),
    min_size=1,
    max_size=5,
)


@settings(max_examples=60, deadline=None)
@given(SHAPES, st.lists(st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0)), min_size=1, max_size=40))
def test_clearance_never_promises_more_than_there_is_and_little_less(
    shapes: list[Shape], points: list[tuple[float, float]]
) -> None:
    near = [(x, y) for shape in shapes for x, y in shape.outline()]
    field = build_distance_field(shapes)
    for (x, y), clearance_m in zip(points + near, field.clearance_m(np.array(points + near)).tolist()):
        true_m = min(shape.distance_m(x, y) for shape in shapes)
        assert clearance_m <= true_m + 1e-9
        on_grid = abs(clearance_m - true_m) <= math.sqrt(2.0) * RESOLUTION_M + 1e-9
        assert on_grid or outside(field, x, y)


def outside(field: DistanceField, x: float, y: float) -> bool:
    ny, nx = field.values_m.shape
    right_m = field.origin_x_m + (nx - 1) * field.resolution_m
    top_m = field.origin_y_m + (ny - 1) * field.resolution_m
    return not (field.origin_x_m <= x <= right_m and field.origin_y_m <= y <= top_m)


def test_far_away_the_clearance_is_about_the_distance() -> None:
    field = build_distance_field([rectangle(0.0, 0.0, 1.0, 1.0)])
    (clearance_m,) = field.clearance_m(np.array([[10.0, 0.0]])).tolist()
    assert 9.0 < clearance_m <= 9.5


def test_a_large_world_gets_a_coarser_grid_rather_than_a_slow_one() -> None:
    field = build_distance_field([Circle(-500.0, -500.0, 1.0), Circle(500.0, 500.0, 1.0)])
    assert field.values_m.size < 1.1e6
    assert field.clearance_m(np.array([[0.0, 0.0]]))[0] > 600.0


FILE = """\
start: {x_m: 1, y_m: 2, yaw_deg: 90}
allowed_area: [[0, 0], [4, 0], [4, 4], [0, 4]]
obstacles:
  - {name: pillar, circle: {x_m: 1, y_m: 3, radius_m: 0.2}}
  - {name: box, rectangle: {x_m: 3, y_m: 2, length_m: 1, width_m: 0.5, yaw_deg: 90}}
  - {name: wedge, polygon: [[0, 0], [0, 1], [1, 0]]}
  - {name: wall, wall: {from: [0, 4], to: [4, 4], thickness_m: 0.1}}
places:
  - {name: pillar, aliases: [柱子], x_m: 1, y_m: 2.5, yaw_deg: 180}
"""


def test_a_file_is_seen_from_its_start() -> None:
    world = parse_world(FILE, "room.yaml", "room")
    assert world.name == "room"
    pillar = world.obstacles[0].shape
    assert isinstance(pillar, Circle)
    assert (pillar.x_m, pillar.y_m) == pytest.approx((1.0, 0.0))
    assert world.places["pillar"] == pytest.approx((0.5, 0.0, math.pi / 2))
    assert world.place("柱子") == world.places["pillar"]
    assert world.obstacles[1].shape.distance_m(0.0, -1.75) == pytest.approx(0.0)
    assert world.obstacles[2].shape.distance_m(-1.9, 0.9) < 0.0
    assert world.obstacles[3].shape.distance_m(1.95, 0.0) == pytest.approx(0.0)
    assert world.allowed_area is not None
    assert world.allowed_area.distance_m(0.0, 0.0) == pytest.approx(-1.0)


def test_walls_that_meet_at_a_point_leave_no_gap_at_the_corner() -> None:
    world = parse_world(
        "obstacles:\n"
        "  - {name: a, wall: {from: [0, 0], to: [2, 0], thickness_m: 0.2}}\n"
        "  - {name: b, wall: {from: [2, 0], to: [2, 2], thickness_m: 0.2}}\n",
        "corner.yaml",
    )
    assert min(obstacle.shape.distance_m(2.05, -0.05) for obstacle in world.obstacles) < 0.0


def test_polygons_are_counter_clockwise_however_they_were_given() -> None:
    corners = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    assert polygon(corners).points == corners
    assert polygon(corners[::-1]).points == corners


@pytest.mark.parametrize(
    ("old", "new", "line", "named"),
    [
        ("x_m: 1, y_m: 2,", "x_m: one, y_m: 2,", 1, ("start.x_m", "'one'", "not a number")),
        ("radius_m: 0.2", "radius_m: -0.2", 4, ("obstacles[0].circle.radius_m", "-0.2", "0.001 to 1000")),
        ("radius_m: 0.2", "radius: 0.2", 4, ("obstacles[0].circle.radius", "unknown", "radius_m")),
        (", radius_m: 0.2", "", 4, ("obstacles[0].circle", "radius_m is missing")),
        ("name: box, ", "", 5, ("obstacles[1]", "name is missing")),
        ("polygon: [[0, 0], [0, 1], [1, 0]]", "polygon: [[0, 0], [0, 1]]", 6, ("at least 3 corners",)),
        ("polygon: [[0, 0], [0, 1], [1, 0]]", "polygon: [[0, 0], [0, 1], [0, 2]]", 6, ("one line",)),
        ("[0, 0], [0, 1], [1, 0]", "[0, 0, 1], [0, 1], [1, 0]", 6, ("obstacles[2].polygon[0]", "[x, y]")),
        ("wall: {from", "sphere: {from", 7, ("sphere", "unknown", "rectangle")),
        ("wall, wall: {from: [0, 4], to: [4, 4], thickness_m: 0.1}", "wall", 7, ("exactly one shape",)),
        ("to: [4, 4]", "to: [0, 4]", 7, ("the same point",)),
        ("thickness_m: 0.1", "thickness_m: .inf", 7, ("thickness_m",)),
        ("[柱子]", "[pillar]", 9, ("aliases[0]", "names the place 'pillar' already")),
        ("[柱子]", "柱子", 9, ("aliases", "must be a list")),
        ("yaw_deg: 180", "yaw_deg: 999", 9, ("yaw_deg", "999", "-360 to 360")),
        ("places:", "place:", 8, ("place", "unknown field", "places")),
        ("obstacles:", "start: {x_m: 0, y_m: 0}\nobstacles:", 3, ("start", "twice")),
        ("places:", "places: [", 8, ("YAML",)),
    ],
)
def test_a_bad_file_says_where_what_and_what_is_allowed(
    old: str, new: str, line: int, named: tuple[str, ...]
) -> None:
    assert old in FILE
    with pytest.raises(WorldError) as caught:
        parse_world(FILE.replace(old, new), "room.yaml")
    message = str(caught.value)
    assert message.startswith("room.yaml, line ")
    if "YAML" not in named:
        assert f"line {line}:" in message
    for word in named:
        assert word in message


@pytest.mark.parametrize(
    "text", ["", "# nothing", "- a list", "just text", "[" * 5000, "a: *b", "{a: 1}: 2", "\x00"]
)
def test_what_is_no_world_is_refused(text: str) -> None:
    with pytest.raises(WorldError):
        parse_world(text, "room.yaml")


@given(st.text(st.sampled_from("{}[]:,- \n*&!|>'\"#ax1.\t") | st.characters(codec="utf-8"), max_size=60))
def test_any_text_is_a_world_or_a_world_error(text: str) -> None:
    with contextlib.suppress(WorldError):
        parse_world(text, "room.yaml")


def test_a_world_is_found_by_path(tmp_path: Path) -> None:
    path = tmp_path / "room.yaml"
    path.write_text(FILE, encoding="utf-8")
    assert load_world(str(path)).name == "room"


def test_a_world_that_does_not_exist_names_those_that_do(tmp_path: Path) -> None:
    with pytest.raises(WorldError, match="empty, classroom, football, home"):
        load_world("hom")
    with pytest.raises(WorldError, match="cannot be read"):
        load_world(str(tmp_path / "none.yaml"))
