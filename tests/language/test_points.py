"""Points, places and sizes as engineers and teachers write them: coordinates, headings, names, a size said again."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Go
from tests.language.dialogue_runner import Conversation
from tests.language.test_usual import done


@pytest.mark.parametrize(
    ("said", "go"),
    [
        (
            "Kindly go to the coordinates x = 1.2 and y = 0.8 metre, your heading should be 90 degrees",
            (1.2, 0.8, 90),
        ),
        ("goto (2.0, -1.0), final yaw = +90°", (2.0, -1.0, 90)),
        ("go to x 1.5, y minus 1", (1.5, -1.0, None)),
        ("到点 (1.5, -0.8)，单位米，到位后航向给到90°", (1.5, -0.8, 90)),
        (
            "fahr zu den Koordinaten x = 1,5 y = -1 und richte dich auf Gierwinkel 90 Grad aus",
            (1.5, -1.0, 90),
        ),
        ("go to (1, 2)", (1.0, 2.0, None)),
    ],
)
def test_a_point_may_have_a_heading(said: str, go: tuple[float, float, float | None]) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    [step] = plan.steps
    assert isinstance(step, Go)
    yaw_deg = None if step.yaw_rad is None else math.degrees(step.yaw_rad)
    assert (step.x_m, step.y_m, yaw_deg) == pytest.approx(go)


@pytest.mark.parametrize(
    ("said", "squares"),
    [
        ("a square with side 50, that is 50 cm", 1),
        ("three squares with side 1 m", 3),
        ("a square with 50 sides", 0),
    ],
)
def test_a_size_is_no_count(said: str, squares: int) -> None:
    plan = Conversation().say(said).plan
    assert (len(plan.steps) if plan is not None else 0) == 8 * squares


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ("This place please remember as sample point.", "sample point"),
        ("This place where you are has the name of table.", "table"),
        ("aktuelle Position merken als A", "a"),
        ("das hier is deine garage ok? merk dir das", "garage"),
    ],
)
def test_a_place_is_named_in_any_order_of_words(said: str, name: str) -> None:
    assert Conversation().say(said).remember_place == name


@pytest.mark.parametrize(
    ("said", "duration_s"),
    [
        ("turn left at 20 degrees per second for four and a half seconds", 4.5),
        ("drive at 20 cm per second for two and a half seconds", 2.5),
    ],
)
def test_a_half_behind_a_number_belongs_to_it_behind_another_unit_too(said: str, duration_s: float) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    assert [getattr(step, "duration_s", None) for step in plan.steps] == [duration_s]


@pytest.mark.parametrize(
    "said",
    [
        "Circle time! Radius 50 cm, counterclockwise.",
        "circle of 50 cm radius, counterclockwise, and finish facing the way you're facing now",
    ],
)
def test_a_figure_that_is_called_out_is_drawn_whole(said: str) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    assert [getattr(step, "angle_rad", None) for step in plan.steps] == [pytest.approx(2 * math.pi)]


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        (
            "Go to the point x = 1.5, y = -0.8. The origin is where you're standing, x points ahead, y to your left.",
            'go to 1.5 -0.8 named "(1.5, -0.8)"',
        ),
        ("Fahr zu x = 1,2 m, y = -0,5 m.", 'go to 1.2 -0.5 named "(1.2, -0.5)"'),
        (
            "以你出发的地方为原点，到x等于1.5、y等于负0.5那个点去，停的时候车头冲着y轴正方向",
            'go to 1.5 -0.5 facing 90 deg named "(1.5, -0.5, 90)"',
        ),
    ],
)
def test_a_point_ends_a_sentence_and_a_heading_is_told_by_an_axis(said: str, plan: str) -> None:
    assert done(said) == plan
