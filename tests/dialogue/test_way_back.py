"""The way back to the start: backwards where it is said so, and to the start itself where the robot still moves."""

from __future__ import annotations

import pytest
from tests.dialogue.talk import Talk
from tests.language.test_usual import done

from chatrobot.core.events import TruePose
from chatrobot.dialogue.options import Options


@pytest.mark.parametrize(
    ("first", "back"),
    [
        ("a circle of radius 0.8 m", "back up to where you started"),
        ("slide left 2 m", "slide back to the start"),
        ("左移2米", "退回来"),
    ],
)
def test_a_way_back_that_is_ordered_during_a_motion_ends_at_the_start(first: str, back: str) -> None:
    talk = Talk(options=Options(while_moving="replace"))
    talk.do("forward 2 m")
    talk.session.say(first)
    talk.pump_until(lambda: any(isinstance(e, TruePose) and abs(e.y_m) > 0.5 for e in talk.events))
    talk.session.say(back)
    talk.pump_until(lambda: len(talk.results()) == 3)
    pose = talk.results()[3].pose
    assert (pose.x_m, pose.y_m) == pytest.approx((0.0, 0.0), abs=0.01)


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("drive 3 m at 0.5 m/s", "reverse to where you started, at half that speed"), "drive 3 m back at 0.25 m/s"),
        (("forward 2 m", "again", "reverse all the way to where you began"), "drive 4 m back"),
        (("forward 3 m", "reverse to the start at 0.1 m/s"), "drive 3 m back at 0.1 m/s"),
        (("前进两米", "用每秒0.1米的速度退回来"), "drive 2 m back at 0.1 m/s"),
        (("forward 2 m", "turn left, forward 1 m", "back up to where you started"), "unclear"),
        (("forward 2 m", "go back to the start at 0.2 m/s"), "go to 0 0 at 0.2 m/s"),
    ],
)  # fmt: skip
def test_it_reverses_to_the_start_where_that_lies_straight_behind(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan
