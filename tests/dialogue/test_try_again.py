"""After an order that was refused, `try again` means that one, and no part of an older motion is taken for its."""

from __future__ import annotations

import pytest
from tests.dialogue.undo_rig import UndoRig

from chatrobot.core.events import Interpreted

TOO_FAR = "drive 5 m"


def _plans(rig: UndoRig, text: str) -> tuple[str, str]:
    turn = rig.session.say(text)
    rig.live(40)
    plan = next((e.plan_text for e in rig.events if isinstance(e, Interpreted) and e.turn == turn), "")
    return rig.session.results[turn].outcome, plan


@pytest.mark.parametrize("said", ["try again", "now try again", "再试一次", "versuch's nochmal"])
def test_try_again_does_what_was_refused(said: str) -> None:
    rig = UndoRig("home")
    assert _plans(rig, "back 20 cm")[0] == "completed"
    assert _plans(rig, TOO_FAR)[0] == "refused"
    assert _plans(rig, "where are you?")[0] == "answered"
    assert _plans(rig, said) == ("refused", "drive 5 m")


@pytest.mark.parametrize("said", ["again", "do the second step again"])
def test_no_older_motion_is_repeated_after_a_refusal(said: str) -> None:
    rig = UndoRig("home")
    for text in ("turn left 90", "back 20 cm", "turn right 90"):
        assert _plans(rig, text)[0] == "completed"
    assert _plans(rig, "drive 3 m, turn left 90, then forward 20 cm")[0] == "refused"
    assert _plans(rig, said)[0] == "unclear"


def test_a_motion_since_then_is_what_again_means() -> None:
    rig = UndoRig("home")
    assert _plans(rig, TOO_FAR)[0] == "refused"
    assert _plans(rig, "turn left 90")[0] == "completed"
    assert _plans(rig, "again") == ("completed", "turn left 90 deg")


def test_try_again_after_what_was_not_understood_repeats_nothing() -> None:
    rig = UndoRig("home")
    assert _plans(rig, "turn left 90")[0] == "completed"
    assert _plans(rig, "go to the counter")[0] == "unclear"
    assert _plans(rig, "try again")[0] == "unclear"
    assert _plans(rig, "turn left 90")[0] == "completed"
    assert _plans(rig, "try again") == ("completed", "turn left 90 deg")
