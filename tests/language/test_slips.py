"""What was meant takes the place of a slip within one text, and what says it again adds nothing."""

from __future__ import annotations

import pytest

from chatrobot.language.slips import without_slips
from tests.language.dialogue_runner import conversation
from tests.language.test_usual import done


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("go forward 2 no wait 1 metre, just 1. n then 90 left", "drive 1 m; turn left 90 deg"),
        ("90 degrees to the rigth, no wait, left, ninety left, then 50cm straigth", "turn left 90 deg; drive 0.5 m"),
        ("slide left 40 cm, ugh wrong, misread it, it's right, 40 cm", "drive 0.4 m right"),
        ("forward a metre, slip of the tongue, a metre and a half", "drive 1.5 m"),
        ("forward 40 cm, yes, forty, not fourteen", "drive 0.4 m"),
        ("at the next turn right, er no, left I mean: so turn 90 left and then 1.5 m", "turn left 90 deg; drive 1.5 m"),
        ("drive 1 metre backwards, nah, forwards, then wait 2 seconds", "drive 1 m; wait 2 s"),
        ("turn le... no, right 90 degrees", "turn right 90 deg"),
        ("turn 90 degrees left, whoops I meant right, right 90 degrees", "turn right 90 deg"),
        ("wait 5 seconds, no, 8, then back 1 m", "wait 8 s; drive 1 m back"),
        ("two circles of half a metre radius, or wait, three circles", "arc left 1080 deg radius 0.5 m"),
        ("左边平移40厘米，呃不对，看反了，是右边，40厘米", "drive 0.4 m right"),
        ("往前走两米，不等等，一米，就一米。然后左转90度", "drive 1 m; turn left 90 deg"),
        ("右转十五度，嗯十五，不是五十", "turn right 15 deg"),
        ("左转45，哎等一下，右，右转四十五度，再往前一米", "turn right 45 deg; drive 1 m"),
        ("往前走三次，每次50厘米，不好意思，每次60厘米", "; ".join(["drive 0.6 m"] * 3)),
        ("An der nächsten rechts, nee Moment, links mein ich: also 90 Grad links drehn und dann 1,5 Meter",
         "turn left 90 deg; drive 1.5 m"),
        ("drei Meter vor äh nee Quatsch zwei Meter sonst hängst du in der Garderobe", "drive 2 m"),
        ("45 nach links, ach halt, rechts, fünfundvierzig rechts, dann 1 m vor", "turn right 45 deg; drive 1 m"),
        ("vierzig Zentimeter nach vorn, ja, vierzig, nicht vierzehn", "drive 0.4 m"),
        ("40 cm nach links rüber, ach falsch, verguckt, rechts ist es, 40 cm", "drive 0.4 m right"),
        ("zwei Kreise mit 50 cm Radius, oder warte, drei Kreise", "arc left 1080 deg radius 0.5 m"),
    ],
)  # fmt: skip
def test_what_was_meant_is_done(said: str, plan: str) -> None:
    assert done(said) == plan


def test_what_was_meant_is_done_of_the_motion_before() -> None:
    assert done("drive 1 m", "do that three times. No, I tell a lie, twice") == "drive 1 m; drive 1 m"


@pytest.mark.parametrize(
    "text",
    [
        "half a metre, no, 75",
        "20 cm left, 20 cm, no, 30 cm left",
        "turn right, no left turn",
        "turn left 90, no, is it right?",
        "turn left 90, then wait, no, right",
        "sorry darling, i said left but i meant right",
    ],
)
def test_what_is_not_sure_is_left_as_it_stands(text: str) -> None:
    assert without_slips(text, "en") == text


@pytest.mark.parametrize(
    "said",
    [
        "no, 2 m is the height of the door",
        "wait, is it 2 m or 3 m?",
        "前进1.2m，不是12m",
        "等等，是2米还是3米？",
    ],
)
def test_what_takes_nothing_back_moves_nothing(said: str) -> None:
    assert conversation().say(said).plan is None
