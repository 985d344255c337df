"""A program that was undone is run again by a redo, rehearsed and asked about like any program that is kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.dialogue.program_rig import House

from chatrobot.core.events import Interpreted, ProgramWritten, Rehearsed
from chatrobot.dialogue.options import Options

ASKED = "Generate a ROS 2 Python program to drive forward 30 cm."


@pytest.fixture
def house(tmp_path: Path) -> Iterator[House]:
    """A program has driven 30 cm, and was undone."""
    house = House("empty", tmp_path)
    assert house.do(ASKED).outcome == "completed"
    assert house.do("undo").pose.x_m == pytest.approx(0.0, abs=0.02)
    yield house
    house.connection.close()


@pytest.mark.parametrize("word", ["redo", "重做"])
def test_redo_runs_the_program_again(house: House, word: str) -> None:
    again = house.do(word)
    assert again.outcome == "completed"
    assert again.pose.x_m == pytest.approx(0.3, abs=0.02)
    (written,) = house.all(ProgramWritten)
    assert (written.program, written.is_new) == ("drive forward", False)
    assert not any(event.plan_text for event in house.all(Interpreted)), "it is no `go to`"
    assert house.do("undo").pose.x_m == pytest.approx(0.0, abs=0.02)


def test_redo_of_a_program_is_asked_about_where_each_motion_is(house: House) -> None:
    house.session.options = Options(approve=True)
    house.events.clear()
    turn = house.session.say("redo")
    while not house.all(Rehearsed):
        house.session.pump(0.1)
    assert house.all(Rehearsed)[0].needs_approval
    house.session.approve(turn, False)
    while turn not in house.session.results:
        house.session.pump(0.1)
    assert (house.session.results[turn].outcome, house.session.results[turn].path_m) == ("refused", 0.0)


def test_several_turns_with_a_program_among_them_are_not_redone_in_one_go(house: House) -> None:
    house.do("redo")
    house.do("forward 20 cm")
    house.do("undo both")
    again = house.do("redo")
    assert (again.outcome, again.path_m) == ("refused", 0.0)
    assert "run" in again.reply
