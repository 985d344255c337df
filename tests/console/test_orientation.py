"""A world is drawn as its file has it, whichever way the robot starts; its furniture has names where there is room."""

import math
from pathlib import Path

import pytest
from PIL import Image

from chatrobot.cli.console.motion_view import MotionView
from chatrobot.cli.console.status_bar import StatusBar
from chatrobot.cli.console.tables import big_map, way_map
from chatrobot.cli.console.words import Words
from chatrobot.cli.draw import draw_plan
from chatrobot.cli.drawing.extent import extent_of_world
from chatrobot.cli.drawing.map_text import furniture, thickness_m
from chatrobot.core.events import Started, Telemetry
from chatrobot.core.geometry import Pose, Twist
from chatrobot.sim.load import load_world, parse_world
from chatrobot.sim.shapes import Circle, rectangle
from chatrobot.sim.world import Obstacle, World
from tests.console.fakes import draw_map_text
from tests.console.test_draw import OBSTACLE, PROFILE, rehearsed
from tests.console.test_map_text import plain

# Along the world's x from west to east: a box, the start, and a place to the north of it.
FILE = """
start: {{x_m: 4.0, y_m: 2.0, yaw_deg: {yaw_deg}}}
obstacles:
  - {{name: box, rectangle: {{x_m: 1.0, y_m: 2.0, length_m: 1.0, width_m: 0.6}}}}
  - {{name: wall, wall: {{from: [0, 0], to: [8, 0], thickness_m: 0.1}}}}
places:
  - {{name: well, x_m: 4.0, y_m: 4.0}}
allowed_area: [[0, 0], [8, 0], [8, 5], [0, 5]]
"""


def world(yaw_deg):
    return parse_world(FILE.format(yaw_deg=yaw_deg), "test")


def turned(yaw_deg, *points):
    """Points of the picture (from the start to the east and to the north) in the frame of the start."""
    start = Pose(0.0, 0.0, math.radians(yaw_deg))
    return tuple(Pose(*point).relative_to(start)[:2] for point in points)


YAWS = [0, 90, 180, -90, 37]
WAY = ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0))


def drawn(yaw_deg):
    motion_view = MotionView(path=turned(yaw_deg, *WAY), trail=turned(yaw_deg, *WAY[:2]))
    return [
        line.replace("↗", "→").replace("↘", "→")
        for line in str(big_map(motion_view, world(yaw_deg), 84)).splitlines()
    ]


@pytest.mark.parametrize("yaw_deg", YAWS)
def test_the_big_map_is_the_same_whichever_way_the_robot_starts_but_for_its_arrow(yaw_deg):
    arrows = "→↗↑↖←↙↓↘"
    blank = str.maketrans(arrows, "o" * len(arrows))
    straight, other = ("\n".join(drawn(yaw)).translate(blank) for yaw in (0, yaw_deg))
    differing = sum(a != b for a, b in zip(straight, other))
    assert len(straight) == len(other)
    assert differing <= (0 if yaw_deg % 90 == 0 else 40), "dots at the edge of a cell round either way"
    assert straight.index("well") < straight.index("o"), "north is up"


@pytest.mark.parametrize(("yaw_deg", "arrow"), [(0, "→"), (90, "↑"), (180, "←"), (-90, "↓")])
def test_the_arrow_points_where_the_robot_looks_in_the_world(yaw_deg, arrow):
    assert arrow in str(big_map(MotionView(), world(yaw_deg), 84))
    assert arrow in str(way_map(MotionView(path=((0.0, 0.0), (1.0, 0.0))), world(yaw_deg)))
    motion_view = MotionView()
    motion_view.hear(Started(1, Pose()))
    motion_view.hear(Telemetry(1, Pose(), Twist(0.3), 0.0, None, None, True))
    strip = StatusBar(motion_view, Words(), world(yaw_deg)).fragments(100)
    assert arrow in "".join(text for _, text in strip)


@pytest.mark.parametrize("yaw_deg", YAWS)
def test_the_picture_has_the_same_orientation(tmp_path: Path, yaw_deg):
    """The box stands to the west of the start: left of the way, whichever way the robot starts."""
    way = tuple((*point, 0.0) for point in turned(yaw_deg, *WAY))
    draw_plan(
        tmp_path / "a.png",
        world=world(yaw_deg),
        profile=PROFILE,
        rehearsed=rehearsed(way=way),
        title="t",
        words=lambda _: "hits it",
    )
    image = Image.open(tmp_path / "a.png").convert("RGB")
    size = (image.width // 4, image.height // 4)
    small = image.resize(size, Image.Resampling.NEAREST)
    spots = [
        (x, y)
        for x in range(size[0])
        for y in range(size[1] // 3, size[1] * 2 // 3)
        if all(abs(a - b) <= 2 for a, b in zip(small.getpixel((x, y)), OBSTACLE))
    ]
    assert spots
    assert max(x for x, _ in spots) < size[0] / 2


def test_a_world_says_which_way_its_start_looks():
    assert world(90).start_yaw_rad == pytest.approx(math.pi / 2)
    assert world(0).start_yaw_rad == 0.0


def test_furniture_is_what_is_thicker_than_a_wall_and_no_place():
    home = load_world("home")
    named = {name for name, _ in furniture(home)}
    assert {"bed", "wardrobe", "bookshelf", "dining table", "plant", "TV stand"} <= named
    assert not {name for name in named if "wall" in name}
    assert not named & {"fridge", "charging dock"}, "the place of that name has it already"
    assert thickness_m(rectangle(3.0, 4.0, 2.0, 0.1, 0.7).outline()) == pytest.approx(0.1)
    assert thickness_m(Circle(0.0, 0.0, 0.2).outline()) > 0.3


def names_of(world, columns, rows):
    extent = extent_of_world(world, (), margin_m=0.1, least_m=3.0)
    return "\n".join(plain(draw_map_text(world, extent, columns=columns, rows=rows, names=True)))


def test_furniture_is_named_on_the_map_where_there_is_room():
    home = load_world("home")
    large = names_of(home, 100, 40)
    for name in ("bed", "wardrobe", "bookshelf", "plant", "TV stand", "dining table"):
        assert name in large
    small = names_of(home, 24, 6)
    assert "wardrobe" not in small
    for name in home.places:  # they go first
        assert large.count(f"•{name}") == 1


def test_a_name_never_covers_a_wall_or_another_name():
    crowd = World("w", tuple(Obstacle(f"thing {i}", rectangle(i * 0.5, 0.0, 0.3, 0.3)) for i in range(8)))
    extent = extent_of_world(crowd, (), margin_m=1.0, least_m=3.0)
    bare, named = (
        "\n".join(plain(draw_map_text(crowd, extent, columns=60, rows=20, names=names)))
        for names in (False, True)
    )
    assert "thing 0" in named
    for before, after in zip(bare, named):
        assert before in (after, " ")
