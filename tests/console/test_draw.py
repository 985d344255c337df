"""The picture of a plan: what is on it, and where."""

import math
from itertools import pairwise

import pytest
from PIL import Image

from chatrobot.cli.draw import draw_plan
from chatrobot.cli.drawing.fonts import font_for, is_latin
from chatrobot.cli.drawing.ground import END, OBSTACLE, PAPER, RED
from chatrobot.cli.drawing.ways import progress_colour, standing_points, where_found
from chatrobot.core.events import FindingSeen, Rehearsed
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world

PROFILE = load_profile("wheeltec_mini_mec")
WAY = tuple((x / 20, 0.0, 0.0) for x in range(41))


def rehearsed(*findings, way=WAY, ok=True):
    return Rehearsed(1, ok, 7.0, 2.0, Pose(2.0), findings, way)


def refusal(t_s=7.0, **values):
    return FindingSeen(
        1, "refuse", Reason("would_hit", {"name": "sofa", "distance_m": 1.0, **values}), (1,), t_s
    )


def picture(tmp_path, *, world="home", title="forward 2 m", plan=None):
    path = tmp_path / "plan.png"
    plan = plan or rehearsed()
    draw_plan(
        path, world=load_world(world), profile=PROFILE, rehearsed=plan, title=title, words=lambda _: "hits it"
    )
    return Image.open(path).convert("RGB")


def count(image, colour, near=12):
    colours = image.getcolors(image.width * image.height)
    return sum(often for often, one in colours if all(abs(a - b) <= near for a, b in zip(one, colour)))


def test_the_way_is_drawn_in_the_colours_of_its_progress(tmp_path):
    image = picture(tmp_path)
    for share in (0.1, 0.5, 0.9):
        assert count(image, progress_colour(share)) > 20


def test_the_world_is_drawn_and_the_empty_world_is_empty(tmp_path):
    assert count(picture(tmp_path), OBSTACLE, 2) > 20_000
    assert count(picture(tmp_path, world="empty"), OBSTACLE, 2) < 2_000


def test_a_refusal_is_marked_in_red(tmp_path):
    assert count(picture(tmp_path), RED) == 0
    assert count(picture(tmp_path, plan=rehearsed(refusal(), ok=False)), RED) > 150


def test_the_end_is_marked_even_where_nothing_moves(tmp_path):
    assert count(picture(tmp_path, world="empty", plan=rehearsed(way=((0.0, 0.0, 0.0),))), END) > 50
    assert picture(tmp_path, world="empty", plan=rehearsed(way=())).getpixel((2, 2)) == PAPER


@pytest.mark.parametrize("title", ["", "走一个正方形", "x" * 500, "go\nto\tthe kitchen", "\x1b[31m\u202e"])
def test_any_title_can_be_drawn(tmp_path, title):
    assert picture(tmp_path, world="empty", title=title).width > 700


def test_a_very_long_way_and_a_very_short_one_fit_on_a_page(tmp_path):
    for length_m in (0.01, 400.0):
        way = tuple((length_m * i / 50, length_m * i / 100, 0.4) for i in range(51))
        image = picture(tmp_path, world="empty", plan=rehearsed(way=way))
        assert 400 < image.width < 1400
        assert 400 < image.height < 1400


def test_outlines_stand_apart_and_show_both_ends():
    shown = list(standing_points(WAY, 0.5))
    assert shown[0] == WAY[0]
    assert shown[-1] == WAY[-1]
    assert all(math.dist(a[:2], b[:2]) >= 0.5 for a, b in pairwise(shown[:-1]))
    turning = tuple((0.0, 0.0, math.radians(i)) for i in range(91))
    assert len(list(standing_points(turning, 0.5, math.radians(30)))) == 4


def test_a_finding_is_where_it_says_or_else_where_its_time_is():
    assert where_found(rehearsed(), refusal(x_m=3.0, y_m=1.0)) == (3.0, 1.0)
    assert where_found(rehearsed(), refusal(t_s=3.5)) == (1.0, 0.0)
    assert where_found(rehearsed(way=()), refusal()) is None


def test_chinese_needs_a_font_that_has_it():
    assert font_for("kitchen, 90°", 12) is not None
    assert not is_latin("厨房")
