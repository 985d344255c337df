"""A part of what was done is done again otherwise; a pause at each corner of a shape is made at each corner."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation

WAY = "forward 1 m, left 90, forward 50 cm"
WEG = "vor 1 m, links 90, vor 50 cm"
LU = "前进一米，左转九十度，前进半米"


def said_after(before: str, text: str) -> str:
    """The plan of `text` after `before`, in a line; how it ended where it has none."""
    meant = conversation(before).say(text)
    return format_plan(meant.plan).replace("\n", "; ") if meant.plan is not None else meant.outcome


@pytest.mark.parametrize(
    ("before", "text", "plan"),
    [
        (WAY, "the last leg again but twice as far", "drive 1 m"),
        (WAY, "the last step again, but left", "drive 0.5 m left"),
        (WAY, "do the first leg again, half as far", "drive 0.5 m"),
        (WAY, "the last step again and then turn left", "unclear"),
        (LU, "最后一段再走一遍，距离加倍", "drive 1 m"),
        (WEG, "das letzte Stück nochmal, aber doppelt so weit", "drive 1 m"),
        (WEG, "nur die Drehung nochmal", "turn left 90 deg"),
    ],
)
def test_a_part_is_done_again_as_it_is_wanted_now(before: str, text: str, plan: str) -> None:
    assert said_after(before, text) == plan


def test_after_an_undo_a_changed_part_is_of_what_was_undone() -> None:
    talk = conversation(WAY, "undo that")
    meant = talk.say("again, but the last leg 1 m")
    assert meant.plan is not None
    assert format_plan(meant.plan) == "drive 1 m\nturn left 90 deg\ndrive 1 m"


@pytest.mark.parametrize(
    ("text", "turn_deg", "sides", "waits"),
    [
        ("drive a square with 1 m sides and wait 2 seconds at each corner", 90, 4, 4),
        ("a triangle with sides of 1 m, pausing 2 seconds after every side", 120, 3, 3),
        ("a triangle with sides of 1 m, pause 2 seconds between the sides", 120, 3, 2),
        ("走一个边长一米的正方形，每个角停两秒", 90, 4, 4),
        ("走一个边长一米的三角形，每到一个角停两秒", 120, 3, 3),
        ("fahr ein Quadrat mit 1 m Seite und warte an jeder Ecke 2 Sekunden", 90, 4, 4),
    ],
)
def test_a_pause_at_the_corners_is_made_at_each(text: str, turn_deg: int, sides: int, waits: int) -> None:
    meant = conversation().say(text)
    assert meant.plan is not None
    rested = [f"drive 1 m\nwait 2 s\nturn left {turn_deg} deg"] * waits
    driven_on = [f"drive 1 m\nturn left {turn_deg} deg"] * (sides - waits)
    assert format_plan(meant.plan) == "\n".join([*rested, *driven_on])
