"""What the status bar knows of the robot, and what it shows."""

from dataclasses import replace

import pytest

from chatrobot.cli.console.motion_view import MotionView
from chatrobot.cli.console.status_bar import MAP_ROWS, StatusBar
from chatrobot.cli.console.words import Words
from chatrobot.core.events import (
    Finished,
    Notice,
    Progress,
    Rehearsed,
    Started,
    Telemetry,
)
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.sim.load import load_world
from chatrobot.sim.world import EMPTY_WORLD

HOME = load_world("home")
WAY = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
REHEARSED = Rehearsed(1, True, 3.6, 1.0, Pose(1.0), (), WAY)


def moving_view():
    motion_view = MotionView()
    for event in (
        REHEARSED,
        Started(1, Pose()),
        Progress(1, 2, 4, 0.5, Pose(0.5), Twist(0.3)),
        Telemetry(1, Pose(0.5, 0.0, 0.0), Twist(0.3), 0.5, 80.0, 0.8, True),
    ):
        motion_view.hear(event)
    return motion_view


def finished(turn=1):
    return Finished(turn, "completed", None, Pose(), Pose(1.0), 0.0, 1.0, 3.6, 0.0)


def test_a_motion_has_its_way_its_trail_and_its_progress():
    motion_view = moving_view()
    assert motion_view.is_moving
    assert motion_view.path == ((0.0, 0.0), (1.0, 0.0))
    assert motion_view.trail == ((0.0, 0.0), (0.5, 0.0))
    assert (motion_view.step_number, motion_view.step_count, motion_view.fraction) == (2, 4, 0.5)


def test_the_end_of_another_turn_does_not_end_the_motion():
    motion_view = moving_view()
    motion_view.hear(finished(turn=7))
    assert motion_view.is_moving
    motion_view.hear(finished())
    assert not motion_view.is_moving
    assert motion_view.pose == Pose(1.0)


def bar_text(motion_view, width=100, world=HOME, latched=False, language="en", model_wait_s=None):
    bar = StatusBar(motion_view, Words(language), world)
    return "".join(text for _, text in bar.fragments(width, latched, model_wait_s))


def test_the_status_bar_shows_no_share_of_what_has_no_known_end():
    motion_view = moving_view()
    motion_view.hear(Progress(1, 1, 1, None, Pose(0.6), Twist(0.3)))
    assert "%" not in bar_text(motion_view).replace("battery 80 %", "")
    assert "moving" in bar_text(motion_view)
    motion_view.hear(replace(REHEARSED, open_ended=True))
    motion_view.hear(Started(2, Pose()))
    assert motion_view.fraction is None


def test_the_status_bar_of_a_moving_robot_says_where_how_fast_and_how_far():
    text = bar_text(moving_view())
    for part in (
        "moving",
        "50 %",
        "step 2 of 4",
        "(0.50, 0.00) 0°",
        "0.30 m/s",
        "0.80 m",
        "battery 80 %",
        "→",
    ):
        assert part in text
    assert "行驶中" in bar_text(moving_view(), language="zh")
    assert text.count("\n") == MAP_ROWS - 1


def test_a_narrow_status_bar_has_no_map_and_no_line_is_too_long():
    assert "→" not in bar_text(moving_view(), width=45)
    for width in range(1, 120):
        assert max(len(line) for line in bar_text(moving_view(), width=width).split("\n")) <= width


def test_a_standing_robot_has_a_line_and_a_latched_one_an_alarm():
    assert "\n" not in bar_text(MotionView())
    assert "EMERGENCY STOP" in bar_text(moving_view(), latched=True)


def test_the_status_bar_says_for_how_long_a_model_thinks_whether_the_robot_moves_or_not():
    assert "the model is thinking, 7 s" in bar_text(MotionView(), model_wait_s=7.9)
    assert "模型正在思考，0 秒" in bar_text(MotionView(), model_wait_s=0.1, language="zh")
    assert "the model is thinking, 7 s" in bar_text(moving_view(), model_wait_s=7.9)
    assert "thinking" not in bar_text(MotionView()) + bar_text(moving_view())
    for width in range(1, 120):
        assert max(map(len, bar_text(moving_view(), width=width, model_wait_s=7.9).split("\n"))) <= width
        assert len(bar_text(MotionView(), width=width, model_wait_s=7.9)) <= width


def test_a_status_bar_shows_whole_hints_and_the_whole_percentage():
    assert bar_text(MotionView(), width=60).rstrip().endswith("Ctrl-C stops")
    assert bar_text(MotionView(), width=100).rstrip().endswith("Ctrl-D leaves")
    for width in (45, 52, 60, 100):
        assert "50 %" in bar_text(moving_view(), width=width)


def test_a_status_bar_without_its_map_is_words_alone():
    bar = StatusBar(moving_view(), Words(), EMPTY_WORLD)
    bar.shows_map = False
    assert "→" not in "".join(text for _, text in bar.fragments(100))


@pytest.mark.parametrize("moves", [True, False])
def test_the_status_bar_of_a_robot_without_odometry_says_so_and_tells_no_pose(moves: bool) -> None:
    motion_view = MotionView()
    motion_view.hear(Notice(0, Reason("open_loop", {})))
    motion_view.hear(Started(1, measured=False))
    if not moves:
        motion_view.hear(Finished(1, "completed", None, Pose(), Pose(), 0.0, 0.0, 1.0, 0.0, measured=False))
    shown = bar_text(motion_view)
    assert "not measured" in shown
    assert "0.00" not in shown
    assert "→" not in shown
