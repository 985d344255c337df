"""What comes several times in a row is shown once, and counted; nothing of it is lost."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.language.phrases import describe_text
from chatrobot.plan.shown import folded_plan, repeated, runs, shown_plan

SQUARE = "\n".join(["drive 1 m\nturn left 90 deg"] * 4)


def shown(plan_text: str) -> list[str]:
    return [f"{line.number}: {line.text}" for line in folded_plan(plan_text)]


@pytest.mark.parametrize(
    ("plan_text", "lines"),
    [
        ("\n".join(["drive 0.5 m"] * 54), ["1: 54 × drive 0.5 m"]),
        (SQUARE, ["1: 4 × (drive 1 m, turn left 90 deg)"]),
        (f"{SQUARE}\nwait 1 s", ["1: 4 × (drive 1 m, turn left 90 deg)", "9: wait 1 s"]),
        ("drive 1 m\ndrive 1 m", ["1: drive 1 m", "2: drive 1 m"]),
        (
            "\n".join(["drive 1 m\ndrive 1 m\ndrive 1 m\nturn left 90 deg"] * 2),
            ["1: 2 × (3 × drive 1 m, turn left 90 deg)"],
        ),
        ("\n".join(["drive 0.33333333 m"] * 3), ["1: 3 × drive 0.333 m"]),
        (
            "repeat 2\n  wait 1 s\n  wait 1 s\n  wait 1 s\nend\ndrive 1 m",
            ["1: repeat 2", "2:   3 × wait 1 s", "5: end", "6: drive 1 m"],
        ),
        (
            "\n".join(["repeat 2\n  drive 1 m\nend\nturn left 90 deg"] * 3),
            ["1: 3 ×", "1:   repeat 2", "2:     drive 1 m", "3:   end", "4:   turn left 90 deg"],
        ),
        ('say "one, two"\nsay "one, two"\nsay "one, two"', ['1: 3 × say "one, two"']),
    ],
)
def test_a_plan_is_shown_folded(plan_text: str, lines: list[str]) -> None:
    assert shown(plan_text) == lines


def test_a_group_that_is_too_long_for_a_line_takes_several() -> None:
    group = "\n".join(f'say "a sentence that takes its room, number {n}"' for n in range(3))
    first, *rest = folded_plan("\n".join([group] * 2))
    assert first.text == "2 ×"
    assert [line.text.strip() for line in rest] == group.splitlines()


@given(st.lists(st.sampled_from(["drive 1 m", "turn left 90 deg", "wait 1 s"]), min_size=1, max_size=40))
def test_nothing_is_lost_and_every_line_tells_where_it_begins(lines: list[str]) -> None:
    assert [item for count, group in runs(lines) for _ in range(count) for item in group] == lines
    for line in folded_plan("\n".join(lines)):
        first = re.sub(r"^[^a-z]*", "", line.text)
        assert not first or first.startswith(lines[line.number - 1])  # a line of its own: 2 ×


def test_what_stands_alone_is_shown_as_it_is() -> None:
    text = "drive 1.23456 m\nturn left 12.34567 deg\nwait 1 s"
    assert [line.text for line in folded_plan(text)] == shown_plan(text).splitlines()


def test_a_sentence_counts_as_well() -> None:
    assert describe_text(SQUARE, "en") == "4 × (drive forward 1 m, turn left 90°)"
    assert describe_text("repeat 4\n  drive 1 m\n  turn left 90 deg\nend\nwait 1 s", "en") == (
        "4 × (drive forward 1 m, turn left 90°), wait 1 s"
    )
    assert describe_text("\n".join(["drive 0.5 m"] * 54), "zh") == "54 × 向前走 0.5 米"
    steps = "\n".join(f"drive {n} m" for n in range(1, 10))
    assert describe_text(steps, "en").endswith("drive forward 6 m, and 3 more steps")


def test_one_of_a_kind_has_no_count() -> None:
    assert repeated(1, ["a", "b"], ", ") == "a, b"
