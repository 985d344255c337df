"""Plan text as it is shown: tidy numbers; what runs and travels stays exact."""

from __future__ import annotations

import re

import pytest
from hypothesis import given

from chatrobot.plan.shown import shown_plan
from chatrobot.plan.text import format_plan, parse_plan
from tests.plan.plans import plans


@pytest.mark.parametrize(
    ("exact", "shown"),
    [
        ("drive 1.9000000000000001 m", "drive 1.9 m"),
        ("turn left 29.773198144942803 deg", "turn left 29.8 deg"),
        ("turn left 29.773198144942803 deg at 0.30000000000000004 rad/s", "turn left 29.8 deg at 0.3 rad/s"),
        ("go to 4.000000000000001 -9.8e-07", "go to 4 0"),
        ("twist 0.2 -9.8e-07 0.1 for 1 s", "twist 0.2 0 0.1 for 1 s"),
        ("turn right 11.25 deg", "turn right 11.25 deg"),
        ("drive 0.3333333333333333 m at 0.12345 m/s", "drive 0.333 m at 0.123 m/s"),
        ("drive 1 m until obstacle within 0.30000000000000004 m", "drive 1 m until obstacle within 0.3 m"),
        ('say "pi is 3.14159265, \\"e\\" 2.71828182"', 'say "pi is 3.14159265, \\"e\\" 2.71828182"'),
        ('go to 1.00049999999 0 named "room 1.23456"', 'go to 1 0 named "room 1.23456"'),
        ("repeat 3\n  drive 0.1000000001 m\nend", "repeat 3\n  drive 0.1 m\nend"),
    ],
)
def test_a_shown_plan_has_no_float_noise(exact: str, shown: str) -> None:
    assert shown_plan(exact) == shown


@given(plans)
def test_a_shown_plan_has_the_words_of_the_exact_one(plan: object) -> None:
    text = format_plan(plan)  # type: ignore[arg-type]
    numbers = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
    assert numbers.sub("N", shown_plan(text)) == numbers.sub("N", text)
    assert parse_plan(text) == plan, "what runs is not touched"
