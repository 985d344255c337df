"""Maps in characters: where things stand on them."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.cli.drawing.extent import Extent, extent_around, extent_of_world
from chatrobot.cli.drawing.map_text import ARROWS, arrow
from chatrobot.core.geometry import Pose
from chatrobot.sim.load import load_world
from chatrobot.sim.shapes import rectangle
from chatrobot.sim.world import EMPTY_WORLD, Obstacle, World
from tests.console.fakes import draw_map_text

TEN = Extent(0.0, 0.0, 10.0, 10.0)


def plain(lines):
    return ["".join(text for _, text in line) for line in lines]


def layer_at(lines, column, row):
    x = 0
    for layer, text in lines[row]:
        x += len(text)
        if column < x:
            return layer
    raise AssertionError("beyond the map")


@pytest.mark.parametrize("eighth", range(8))
def test_the_arrow_points_where_the_robot_looks(eighth):
    for off in (-0.3, 0.0, 0.3):
        assert arrow(eighth * math.pi / 4 + off + math.tau * (eighth - 4)) == ARROWS[eighth]


def test_x_runs_to_the_right_and_y_up():
    lines = plain(draw_map_text(EMPTY_WORLD, TEN, columns=20, rows=10, pose=Pose(9.9, 9.9)))
    assert lines[0].rstrip().endswith("→")
    assert lines[0].index("→") == 19
    lines = plain(draw_map_text(EMPTY_WORLD, TEN, columns=20, rows=10, pose=Pose(0.1, 0.1, math.pi / 2)))
    assert lines[9].startswith("↑")


def test_a_straight_way_is_a_straight_line_of_dots():
    lines = draw_map_text(EMPTY_WORLD, TEN, columns=20, rows=10, path=[(0.0, 5.1), (9.9, 5.1)])
    drawn = [line for line in plain(lines) if line.strip()]
    assert len(drawn) == 1
    assert len(set(drawn[0])) == 1
    assert layer_at(lines, 3, 4) == "path"


def test_what_was_driven_covers_what_was_predicted_and_the_robot_covers_both():
    way = [(0.0, 5.1), (9.9, 5.1)]
    lines = draw_map_text(
        EMPTY_WORLD, TEN, columns=20, rows=10, path=way, trail=[(0.0, 5.1), (5.0, 5.1)], pose=Pose(5.0, 5.1)
    )
    assert [layer_at(lines, column, 4) for column in (2, 10, 15)] == ["trail", "robot", "path"]


def test_walls_are_drawn_at_their_place():
    world = World("box", (Obstacle("box", rectangle(5.0, 5.0, 2.0, 2.0)),))
    lines = draw_map_text(world, TEN, columns=20, rows=10)
    filled = {(x, y) for y, line in enumerate(plain(lines)) for x, char in enumerate(line) if char.strip()}
    assert {x for x, _ in filled} == {8, 9, 10, 11, 12} or {x for x, _ in filled} == {8, 9, 10, 11}
    assert min(y for _, y in filled) == 4


def test_places_have_their_names_and_a_name_at_the_edge_stays_on_the_map():
    world = load_world("home")
    extent = extent_of_world(world, (), margin_m=0.1, least_m=3.0)
    lines = plain(draw_map_text(world, extent, columns=78, rows=28, names=True))
    text = "\n".join(lines)
    for name in world.places:
        assert f"•{name}" in text or f"{name}•" in text
    narrow = draw_map_text(
        World("w", places={"kitchen": Pose(9.9, 5.0)}), TEN, columns=20, rows=10, names=True
    )
    assert any(line.endswith("kitchen•") for line in plain(narrow))


def test_a_chinese_name_takes_two_cells_a_letter():
    world = World("w", places={"厨房": Pose(2.0, 5.0)})
    lines = plain(draw_map_text(world, TEN, columns=20, rows=10, names=True))
    row = next(line for line in lines if "厨房" in line)
    assert len(row) + 2 == 20


finite = st.floats(-1e6, 1e6)


@given(st.lists(st.tuples(finite, finite), max_size=6), st.integers(4, 60), st.integers(1, 20))
def test_every_line_is_as_wide_as_the_map_whatever_is_drawn(points, columns, rows):
    extent = extent_around(points, margin_m=0.5, least_m=2.0)
    lines = plain(
        draw_map_text(EMPTY_WORLD, extent, columns=columns, rows=rows, path=points, trail=points, pose=Pose())
    )
    assert len(lines) == rows
    assert {len(line) for line in lines} == {columns}


@given(st.lists(st.tuples(finite, finite), max_size=6))
def test_an_extent_holds_its_points_and_is_never_too_small(points):
    extent = extent_around(points, margin_m=0.5, least_m=2.0)
    assert all(extent.holds(*point) for point in points)
    assert extent.width_m >= 1.999
    assert extent.height_m >= 1.999
