"""What is ordered within dictated text is proposed; what only sounds like it is not."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import parse_plan
from tests.language.dialogue_runner import Conversation

OFFERED = {
    "ok bedtime go to your house": 'go to 0 0 named "house"',
    "hmm too close to my chair come back one": "drive 1 m back",
    "that made me dizzy now the other way": "drive 1 m back",
    "oh what fun now half of that": "drive 0.5 m",
    "do it again for grandpa he missed it": "drive 1 m",
}
SAID = (
    "you drive like my grandma",
    "that was a nice square",
    "yesterday you went a good metre too far to the right",
    "wow now that's what I call a turn",
    "oh what a shame now it's broken again",
    "the sign says go left",
    "听老师讲了半天我还在原地打转",
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
