"""A side, a way back and a pause belong to the verb that they are said with."""

from __future__ import annotations

import pytest

from tests.language.test_usual import done


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("turn left and forward 1 m", "turn left 90 deg; drive 1 m"),
        ("could you turn right?", "turn right 90 deg"),
        ("forward one meter and then turn right?", "drive 1 m; turn right 90 deg"),
        ("drive left and forward 1 m", "drive 1 m toward 45 deg"),
        ("back! back!", "drive 0.5 m back; drive 0.5 m back"),
        ("forward 3 m. Then undo 1 m of it", "drive 3 m; drive 1 m back"),
        ("take 5 seconds to turn left", "turn left 90 deg at 18 deg/s"),
        ("前进3米，然后撤销1米", "drive 3 m; drive 1 m back"),
    ],
)
def test_a_side_or_a_back_is_that_of_its_verb(said: str, plan: str) -> None:
    assert done(said) == plan


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("前进一米两秒后左转", "drive 1 m; wait 2 s; turn left 90 deg"),
        ("前进一米停一下左转停一下前进一米", "drive 1 m; wait 1 s; turn left 90 deg; wait 1 s; drive 1 m"),
        (
            "forward 50 cm, then stop for a moment, then right 50 cm",
            "drive 0.5 m; wait 1 s; drive 0.5 m right",
        ),
        ("花5秒左转", "turn left 90 deg at 18 deg/s"),
    ],
)
def test_a_pause_or_a_time_in_a_list_is_kept(said: str, plan: str) -> None:
    assert done(said) == plan
