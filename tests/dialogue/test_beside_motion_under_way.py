"""What was asked before an order is no part of what is said while that is done, and a pause keeps what is paused."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from tests.dialogue.undo_rig import UndoRig

from chatrobot.dialogue.options import Options
from chatrobot.dialogue.understanding import Instruction
from chatrobot.language.interpretation import Interpretation


@pytest.fixture
def rig() -> UndoRig:
    return UndoRig()


@pytest.mark.parametrize(
    ("asked", "order", "said"),
    [
        ("the opposite", "drive 2 m", "faster"),
        ("andersrum", "fahr 2 m vor", "schneller"),
        ("doppelt so weit", "fahr 1 m vor", "langsamer"),
        ("两倍远", "向前走1米", "慢一点"),
    ],
)
def test_what_was_asked_back_before_an_order_does_not_change_it_later(
    monkeypatch: pytest.MonkeyPatch, asked: str, order: str, said: str
) -> None:
    rig = UndoRig(options=Options(answers_in_turn=True))  # elsewhere, it changes the speed at once
    assert rig.do(asked).outcome == "unclear"
    turn = rig.session.say(order)
    rig.live(1.0)
    read, interpret = [], rig.session.understanding.interpret

    def interpreted(text: str, under_way: Sequence[Instruction] = ()) -> Interpretation:
        read.append(interpret(text, under_way))
        return read[-1]

    monkeypatch.setattr(rig.session.understanding, "interpret", interpreted)
    rig.session.say(said)
    rig.live(30.0)
    assert read
    assert not [meant.plan for meant in read if meant.plan is not None]  # another pace is proposed
    assert rig.session.results[turn].outcome == "completed"


def test_a_stop_closes_the_question_before_it(rig: UndoRig) -> None:
    turn = rig.session.say("向前走2米")
    rig.live(1.5)
    rig.session.say("停")
    rig.live(1.0)
    assert rig.session.results[turn].outcome == "stopped"
    assert rig.do("慢慢继续").proposal is not None
    rig.session.say("停")
    rig.live(1.0)
    assert rig.do("向前走1米").duration_s < 6.0  # at the usual pace


@pytest.mark.parametrize("said", ["continue, but slowly", "weiter, aber langsam", "继续，但是慢一点"])
def test_going_on_slowly_goes_on_with_what_is_paused(rig: UndoRig, said: str) -> None:
    turn = rig.session.say("forward 2 m")
    rig.live(1.5)
    rig.session.pause()
    rig.live(1.0)
    rig.session.say(said)
    rig.live(3.0)
    assert rig.speed_mps == pytest.approx(0.15, abs=0.01)
    rig.live(15.0)
    assert rig.session.results[turn].outcome == "completed"
    assert rig.x_m == pytest.approx(2.0, abs=0.05)


def test_going_on_after_an_undo_is_asked_about(rig: UndoRig) -> None:
    rig.do("forward 1 m")
    rig.do("undo")
    assert rig.do("go on").outcome == "unclear"
    assert rig.x_m == pytest.approx(0.0, abs=0.05)
