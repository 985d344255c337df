"""Where the rules do not cover a text, its words of motion alone are proposed, and nothing is done."""

from __future__ import annotations

import pytest

from chatrobot.language.interpretation import Interpretation
from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation

OFFERED = {
    "I know I said no moving before lunch but please go forward 50 cm": "drive 0.5 m",
    "mum says dinner in five, one more thing: left 90, then 2 m, then right 90":
        "turn left 90 deg; drive 2 m; turn right 90 deg",
    "back up until you're half a metre behind where you are now": "drive 0.5 m back",
    "zigzag: 45 left 50 cm, 90 right 50 cm, 90 left 50 cm":
        "turn left 45 deg; drive 0.5 m; turn right 90 deg; drive 0.5 m; turn left 90 deg; drive 0.5 m",
}  # fmt: skip
NOT_OFFERED = [
    "I know I said forward 50 cm but please do not go now",
    "if the gizmo blorps then forward 50 cm",
    "the foreman said zorblax, left 90",
    "grab the zorblax and go forward 1 m",
    "zorblax forward 1 m, no wait, not that",
    "zorblax forward 50 frobs",
    "did you zorblax forward 1 m?",
    "you went zorblax forward 1 m",
]


def said(text: str) -> Interpretation:
    return Conversation().say(text)


@pytest.mark.parametrize("text", OFFERED)
def test_the_words_of_motion_in_a_text_that_is_not_understood_are_proposed_and_not_done(text: str) -> None:
    meant = said(text)
    assert meant.plan is None
    assert meant.proposal is not None
    assert meant.proposal.plan_text.replace("\n", "; ") == OFFERED[text]


@pytest.mark.parametrize("text", NOT_OFFERED)
def test_nothing_is_proposed_where_a_clause_denies_bounds_reports_or_asks(text: str) -> None:
    meant = said(text)
    assert meant.plan is None
    assert meant.proposal is None


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (["three times 20 cm forward", "one more"], "drive 0.2 m"),
        (["forward 1 m, wait 2 s, back 1 m", "without the pause this time"], "drive 1 m; drive 1 m back"),
        (["turn right by 60 degrees", "could you do that two more times?"], "turn right 60 deg; turn right 60 deg"),
        (["right 45, forward 70 cm", "from the beginning, but left instead of right"],
         "turn left 45 deg; drive 0.7 m"),
        (["turn left 90, forward 1 m", "again but with the steps the other way round"], "drive 1 m; turn left 90 deg"),
    ],
)  # fmt: skip
def test_what_refers_to_the_motion_before_changes_what_it_names(turns: list[str], plan: str) -> None:
    talk = Conversation()
    meant = [talk.say(turn) for turn in turns][-1]
    assert meant.plan is not None
    assert plan_of(meant) == plan


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("back up 30 cm, and then back up 30 cm", "drive 0.3 m back; drive 0.3 m back"),
        ("I would very much like you to now turn left", "turn left 90 deg"),
        ("would it perhaps be possible for you to move back 30 cm?", "drive 0.3 m back"),
        ("I was wondering whether you might just slide right 20 cm", "drive 0.2 m right"),
        ("nudge forward an inch or so", "drive 0.0254 m"),
        ("rotate left one time complete", "turn left 360 deg"),
        ("reverse 0.75 m while keeping your present orientation", "drive 0.75 m back"),
        ("你转一下身，转一百八十度", "turn left 180 deg"),
    ],
)
def test_orders_are_read_in_the_words_they_are_put_in(text: str, plan: str) -> None:
    assert plan_of(said(text)) == plan


def plan_of(meant: Interpretation) -> str:
    return format_plan(meant.plan).replace("\n", "; ") if meant.plan is not None else ""
