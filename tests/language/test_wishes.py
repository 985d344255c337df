"""What others who are present want is done where they want the whole of it; what they said orders nothing."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation
from tests.language.test_usual import done


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("go on, twice round on the spot to the left, Emma wants to see it",), "turn left 360 deg; turn left 360 deg"),
        (("the kids reckon you should go forward 1 m",), "drive 1 m"),
        (("the boss is asking you to back up 1 metre",), "drive 1 m back"),
        (("my daughter wants you to drive 2 metres and then turn left 90 degrees",), "drive 2 m; turn left 90 deg"),
        (("go forward 1 m", "turn left 90", "Lukas says that was the wrong side. Undo that."), "turn right 90 deg"),
        (("turn left 90 degrees", "Noah wants it the other way round now"), "turn right 90 deg"),
        (("妞妞想看你转圈圈，原地往左转三圈吧",), "turn left 1080 deg"),
        (("孩子们觉得你应该往前走1米",), "drive 1 m"),
        (("小李想让你右转90度",), "turn right 90 deg"),
        (("爷爷问你能不能左转45度",), "turn left 45 deg"),
        (("Oma möchte, dass du dich 90 Grad nach rechts drehst",), "turn right 90 deg"),
        (("Ben will sehen, wie du eine Acht fährst, jeder Kringel mit 50 cm Radius",),
         "arc left 360 deg radius 0.5 m; arc right 360 deg radius 0.5 m"),
        (("los, zweimal um dich selbst nach links, die Emma will das sehen",), "turn left 720 deg"),
        (("der Chef bittet dich, einen Meter zurückzufahren",), "drive 1 m back"),
        (("Und der Tim wünscht sich eine Vierteldrehung nach rechts",), "turn right 90 deg"),
        (("fahr einen Kreis mit 1 m Radius", "Lina fragt, ob du das kleiner kannst. Nochmal mit halbem Radius"),
         "arc left 360 deg radius 0.5 m"),
    ],
)  # fmt: skip
def test_a_whole_wish_is_done(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


@pytest.mark.parametrize(
    "turns",
    [
        ("drive 1 m", "Ben says again"),
        ("Tom wants you to go back",),
        ("前进一米", "妞妞说还要"),
        ("fahr einen Meter vor", "Ben sagt nochmal"),
    ],
)
def test_what_is_not_whole_or_only_said_is_proposed(turns: tuple[str, ...]) -> None:
    meant = conversation(*turns[:-1]).say(turns[-1])
    assert meant.plan is None
    assert meant.proposal is not None


@pytest.mark.parametrize(
    "said",
    [
        "Emma wants to see you dance",
        "Emma wanted to see you dance yesterday",
        "Emma wants to go forward 1 m",
        "Anna wants you to go forward 1 m, don't do it",
        "my sister always wants you to turn left 90 degrees",
        "Tom wants the dog to go back 2 m",
        "the manual says turn left 90 degrees",
        "Ben says robots turn left 90 degrees all the time",
        "who wants you to turn right 90 degrees?",
        "meine Schwester will immer, dass du dich 90 Grad nach links drehst",
        "Emma will nicht, dass du 1 m zurückfährst",
        "妞妞想往前走1米",
        "小红想让你往前走1米，你别走",
        "小李想让狗后退2米",
        "他想自己左转90度",
    ],
)
def test_what_is_told_of_others_moves_nothing(said: str) -> None:
    assert conversation().say(said).plan is None
