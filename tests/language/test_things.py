"""What is told of a thing tells an order how far to go: its length, or how far ahead it is."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import Conversation
from tests.language.test_usual import done


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("the rug is 2 metres 40 long, do a quarter of that straight ahead", "drive 0.6 m"),
        ("you should go forward three of Ben's steps, and one of his steps is 40 cm", "drive 1.2 m"),
        ("one wheel turn is 30 cm on the floor. Give me six wheel turns' worth forward", "drive 1.8 m"),
        ("Go back two desk lengths, my desk is 1.2 m long", "drive 2.4 m back"),
        (
            "The bench is 2.4 m long and you're at one end, looking along it. Drive to the middle.",
            "drive 1.2 m",
        ),
        ("Eine Fliese ist 33 cm lang. Fahr vier Fliesen vor.", "drive 1.32 m"),
        ("die Aula ist zwölf Meter lang, fahr ein Viertel von der Länge nach vorne", "drive 3 m"),
        ("轮子滚一圈是0.4米，往前滚三圈半", "drive 1.4 m"),
        ("这面墙总共6米长，你往前走三分之二", "drive 4 m"),
    ],
)
def test_an_order_counts_what_is_so_long(said: str, plan: str) -> None:
    assert done(said) == plan


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        (
            "the bay door's 4 metres dead ahead of you. drive up till you're one metre short of it",
            "drive 3 m",
        ),
        (
            "there's 65 cm between you and the sofa in front. I only want a gap of 20, so close it up.",
            "drive 0.45 m",
        ),
        ("go up to that yellow line, its a metre and a half straight in front", "drive 1.5 m"),
        (
            "gate two is 3 m in front of you, and gate three is 2 m more after it. Drive to gate three",
            "drive 5 m",
        ),
        ("The wall is 1.5 m behind you. Back up until you're half a metre from it.", "drive 1 m back"),
        (
            "Bis zum Kühlschrank genau vor dir sinds 3,20 m. Fahr hin, aber bleib 70 cm davor stehen",
            "drive 2.5 m",
        ),
        (
            "Bis zum Regal vor Ihnen sind es zwei Meter. Lassen Sie 30 cm Abstand und fahren Sie den Rest.",
            "drive 1.7 m",
        ),
        ("你离正前方的窗台刚好三米，我要你直着开过去，停在离窗台还剩七十公分的地方", "drive 2.3 m"),
    ],
)
def test_it_goes_up_to_what_is_so_far_ahead(said: str, plan: str) -> None:
    assert done(said) == plan


@pytest.mark.parametrize(
    "said",
    [
        "The rug is 2.4 m long.",
        "The rug is 2 m long. Drive its width.",
        "The wall is three metres ahead of you, don't drive up to it.",
        "The wall is 2 m ahead of you, drive up to it.",  # nobody drives into a wall
        "The wall is 30 cm ahead of you. Drive up to it and stop 50 cm short.",
        "The shelf is 2 m to your left. Go to it.",
        "The desk is 2 m away. Go to it.",
        "Wir brauchen vier Fliesen, eine Fliese ist 33 cm lang.",
        "Der Hund liegt zwei Meter vor dir, fahr um ihn herum.",
        "墙在你前面三米，别开过去。",
        "围栏长四米，我儿子倒着走了三分之一。",
    ],
)
def test_what_only_tells_of_a_thing_moves_nothing(said: str) -> None:
    assert Conversation().say(said).plan is None
