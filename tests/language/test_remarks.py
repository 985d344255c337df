"""A remark on the motion before orders nothing: what it most likely asks for is proposed."""

from __future__ import annotations

import pytest

from chatrobot.language.context import Context, Dialogue
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.language.ledger import TurnRecord
from chatrobot.plan.steps import Drive, Plan
from tests.language.dialogue_runner import conversation
from tests.language.profiles import MECANUM


@pytest.mark.parametrize(
    ("before", "said", "plan"),
    [
        ("forward 1 m", "Oops!", "drive 1 m back"),
        ("forward 1 m", "oh no, that's wrong", "drive 1 m back"),
        ("turn left 90", "wrong way!", "turn right 180 deg"),
        ("turn left 90", "no, the other left", "turn right 180 deg"),
        ("forward 1 m at 0.2 m/s", "faster", "drive 1 m at 0.34 m/s"),
        ("forward 1 m", "that was 20 cm too far", "drive 0.2 m back"),
        ("前进一米", "哎呀，错了", "drive 1 m back"),
        ("前进一米", "太快了", "drive 1 m at 0.15 m/s"),
    ],
)
def test_a_remark_on_the_motion_before_proposes_what_it_asks_for(before: str, said: str, plan: str) -> None:
    meant = conversation(before).say(said)
    assert (meant.outcome, meant.plan) == ("unclear", None)
    assert meant.proposal is not None
    assert meant.proposal.plan_text == plan


@pytest.mark.parametrize("said", ["oops", "wrong way", "faster", "错了"])
def test_a_remark_on_nothing_proposes_nothing(said: str) -> None:
    meant = conversation().say(said)
    assert (meant.plan, meant.proposal) == (None, None)


@pytest.mark.parametrize(
    ("asked", "unit"), [("how long did that take?", "3.5 s"), ("刚才用了多久？", "3.5 秒")]
)
def test_how_long_the_last_motion_took_is_told_as_it_was_timed(asked: str, unit: str) -> None:
    plan = Plan((Drive(1.0),))
    told = [
        OfflineInterpreter(MECANUM).interpret(
            asked, Context(Dialogue((TurnRecord("forward 1 m", "completed", plan, duration_s=taken_s),)))
        )
        for taken_s in (3.5, None)
    ]
    assert [meant.outcome for meant in told] == ["answered", "answered"]
    assert unit in told[0].reply
    assert "3.5" not in told[1].reply


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("go forward 1 m, but don't do it yet", "drive 1 m"),
        ("on my mark, turn left 90 degrees", "turn left 90 deg"),
        ("等我口令，左转九十度", "turn left 90 deg"),
        ("前进一米，先别动", "drive 1 m"),
    ],
)
def test_what_is_held_back_waits_for_a_yes(said: str, plan: str) -> None:
    meant = conversation().say(said)
    assert (meant.outcome, meant.plan, meant.code) == ("unclear", None, "held")
    assert meant.proposal is not None
    assert meant.proposal.plan_text == plan


@pytest.mark.parametrize("said", ["don't go yet", "not yet", "left, right, I always mix them up", "左，右"])
def test_what_only_holds_back_or_names_the_sides_moves_nothing(said: str) -> None:
    meant = conversation().say(said)
    assert (meant.plan, meant.proposal) == (None, None)
