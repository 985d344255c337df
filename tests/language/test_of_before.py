"""What is told by what was done before is that much of it, or that heading; what leaves it open moves nothing."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation
from tests.language.test_usual import done

_THERE_AND_BACK = "drive 1 m; drive 1 m back"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        ("go 80 cm forward / 20 more / bit close to the racking that. back up half of what you've done in total",
         "drive 0.5 m back"),
        ("turn right 60 degrees / hm that was too much, come back round by half of it", "turn left 30 deg"),
        ("go forward 60 cm / back 20 cm / now forward twice as far as both of those put together", "drive 1.6 m"),
        ("forward 35 cm / and 15 / back all of that in one go", "drive 0.5 m back"),
        ("go forward 2 m / go forward 1 m / back up the total of those two", "drive 3 m back"),
        ("back up 40 cm / just as far again, but forwards", "drive 0.4 m"),
        ("turn left 90 / now right by 10 degrees less than that", "turn right 80 deg"),
        ("drive 1 m / no no is not enough, it must be 2 meter in total", "drive 1 m"),
        ("turn left 40 degrees / i wanted 90 in total, so complete what is missing", "turn left 50 deg"),
        ("forward 1 m / another 25 cm / sorry, those last 25 were too many, roll them back", "drive 0.25 m back"),
        ("drive 1 m / plus 30 cm / take that last bit back", "drive 0.3 m back"),
        ("drive 1 m / back 1 m / that whole there-and-back once more", _THERE_AND_BACK),
        ("forward 50 cm / turn left 30 degrees / both of them once more", "drive 0.5 m; turn left 30 deg"),
        ("turn left 40 degrees / Sorry, I meant right. Forty to the right of where you were looking before.",
         "turn right 80 deg"),
        ("turn left 90 / no sorry my bad, meant a quarter turn right from how you were before", "turn right 180 deg"),
        ("turn left 20 / turn left 30 / Now back on the heading you had before any of that", "face 0 deg"),
        ("go back 80 cm / you should be 80 cm in front of the start, not behind it. go there please", "drive 1.6 m"),
        ("turn right 90 / fwd 1m / ok go back to where you started", "go to 0 0"),
        ("Einen Meter vor. / Noch achtzig Zentimeter. / von der ganzen Strecke zusammen jetzt die Hälfte wieder zurück",
         "drive 0.9 m back"),
        ("fahr 80 cm vor / noch 20 / und die letzten 20 wieder zurück", "drive 0.2 m back"),
        ("Rück mal 90 cm vor / Nochmal, nur diesmal rückwärts und 10 cm kürzer", "drive 0.8 m back"),
        ("fahr dreimal 40 cm vor / nochmal so, aber nur zweimal und seitwärts nach links",
         "drive 0.4 m left; drive 0.4 m left"),
        ("fahr dreimal 40 cm vor, dazwischen jeweils 2 s Pause / nochmal so, aber nur zweimal und seitwärts nach links",
         "drive 0.4 m left; wait 2 s; drive 0.4 m left"),
        ("1 m vor / 1 m zurück / das ganze hin und her noch mal", _THERE_AND_BACK),
        ("fahr einen Kreis mit 50 cm Radius / nochmal einen, aber mit 10 cm mehr Radius als eben",
         "arc left 360 deg radius 0.6 m"),
        ("Dreh dich 45 Grad nach rechts / Nee, andersrum hab ich gemeint! "
         "Am Ende sollst du 45 Grad links von deiner Anfangsrichtung gucken", "turn left 90 deg"),
        ("links 90 grad / links 180 grad / "
         "Nun auf dem kürzesten Weg wieder in die Richtung drehen, in die du ganz am Anfang geschaut hast",
         "face 0 deg"),
        ("Fahr 80 cm zurück / Du solltest 80 cm vor dem Startpunkt stehen, nicht dahinter. Fahr bitte da hin",
         "drive 1.6 m"),
        ("前进1米 / 再来20公分 / 现在倒着退，退这两段加起来的一半", "drive 0.6 m back"),
        ("前进80厘米 / 再前进20厘米 / 最后这20公分退掉", "drive 0.2 m back"),
        ("左转60度 / 再转15度 / 走完了，把刚才转的那60度转回来", "turn right 60 deg"),
        ("往前走半米 / 往右平移，要比刚才多走半米", "drive 1 m right"),
        ("绕一个半径50公分的圈 / 再绕一个，半径比刚才大10公分", "arc left 360 deg radius 0.6 m"),
        ("左转40度 / 说错了，应该是从你最开始那个朝向算,往右90度", "turn right 130 deg"),
        ("前进1米，停3秒，再前进1米 / 整套再来一遍", "drive 1 m; wait 3 s; drive 1 m"),
    ],
)  # fmt: skip
def test_an_order_told_by_what_was_done_before_is_that_much_of_it(turns: str, plan: str) -> None:
    assert done(*turns.split(" / ")) == plan


@pytest.mark.parametrize(
    "turns",
    [
        "forward 1 m / that's half of what you've done in total",
        "forward 1 m / you went back half of what you had done",
        "forward 1 m / if there is room, back up half of what you've done in total",
        "forward 1 m / half of all that dust is yours",
        "forward 1 m / turn left 30 / forward 2 m / the total back again",
        "forward 1 m / turn left 90 / turn back by the sum of both",
        "forward 1 m / left 50 cm / twice as far as both of those put together",
        "forward 1 m / I wanted 90 in total",
        "forward 1 m / the last 3 m back again",
        "forward 1 m / undo that / half of all that back",
        "back 50 cm / back up half of that in total",
        "turn left 30 / my mate says you should be 45 degrees left of where you started",
        "dreh dich 30 grad links / mein Kollege sagt du sollst 45 Grad links von deiner Anfangsrichtung gucken",
        "fahr 1 m vor / beides noch einmal wäre zu viel",
        "fahr 1 m vor / die letzten 3 Meter wieder zurück",
        "forward 1 m / you went back twice as far as that",
        "前进1米 / 这是总路程的一半",
        "前进1米 / 再来20公分 / 你退了总路程的一半",
        "前进1米 / 最后那20公分有点晃",
        "前进1米 / 这样一共两米",
        "前进1米 / 如果有地方，退回总路程的一半",
        "左转40度 / 把刚才转的那60度转回来",
    ],
)
def test_what_only_tells_of_it_or_leaves_it_open_moves_nothing(turns: str) -> None:
    *before, last = turns.split(" / ")
    assert conversation(*before).say(last).plan is None
