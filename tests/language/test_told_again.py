"""What is told once more in other words: a count put right, what a motion comes to, a heading, the frame."""

from __future__ import annotations

import pytest

from tests.language.test_usual import done

EIGHT = "arc left 360 deg radius 0.6 m; arc right 360 deg radius 0.6 m"


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("forward 1 m, 3 times, sorry, make it 2", "drive 1 m; drive 1 m"),
        ("forward and back 1 m four times, no, make it one", "drive 1 m; drive 1 m back"),
        ("turn left 90, twice, no, make it 45", "unclear"),
        ("drive 10 s at 0.3 m/s, which makes 3 m", "drive 10 s at 0.3 m/s"),
        ("fahr 10 s mit 0.3 m/s, dann sollten das drei Meter sein", "drive 10 s at 0.3 m/s"),
        ("以0.3米每秒开10秒，那就是三米", "drive 10 s at 0.3 m/s"),
        ("drive 10 s at 0.3 m/s, that makes 4 m", "unclear"),
        ("drive 10 s at 0.3 m/s, then 3 m", "drive 10 s at 0.3 m/s; drive 3 m"),
        ("Do two steps: 1) forward 1 m 2) turn left", "drive 1 m; turn left 90 deg"),
        ("Do this: forward 1 m, turn left", "drive 1 m; turn left 90 deg"),
        ("1) 1 m vor 2) links drehen", "drive 1 m; turn left 90 deg"),
        ("turn completely to the right twice", "turn right 360 deg; turn right 360 deg"),
        ("dreh dich zweimal vollständig nach links", "turn left 360 deg; turn left 360 deg"),
        ("forward 3 m, quarter turn left, another 1.5", "unclear"),
        ("spin round so you're facing back the way you came", "turn left 180 deg"),
        ("figure eight, first circle to the left, then the circle to the right, both with 60 cm radius", EIGHT),
        ("figure eight, first the circle to the left, then to the right, 60 cm radius", EIGHT),
        ("Where you stand is the origin, x is ahead and y left. Go to x = 2, y = 3", 'go to 2 3 named "(2, 3)"'),
        ("fahr auf (1.5, -2), x zeigt nach vorn und y nach links", 'go to 1.5 -2 named "(1.5, -2)"'),
        ("去(2, 1)，x朝前，y朝左", 'go to 2 1 named "(2, 1)"'),
        ("go to (2, 3), x is right and y is ahead", "unclear"),
        ("forward 1² m", "unclear"),
        ("fahr 1.250,5 mm vor", "drive 1.2505 m"),
        ("turn left 90º", "turn left 90 deg"),
    ],
)  # fmt: skip
def test_it_is_done_once(said: str, plan: str) -> None:
    assert done(said) == plan


def test_the_axes_are_not_read_where_the_robot_has_moved() -> None:
    assert done("drive 1 m", "You are at the origin, x is ahead, y is left. Go to (1, 2)") == "unclear"


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("great. now just step 3 again", "drive 0.6 m"),
        ("repeat the step number 2", "turn right 90 deg"),
        ("schön. jetzt nur schritt 3 nochmal", "drive 0.6 m"),
    ],
)
def test_a_step_is_named_by_its_number(said: str, plan: str) -> None:
    assert done("drive 1 m, turn right 90 degrees, drive 60 cm", said) == plan
