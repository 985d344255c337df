"""The map of ROS's map_server as a world: what is occupied stands there, at the size that the file says."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from chatrobot.core.errors import WorldError
from chatrobot.core.geometry import Pose
from chatrobot.plan.context import Route
from chatrobot.plan.route import GridRoutePlanner
from chatrobot.robots.load import load_profile
from chatrobot.sim.edges import Edges
from chatrobot.sim.load import load_world
from chatrobot.sim.map_server import _merged

YAML = """\
image: {image}
resolution: 0.05
origin: [-1.0, -2.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.25
"""


def drawn(folder: Path, more: str = "", image: str = "map.pgm", yaml: str = YAML, mode: str = "L") -> str:
    """A room of 4 x 3 m in unknown surroundings, its walls 10 cm thick, a doorway in the wall across its middle."""
    pixels = np.full((80, 100), 205, dtype=np.uint8)
    pixels[10:70, 10:90] = 0
    pixels[12:68, 12:88] = 254
    pixels[12:68, 49:51] = 0
    pixels[32:50, 49:51] = 254
    picture = Image.fromarray(pixels)
    picture.convert(mode).save(folder / image)
    (folder / "map.yaml").write_text(yaml.format(image=image) + more, encoding="utf-8")
    return str(folder / "map.yaml")


PLACES = """\
start: {x_m: 0.5, y_m: 0.0, yaw_deg: 90}
places:
  - {name: far room, aliases: [里屋], x_m: 2.8, y_m: 0.5}
"""


@pytest.mark.parametrize("image", ["map.pgm", "map.png"])
def test_occupied_cells_are_walls_and_all_others_are_not(tmp_path: Path, image: str) -> None:
    world = load_world(drawn(tmp_path, image=image))
    points = np.array([(-0.45, 0.0), (3.45, 0.0), (1.5, -1.0), (1.5, -0.05), (0.5, 0.0), (-0.9, -1.9)])
    clearance = world.clearance_m(points)
    assert (clearance[:3] < 0.0).all()  # west wall, east wall, wall across
    assert (clearance[3:] > 0.3).all()  # doorway, room, what nobody knows
    assert {obstacle.name for obstacle in world.obstacles} == {"wall"}
    # From the room's wall to its other: inner faces at x = -0.4 and the near face of the wall across at 1.45.
    ranges = Edges([obstacle.shape for obstacle in world.obstacles]).raycast(Pose(0.5, -1.0, math.pi), 4)
    assert ranges[0] == pytest.approx(0.95)
    assert ranges[2] == pytest.approx(0.9)


def test_places_and_the_start_stand_in_the_map_or_beside_it(tmp_path: Path) -> None:
    within = load_world(drawn(tmp_path, PLACES))
    drawn(tmp_path)
    (tmp_path / "map.places.yaml").write_text(PLACES, encoding="utf-8")
    beside = load_world(str(tmp_path / "map.yaml"))
    assert within.places == beside.places
    assert within.place("里屋") == beside.places["far room"]
    profile = load_profile("wheeltec_mini_mec")
    far = beside.places["far room"]
    way = GridRoutePlanner(beside, profile).route(Pose(), (far.x_m, far.y_m), named_place=True)
    assert isinstance(way, Route)
    assert len(way.waypoints) > 1  # through the doorway


def test_every_occupied_cell_is_covered_once() -> None:
    occupied = np.random.default_rng(3).random((40, 60)) < 0.4
    covered = np.zeros(occupied.shape, dtype=int)
    for row, column, height, width in _merged(occupied):
        covered[row : row + height, column : column + width] += 1
    assert (covered == occupied).all()


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("image: {image}", "image: gone.pgm", "line 1: image: there is no file"),
        ("image: {image}", "image: map.yaml", "is no picture"),
        ("resolution: 0.05", "resolution: 0", "line 2: resolution: 0 is not possible"),
        ("resolution: 0.05\n", "", "resolution is missing"),
        ("origin: [-1.0, -2.0, 0.0]", "origin: [-1.0, -2.0]", "line 3: origin: has 2 numbers"),
        ("negate: 0", "negat: 0", "did you mean negate"),
        ("negate: 0", "negate: 0\nmode: raw", "'raw' is not possible (allowed: trinary, scale)"),
        ("negate: 0", "negate: 0.5", "'0.5' is not possible (allowed: 0, 1, false, true)"),
        ("image: {image}", "image: .", "is no picture: Is a directory"),
        ("free_thresh: 0.25", "free_thresh: 0.9", "above occupied_thresh"),
    ],
)
def test_a_broken_map_says_where_it_is_broken(tmp_path: Path, before: str, after: str, said: str) -> None:
    path = drawn(tmp_path, yaml=YAML.replace(before, after))
    with pytest.raises(WorldError) as caught:
        load_world(path)
    assert said in str(caught.value)


def test_negate_turns_black_and_white_round(tmp_path: Path) -> None:
    world = load_world(drawn(tmp_path, yaml=YAML.replace("negate: 0", "negate: 1")))
    assert world.clearance_m(np.array([(0.5, 0.0), (1.5, -1.0)])).tolist()[0] < 0.0
