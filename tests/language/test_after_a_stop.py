"""What is said after a motion was stopped means what was driven, or what is left; neither is driven unasked."""

from __future__ import annotations

from dataclasses import replace

import pytest

from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan, parse_plan
from tests.language.dialogue_runner import Conversation, conversation

DRIVE = ("forward 2 m", "drive 0.8 m", "drive 1.2 m")
TURNED = ("forward 1 m, turn left", "drive 1 m; turn left 30 deg", "turn left 60 deg")


def stopped(said: str, driven: str, left: str) -> Conversation:
    """A dialogue in which this was said, and stopped when it had driven one plan and not the other."""
    talk = Conversation()
    meant, start = talk.interpreter.interpret(said, talk.context), talk.track.pose
    executed, remaining = (parse_plan(text.replace("; ", "\n")) for text in (driven, left))
    talk.track.run(executed)
    talk._remember(said, meant, start)
    record = replace(talk.dialogue.turns[-1], outcome="stopped", executed=executed, remaining=remaining)
    talk.dialogue = replace(talk.dialogue, turns=(record,))
    return talk


def told(plan: Plan | None) -> str:
    return format_plan(plan).replace("\n", "; ") if plan is not None else ""


@pytest.mark.parametrize(
    ("before", "said", "proposed"),
    [
        (DRIVE, "continue, but slowly", "drive 1.2 m at 0.15 m/s"),
        (DRIVE, "wait 3 seconds and carry on", "wait 3 s; drive 1.2 m"),
        (DRIVE, "Alright, carry on.", "drive 1.2 m"),
        (DRIVE, "继续，慢一点", "drive 1.2 m at 0.15 m/s"),
        (DRIVE, "先右转再继续", "turn right 90 deg; drive 1.2 m"),
        (DRIVE, "接着刚才的", "drive 1.2 m"),
        (DRIVE, "weiter, aber langsamer", "drive 1.2 m at 0.15 m/s"),
        (DRIVE, "mach da weiter, wo du aufgehört hast", "drive 1.2 m"),
        (TURNED, "finish that, then go back 1 m", "turn left 60 deg; drive 1 m back"),
        (TURNED, "走完再右转", "turn left 60 deg; turn right 90 deg"),
        (TURNED, "mach fertig und dreh dich dann rechts", "turn left 60 deg; turn right 90 deg"),
    ],
)
def test_going_on_beside_other_words_is_asked_about_with_the_rest(
    before: tuple[str, str, str], said: str, proposed: str
) -> None:
    meant = stopped(*before).say(said)
    assert meant.plan is None
    assert meant.proposal is not None
    assert meant.proposal.plan_text.replace("\n", "; ") == proposed


@pytest.mark.parametrize(
    ("said", "done"),
    [("go back", "drive 0.8 m back"), ("退回去", "drive 0.8 m back"), ("zurück", "drive 0.8 m back"),
     ("again from the beginning", "drive 2 m"), ("continue for 10 cm", "drive 0.1 m")],
)  # fmt: skip
def test_the_way_back_is_what_was_driven_and_again_is_what_was_told(said: str, done: str) -> None:
    assert told(stopped(*DRIVE).say(said).plan) == done


@pytest.mark.parametrize(
    "said",
    ["only half of the rest", "the last step again", "half of that", "只走剩下的一半", "最后一步再来一次",
     "nur noch die Hälfte vom Rest", "den letzten Schritt nochmal", "forget the rest"],
)  # fmt: skip
def test_a_part_of_what_was_stopped_is_asked_about(said: str) -> None:
    for before in (DRIVE, TURNED):
        meant = stopped(*before).say(said)
        assert meant.plan is None
        assert meant.proposal is None


def test_without_a_stop_nothing_is_left() -> None:
    assert told(conversation("forward 2 m").say("continue, but slowly").plan) == "drive 0.5 m at 0.15 m/s"


@pytest.mark.parametrize(
    "said",
    ["go to the dock, then to the shelf", "go to the dock, the shelf", "go to the dock, then the sofa",
     "go to the dock, to the shelf and to the sofa", "fahr zum dock, dann zum Regal"],
)  # fmt: skip
def test_a_second_place_that_nobody_knows_is_not_passed_over(said: str) -> None:
    assert conversation("this is the dock", "forward 1 m").say(said).plan is None


def test_a_place_is_not_reversed_to() -> None:
    for said in ("go to the dock backwards", "fahr rückwärts zum dock"):
        assert (
            conversation("this is the dock", "turn left", "forward 1 m", "turn right").say(said).plan is None
        )


@pytest.mark.parametrize(
    ("said", "done"),
    [("drive 1 m at half that speed", "drive 1 m at 0.15 m/s"), ("用一半的速度前进一米", "drive 1 m at 0.15 m/s")],
)  # fmt: skip
def test_half_the_speed_is_no_part_of_what_was_stopped(said: str, done: str) -> None:
    assert told(stopped(*DRIVE).say(said).plan) == done
