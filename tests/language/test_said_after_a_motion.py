"""What strangers said that moved the robot and was no order, or moved it otherwise than said."""

from __future__ import annotations

import pytest

from tests.language.test_usual import done

ONLY_TOLD = [
    # praise and comment on the motion just made
    ("go forward 1 m", "one meter forward, that's not much"),
    ("go back 50 cm", "50 cm back, perfect"),
    ("turn left 90 degrees", "half a turn, cool!"),
    ("turn right 90 degrees", "and 90 degrees it is"),
    ("turn left and go 1 m", "left and 1 m, good"),
    ("drive 1 meter to the left", "a meter to the left, a meter to the right, who cares"),
    ("drive forward 3 m", "home, sweet home"),
    ("go forward 2 m", "and 1 m back, would that be faster?"),
    ("two meters back, that's where I left my keys",),
    ("remember this spot as base", "drive forward 1 m and turn right", "base is where you started, right?"),
    # what somebody else does
    ("let me go left first, then you go right 1 m",),
    ("let me back up a meter first, you're in my way",),
    ("you stay, I go two meters back",),
    ("go forward 2 m, I'll go back 2 m",),
    ("my friend will turn right, you turn left 30 degrees",),
    ("all of you except the robot, back two meters",),
    ("guys, move two meters back please, and you, robot, go forward 60 cm",),
    ("我让你往前走了吗？",),
    ("往前走两米这种事情太简单了",),
    ("转一圈给我三块钱我都不干",),
    ("向后退的那个小朋友，请你小心点",),
    ("体育课上老师喊：向后转！全班转错了方向，笑死我了。",),
    ("往前走！不要停！这是我爸的口头禅。",),
    ("前进两米？我才不信你做得到",),
    ("左转九十度？开什么玩笑",),
    ("转个圈圈，转个圈圈，这首儿歌你听过没",),
    ("能走两米不代表能走二十米",),
    ("if I say forward, will you go forward?",),
    # what names one of several, and does not say which
    ("drive 2 m in 8 seconds", "the same distance in 4 seconds"),
    ("走两米用时八秒", "同样的路用四秒走完"),
    ("twirl clockwise", "the other way now please", "I liked the first one better, do it again"),
    ("drive two metres and then turn right", "the other way"),
    ("move right 60 cm", "back up just as far"),
    ("3 m back", "the right side"),
    ("one metre back", "instead of back, go left"),
    ("forward 1 m and right 1 m", "now the right first and then the forward"),
    ("那条路线走一下",),
    ("走一个半径一米五的半圆，往右拐，然后直走到和出发点一样的横坐标",),
    ("drive 1 meter forward and turn right, do that twice, but the second time turn left instead",),
    ("drive 2 m forward, turn right, and another 2 m, no, drop the last one",),
    ("1 m forward and 1 m right at the same time",),
    ("drive 1.2 m straight", "and then keep doing that until you've covered 6 m"),
    ("here is the charger", "drive 2 m to the right, then turn left", "to the charger, but sideways"),
    ("a circle, 6 m circumference, clockwise, then the same lap backwards",),
    ("drive forward 2 m and stop half way for a moment", "same in reverse"),
    ("do a half turn", "and a tiny bit of the same"),
    ("4 m ahead, wait, 3 m",),
    ("前后左右各走半米，每次都回到中间",),
    ("can you go forward as many metres as she's got apples left?",),
    ("go slower please",),
    ("forward 2 m, turn left, then the same backwards",),
    ("a square of 1 m, but sideways without turning: forward, right, back, left",),
    ("drive 1 m, turn right, another metre, right again, and so on",),
    (
        "ein Meter vor, dann rechts rum, dann noch 50 Zentimeter",
        "den zweiten Schritt bitte rückgängig machen",
    ),
    ("Ein Dreieck rechtsrum, Umfang drei Meter, danach noch ein Kreis linksrum mit gleichem Umfang.",),
    ("zwei Meter vor", "Jetzt darfst du wieder Gas geben."),
    ("zwei Meter vor", "Okay, wieder volles Tempo."),
    ("forward 1 m, then slide back to the start",),
]


@pytest.mark.parametrize("turns", ONLY_TOLD, ids=lambda turns: turns[-1])
def test_it_is_asked_about_or_answered_and_moves_nothing(turns: tuple[str, ...]) -> None:
    assert done(*turns) in ("unclear", "answered")


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("one step is 40 cm", "take five steps forward"), "drive 2 m"),
        (("twirl clockwise",), "turn right 360 deg"),
        (("4 m forward, no, wait, 3 metres are enough",), "drive 3 m"),
        (("4 Meter vor, nee warte, 3 Meter reichen",), "drive 3 m"),
        (("4 m forward. Wait, no, 3 m.",), "drive 3 m"),
        (("drive one meter, then right turn, oh wait, left turn",), "drive 1 m; turn left 90 deg"),
        (("first turn left, then go 2 m, oh no, first go 2 m then turn left",), "drive 2 m; turn left 90 deg"),
        (("先左转再走两米，哎呀不是，先走两米再左转",), "drive 2 m; turn left 90 deg"),
        (("go two metres left. No wait, right. So two metres to the right.",), "drive 2 m right"),
        (("往前走三米。三米太远了，两米。",), "drive 2 m"),
        (("后退一米，要不两米吧",), "drive 2 m back"),
        (("前进一米之后左转之前停三秒",), "drive 1 m; wait 3 s; turn left 90 deg"),
        (("前进两米但是先等三秒",), "wait 3 s; drive 2 m"),
        (("turn left, and before that wait 2 s",), "wait 2 s; turn left 90 deg"),
        (("左移右移各一米，来两趟",), "drive 1 m left; drive 1 m right; drive 1 m left; drive 1 m right"),
        (
            ("twice: turn left, go 1 m, finally turn around",),
            "turn left 90 deg; drive 1 m; turn left 90 deg; drive 1 m; turn left 180 deg",
        ),
        (
            ("两次：左转九十度走一米，最后掉头",),
            "turn left 90 deg; drive 1 m; turn left 90 deg; drive 1 m; turn left 180 deg",
        ),
        (("go out and back twice, 2 m each way",), "drive 2 m; drive 2 m back; drive 2 m; drive 2 m back"),
        (("forward 1 m", "reverse straight back to the start"), "drive 1 m back"),
        (("left 1 m", "again", "slide straight back to where you started"), "drive 2 m right"),
        (("往左横移1米", "再来一趟", "横着回到最开始的位置"), "drive 2 m right"),
        (("forward 2 m, then reverse to the start",), "drive 2 m; drive 2 m back"),
        (("forward for 3 seconds, then reverse straight back to the start",), "drive 3 s; drive 3 s back"),
        (("往后倒5秒,速度零点二米每秒,我听听后头有没有异响",), "drive 5 s back at 0.2 m/s"),
        (("kannst du mal bitte vx=0.2, vy=0.1, wz=0 für 4 sekunden fahren",), "twist 0.2 0.1 0 for 4 s"),
        (("我说“转圈圈”，意思就是原地转两圈", "转圈圈"), "turn left 720 deg"),
        (
            ("这个位置就是A点。往前走三米，那儿是B点。",),
            'remember "a点"; drive 3 m; remember "b点"',
        ),
        (("go 2 m forward, this is point B", "back 1 m", "go to B"), 'go to 2 0 named "b"'),
        (
            ("call this spot A", "right 1 m", "call this spot B", "from A to B twice"),
            'go to 0 0 named "a"; go to 0 -1 named "b"; go to 0 0 named "a"; go to 0 -1 named "b"',
        ),
        (("perfect, 50 cm back",), "drive 0.5 m back"),
        (("Fahr drei Meter vor, halt, nein, zwei",), "drive 2 m"),
        (("drei Meter rückwärts, aber sachte", "und jetzt mit Karacho wieder vor"), "drive 3 m at 1 m/s"),
        (("good, now forward 2 m",), "drive 2 m"),
        (("forward 90 cm, that's 0.9 m",), "drive 0.9 m"),
    ],
    ids=lambda value: value[-1] if isinstance(value, tuple) else "",
)  # fmt: skip
def test_it_is_done_as_it_is_said(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan
