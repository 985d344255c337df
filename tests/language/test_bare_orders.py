"""An order that tells no amount is proposed where what was left out beside it may tell one, or whom it is for."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from chatrobot.core.geometry import ORIGIN
from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.interpreter import OfflineInterpreter
from tests.language.dialogue_runner import Conversation
from tests.language.profiles import MECANUM

STANDING = RobotState(pose=ORIGIN, path_m=0.0, battery_percent=None)


@pytest.mark.parametrize(
    "said",
    [
        "你往左手边看，那是我家",
        "路在脚下，往前走吧朋友们",
        "头往左歪，我给你剪头发",
        "物理题:小车以v=0.4m/s向前匀速行驶t=5s,求路程。。。懒得算了你直接开给我看吧",
        "Show the children what a triangle looks like, all three sides the same, eighty centimetres each.",
        "I've a bet on wi Senga here that ye can birl on the spot. Three times the hale way roon, clockwise, show her.",
    ],
)
def test_it_is_not_done_unasked(said: str) -> None:
    assert Conversation().say(said).plan is None


@pytest.mark.parametrize(
    "said", ["the sun is out. Go forward", "Good boy! Now turn right.", "thanks. turn left", "谢谢，往前走"]
)
def test_a_plain_order_beside_talk_is_done(said: str) -> None:
    assert Conversation().say(said).plan is not None


@pytest.mark.parametrize(
    "said", ["can you drive?", "can you go?", "你能走吗？", "kannst du fahren?", "could you drive?"]
)
def test_a_question_whether_it_can_is_answered(said: str) -> None:
    assert Conversation().say(said).outcome == "answered"


def test_as_far_as_usual_is_what_the_robots_profile_says() -> None:
    profile = replace(
        MECANUM, defaults=replace(MECANUM.defaults, turn_rad=math.radians(45.0), distance_m=0.3)
    )
    meant = OfflineInterpreter(profile).interpret("路在脚下，往前走吧朋友们", Context(Dialogue(), STANDING))
    assert meant.plan is None
