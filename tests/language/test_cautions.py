"""A caution beside an order changes nothing: nothing is to be hit anyway. Alone it moves nothing."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation


def done(*turns: str) -> str:
    meant = conversation(*turns[:-1]).say(turns[-1])
    return "; ".join(format_plan(meant.plan).splitlines()) if meant.plan else meant.outcome


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("go forward 1 m without hitting anything", "drive 1 m"),
        ("go forward 1 m and don't hit anything", "drive 1 m"),
        ("turn left 90 degrees, don't crash", "turn left 90 deg"),
        ("drive 2 m without touching anything, then turn left 90 degrees", "drive 2 m; turn left 90 deg"),
    ],
)
def test_a_caution_is_passed_over(text: str, plan: str) -> None:
    assert done(text) == plan


@pytest.mark.parametrize(
    "text", ["don't hit the wall", "don't crash", "go forward 1 m without touching the giraffe"]
)
def test_a_caution_alone_or_about_a_thing_nobody_knows_is_asked_about(text: str) -> None:
    assert done(text) == "unclear"


@pytest.mark.parametrize("text", ["hit the wall", "crash into the wall without hesitating"])
def test_to_do_harm_is_refused(text: str) -> None:
    assert done(text) == "refused"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("go forward 1 m, turn left 90 degrees, go 1 m", "all the way back"), "go to 0 0"),
        (("go forward 1 m", "backtrack"), "drive 1 m back"),
        (("meanwhile turn left 90 degrees",), "turn left 90 deg"),
        (("go forward 1 m and while you're at it turn left 90 degrees",), "drive 1 m; turn left 90 deg"),
    ],
)
def test_turns_of_phrase(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


def test_a_circle_beside_a_square_is_a_figure_of_its_own() -> None:
    plan = done("draw a square of 50 cm and a circle with radius 30 cm")
    assert plan.count("drive 0.5 m") == 4
    assert plan.endswith("arc left 360 deg radius 0.3 m")
