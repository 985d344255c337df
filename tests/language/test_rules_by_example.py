"""What the comments of the rules in `rephrase.toml` quote is done as they say: no corpus has these wordings."""

from __future__ import annotations

import pytest

from tests.language.test_likeliest import done

STOPPING = "\n".join(["drive 0.5 m\nwait 1 s\nturn left 90 deg"] * 4)
HALF_M = "arc {} 90 deg radius 0.5 m"


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("a small circle", "arc left 360 deg radius 0.25 m"),
        ("a square with a stop at each corner", STOPPING),
        ("after 3 seconds of waiting", "wait 3 s"),
        ("could I trouble you for a half turn?", "turn left 180 deg"),
        ("curve left and right", f"{HALF_M.format('left')}\n{HALF_M.format('right')}"),
        ("heading +30", "turn left 30 deg"),
        ("mind the dog and go left 50 cm", "drive 0.5 m left"),
        ("nudge left", "drive 0.25 m left"),
        ("six slides, alternating left and right, 20 cm each", "\n".join(["drive 0.2 m left\ndrive 0.2 m right"] * 3)),
        ("speed up and go 1 meter", "drive 1 m at 0.51 m/s"),
        ("take two lefts", "turn left 90 deg\nturn left 90 deg"),
        ("the opposite of left", "turn right 90 deg"),
        ("turn -90", "turn right 90 deg"),
        ("turn left three sixty", "turn left 360 deg"),
        ("rotate until you've done a full circle", "turn left 360 deg"),
        ("前进一米，五秒走完", "drive 1 m at 0.2 m/s"),
        ("前进五秒，每秒零点二米，正好一米", "drive 5 s at 0.2 m/s"),
        ("右转90度，就是3点钟方向", "turn right 90 deg"),
        ("同时前进和左转", HALF_M.format("left")),
        ("左前方走一米，四十五度那么斜", "drive 1 m toward 45 deg"),
        ("左转三下", "turn left 90 deg\nturn left 90 deg\nturn left 90 deg"),
        ("左转周角", "turn left 360 deg"),
        ("等一个半分钟", "wait 90 s"),
        ("绕大圈", "arc left 360 deg radius 1 m"),
        ("缓前进", "drive 0.5 m at 0.15 m/s"),
    ],
)  # fmt: skip
def test_the_example_of_a_rule_is_done_as_it_says(said: str, plan: str) -> None:
    assert done(said) == plan


@pytest.mark.parametrize(
    ("before", "said", "plan"),
    [
        ("forward 1 m", "before you do it again, turn left", "turn left 90 deg\ndrive 1 m"),
        ("forward 1 m", "turn left and the same distance again", "turn left 90 deg\ndrive 1 m"),
        ("forward 1 m", "No, only half of that", "drive 0.5 m back"),
        ("forward 1 m", "只要半米", "drive 0.5 m back"),
        ("forward 1 m", "还是两米吧", "drive 1 m"),
        ("forward 1 m, turn left, forward 50 cm", "again, but swap them", "drive 0.5 m\nturn left 90 deg\ndrive 1 m"),
        ("forward 1 m, turn left, forward 50 cm", "undo, undo", "drive 0.5 m back\nturn right 90 deg"),
    ],
)  # fmt: skip
def test_the_example_of_a_rule_after_a_motion_is_done_as_it_says(before: str, said: str, plan: str) -> None:
    assert done(before, said) == plan


TO_DOCK, TO_SHELF = 'go to 0 0 named "dock"', 'go to 2 0 named "shelf"'


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("patrol between the dock and the shelf", f"{TO_DOCK}\n{TO_SHELF}"),
        ("go back and forth between the dock and the shelf twice", "\n".join([TO_DOCK, TO_SHELF] * 2)),
        ("go back and forth between the dock and here 3 times", "\n".join([f"{TO_DOCK}\ngo to 0 0 from start"] * 3)),
        ("first the dock, then the shelf", f"{TO_DOCK}\n{TO_SHELF}"),
        ("go to where the dock is", TO_DOCK),
        ("visit the dock", TO_DOCK),
        ("face away from the dock", "face 180 deg\nturn left 180 deg"),
        ("turn your back to the dock", "face 180 deg\nturn left 180 deg"),
        ("dock和shelf之间来回两次", "\n".join([TO_DOCK, TO_SHELF] * 2)),
        ("背对dock", "face 180 deg\nturn left 180 deg"),
        ("fahr zweimal zwischen dock und shelf hin und her", "\n".join([TO_DOCK, TO_SHELF] * 2)),
        ("dreh dem dock den Rücken zu", "face 180 deg\nturn left 180 deg"),
    ],
)  # fmt: skip
def test_places_are_gone_to_by_turns_and_turned_away_from(said: str, plan: str) -> None:
    assert done("call this spot dock", "forward 2 m", "call this spot shelf", "turn left", said) == plan
