"""Two orders in one sentence do what each does alone, in the order they are said, or are asked back."""

from __future__ import annotations

import itertools

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation
from tests.language.test_usual import done

EN = [
    "drive 1 m", "drive forward", "back up 30 cm", "slide left 40 cm", "slide right", "turn left",
    "turn right 30 degrees", "turn around", "spin around", "curve left", "draw a square",
    "draw a circle with a radius of 1 m", "draw a circle to the right", "go to (1, 2)", "wait 3 seconds",
    "drive 1 m at 0.2 m/s", "turn 30", "spin",
]  # fmt: skip
ZH = [
    "前进一米", "后退三十厘米", "左转", "右转30度", "掉头", "向左平移四十厘米", "画一个正方形", "画一个半径一米的圆",
    "等三秒", "向左转三圈", "去(1,2)", "前进两米两次",
]  # fmt: skip
DE = [
    "fahr einen Meter vor", "fahr 30 cm zurück", "dreh dich nach links", "dreh dich um 30 Grad nach rechts",
    "rutsch 40 cm nach links", "fahr ein Quadrat", "warte drei Sekunden",
]  # fmt: skip
JOINTS = {"en": (" and ", ". "), "zh": ("，然后", "。"), "de": (" und ", ", dann ")}


def _plan(text: str) -> str | None:
    plan = Conversation().say(text).plan
    return format_plan(plan).replace(" from start", "") if plan is not None else None


@pytest.mark.parametrize(("language", "orders"), [("en", EN), ("zh", ZH), ("de", DE)])
def test_nothing_of_two_orders_is_lost_or_taken_for_the_other(language: str, orders: list[str]) -> None:
    alone = {order: _plan(order) for order in orders}
    wrong, asked = [], 0
    for first, second in itertools.permutations(orders, 2):
        for joint in JOINTS[language]:
            got = _plan(first + joint + second)
            if got is None:
                asked += 1
            elif got != f"{alone[first]}\n{alone[second]}":
                wrong.append((first + joint + second, got[:80]))
    assert wrong == []
    assert asked < 0.3 * len(orders) ** 2 * len(JOINTS[language])


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("go right then forward",), "turn right 90 deg; drive 0.5 m"),
        (("turn left, turn left, turn right",), "turn left 90 deg; turn left 90 deg; turn right 90 deg"),
        (("drive 2 m", "turn left and go home"), "turn left 90 deg; go to 0 0"),
        (("slide 1 m left and slide back",), "drive 1 m left; drive 1 m right"),
        (("turn round and look behind you",), "turn left 180 deg"),
    ],
)
def test_an_order_that_points_at_another_is_read_with_it(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan
