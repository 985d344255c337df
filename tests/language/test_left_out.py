"""What is ordered within dictated text is done or proposed; what only sounds like it is neither."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import parse_plan
from tests.language.dialogue_runner import Conversation

OFFERED = {
    "still no lemons: pull back two metres for the wide shot": "drive 2 m back",
}
SAID = (
    "you drive like my grandma",
    "that was a nice square",
    "yesterday you went a good metre too far to the right",
    "wow now that's what I call a turn",
    "oh what a shame now it's broken again",
    "the sign says go left",
    "听老师讲了半天我还在原地打转",
    "go forward a metre when the porter waves not before",
    "there's no need to turn around, I'm right here",
    "my code made it go backwards 10cm instead of fwd",
    "Rohit, can you turn your monitor to the left a little, I can't see the plot",
    "go to the harp once more, with my compliments",
    "昨天我的遥控车也会往右转圈圈",
    "等下午送货的来了你再往前走三米",
    "我没说要往前走",
)


def after_a_metre() -> Conversation:
    talk = Conversation()
    talk.say("remember this place as house")
    talk.say("forward 1 m")
    return talk


@pytest.mark.parametrize("text", OFFERED)
def test_an_order_within_dictated_talk_is_proposed_and_not_done(text: str) -> None:
    meant = after_a_metre().say(text)
    assert meant.plan is None
    assert meant.proposal is not None
    assert parse_plan(meant.proposal.plan_text) == parse_plan(OFFERED[text])


@pytest.mark.parametrize("text", SAID)
def test_talk_that_only_names_a_motion_is_proposed_nothing(text: str) -> None:
    meant = after_a_metre().say(text)
    assert (meant.plan, meant.proposal) == (None, None)
