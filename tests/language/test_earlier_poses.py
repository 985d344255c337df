"""The robot goes back to where it was before, at or after something it did; what it did not do leads nowhere."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation

TOUR = ("go forward 2 m", "draw a square", "turn left 45 degrees", "go forward 1 m")
THREE = ("go forward 1 m, turn left, go forward 1 m, turn right, go forward 1 m",)


def done(*turns: str) -> str:
    meant = conversation(*turns[:-1]).say(turns[-1])
    return "; ".join(format_plan(meant.plan).splitlines()) if meant.plan else meant.outcome


@pytest.mark.parametrize(
    ("turns", "text", "plan"),
    [
        (TOUR, "go back to where you were before the square", "go to 2 0 facing 0 deg"),
        (TOUR, "return to the spot where the square started", "go to 2 0 facing 0 deg"),
        (TOUR, "back to where you were right before you turned", "go to 2 0 facing 0 deg"),
        (TOUR, "come back to before the first drive", "go to 0 0 facing 0 deg"),
        (TOUR, "go back to where you were before those last two moves", "go to 2 0 facing 0 deg"),
        (THREE, "go back to where you were before the right turn", "go to 1 1 facing 90 deg"),
        (THREE, "go back to where you were after the second turn", "go to 1 1"),
        (TOUR, "go back to the last corner", "go to 2 0"),
        (TOUR, "go to the second corner of the square", "go to 2.5 0.5"),
        (THREE, "go back to after step 1", "go to 1 0"),
        (THREE, "回到第三步之前", "go to 1 0 facing 90 deg"),
        (TOUR, "回到画正方形之前的位置", "go to 2 0 facing 0 deg"),
        (TOUR, "退回左转之前的地方", "go to 2 0 facing 0 deg"),
        (("前进80厘米，停5秒，然后左移60厘米",), "回到刚才停5秒的那个位置", "drive 0.6 m right"),
        (TOUR, "fahr dahin zurück, wo du vor dem Quadrat warst", "go to 2 0 facing 0 deg"),
    ],
)
def test_it_goes_to_where_something_was_done(turns: tuple[str, ...], text: str, plan: str) -> None:
    assert done(*turns, text) == plan


def test_straight_drives_since_then_are_driven_back_without_turning() -> None:
    turns = ("go forward 1 m", "slide right 50 cm", "back to where you were before the sideways bit")
    assert done(*turns) == "drive 0.5 m left"


@pytest.mark.parametrize(
    ("turns", "text"),
    [
        (TOUR, "go back to where you were before the circle"),
        (THREE, "go back to where you were before the turn"),
        (THREE, "go back to where you were nine moves ago"),
        (TOUR, "回到画圆之前的位置"),
    ],
)
def test_what_was_not_done_or_done_twice_is_asked_about(turns: tuple[str, ...], text: str) -> None:
    assert done(*turns, text) in ("unclear", "refused")


def test_a_place_of_that_name_is_the_place() -> None:
    turns = ("remember this as the last corner", "go forward 1 m", "turn left", "go forward 1 m")
    assert done(*turns, "go to the last corner") == 'go to 0 0 named "last corner"'
