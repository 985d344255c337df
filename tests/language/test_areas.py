"""A shape may be told by its area, its diagonal or its perimeter and a side."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Arc, Drive
from tests.language.dialogue_runner import Conversation


def sides_of(text: str) -> list[float]:
    """The lengths of the drives of a text's plan, or the radius of its arc; nothing where it is asked about."""
    plan = Conversation().say(text).plan
    steps = plan.steps if plan is not None else ()
    return [
        s.radius_m if isinstance(s, Arc) else s.distance_m or 0.0
        for s in steps
        if isinstance(s, (Arc, Drive))
    ]


@pytest.mark.parametrize(
    ("text", "sides_m"),
    [
        ("a square with an area of 4 square metres", [2, 2, 2, 2]),
        ("drive a square that covers four square metres", [2, 2, 2, 2]),
        ("drive a square of 4 m2", [2, 2, 2, 2]),
        ("a circle with an area of 3.1416 m2", [1]),
        ("a rectangle 2 m wide with an area of 6 square metres", [2, 3, 2, 3]),
        ("a hexagon with an area of 2 square metres", [math.sqrt(8 * math.tan(math.pi / 6) / 6)] * 6),
        ("a triangle with an area of 2 square metres", [math.sqrt(8 * math.tan(math.pi / 3) / 3)] * 3),
        ("a rectangle with a perimeter of 10 m, one side 3 m", [3, 2, 3, 2]),
        ("走一个面积四平方米的正方形", [2, 2, 2, 2]),
        ("走一个圆，面积3.1416平方米", [1]),
        ("走一个面积两平方米的长方形，宽一米", [1, 2, 1, 2]),
        ("走一个正方形，对角线长两米", [math.sqrt(2)] * 4),
        ("Fahre ein Quadrat mit einer Fläche von vier Quadratmetern links herum", [2, 2, 2, 2]),
        ("ein Quadrat mit einer Diagonale von 2 m", [math.sqrt(2)] * 4),
    ],
)
def test_a_shape_has_the_sides_that_its_measure_gives(text: str, sides_m: list[float]) -> None:
    assert sides_of(text) == pytest.approx(sides_m, abs=1e-3)


@pytest.mark.parametrize(
    "text",
    [
        "a rhombus with an area of 2 square metres",
        "a square with an area of 4 square metres and sides of 1 m",
        "a square with an area of 400 square centimetres",
        "drive 4 square metres",
        "there are 20 square metres in this room",
        "a rectangle with a perimeter of 10 m, one side 6 m",
    ],
)
def test_an_area_that_tells_no_size_is_asked_about(text: str) -> None:
    assert sides_of(text) == []
