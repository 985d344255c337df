"""Orders as strangers gave them are done as they are said: corrected, in their order, each time, once."""

from __future__ import annotations

import pytest

from tests.language.test_usual import done


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("前进两米。", "前进两米，搞定。", "左转。"), "turn left 90 deg"),
        (("drive a metre and 20 then turn left one eighth of a circle",), "drive 1.2 m; turn left 45 deg"),
        (
            ("forward 1 m then repeat the following twice turn left forward 50 cm end then back 1 m",),
            "drive 1 m; turn left 90 deg; drive 0.5 m; turn left 90 deg; drive 0.5 m; drive 1 m back",
        ),
        (
            ("forward 50 cm, then three times turn left 90 and go 30 cm, then back 1 m",),
            "drive 0.5 m; turn left 90 deg; drive 0.3 m; turn left 90 deg; "
            "drive 0.3 m; turn left 90 deg; drive 0.3 m; drive 1 m back",
        ),
        (("go 2 m ahead and come straight back",), "drive 2 m; drive 2 m back"),
        (
            ("go there and back, two metres, three times",),
            "drive 2 m; drive 2 m back; drive 2 m; drive 2 m back; drive 2 m; drive 2 m back",
        ),
        (
            ("hop half a meter right and back again, do that thrice",),
            "drive 0.5 m right; drive 0.5 m left; drive 0.5 m right; "
            "drive 0.5 m left; drive 0.5 m right; drive 0.5 m left",
        ),
        (
            ("kindly do one thing, go straight 2 meter only, then take left and go 1 meter, then stop",),
            "drive 2 m; turn left 90 deg; drive 1 m",
        ),
        (
            ("repeat twice turn left then forward 50 cm",),
            "turn left 90 deg; drive 0.5 m; turn left 90 deg; drive 0.5 m",
        ),
        (
            ("take right, go 2 meter, again take right, go 1 meter",),
            "turn right 90 deg; drive 2 m; turn right 90 deg; drive 1 m",
        ),
        (
            ("zip over 2 m to the left as quick as you can, then dawdle back",),
            "drive 2 m left at 1 m/s; drive 2 m right at 0.15 m/s",
        ),
        (("中等速度往前走两米",), "drive 2 m"),
        (("你嘞往后头退一步嘛，莫退多咯，五十公分",), "drive 0.5 m back"),
        (("停两秒，前进一米，停两秒，就这样，两秒就行",), "wait 2 s; drive 1 m; wait 2 s"),
        (
            ("先停五秒再做三遍前进半米左转",),
            "wait 5 s; drive 0.5 m; turn left 90 deg; drive 0.5 m; turn left 90 deg; drive 0.5 m; turn left 90 deg",
        ),
        (
            ("先前进一米，再把后面这两个动作做三次：左转六十度，前进半米",),
            "drive 1 m; turn left 60 deg; drive 0.5 m; turn left 60 deg; drive 0.5 m; turn left 60 deg; drive 0.5 m",
        ),
        (("前进一米左移一米右转九十度", "回到左移之前"), "go to 1 0 facing 0 deg"),
        (("前进三米，每走一米停一秒",), "drive 1 m; wait 1 s; drive 1 m; wait 1 s; drive 1 m"),
        (("前进三米，每隔一米停一秒",), "drive 1 m; wait 1 s; drive 1 m; wait 1 s; drive 1 m"),
        (("前进两米", "走多了，一米五就够"), "drive 0.5 m back"),
        (("前进两米左转九十度前进一米", "回到拐弯的地方"), "go to 2 0 facing 0 deg"),
        (
            ("前进半米左转做三遍，退一米做一遍",),
            "drive 0.5 m; turn left 90 deg; drive 0.5 m; turn left 90 deg; "
            "drive 0.5 m; turn left 90 deg; drive 1 m back",
        ),
        (("前进两米，中途每一米停两秒，最后不用停",), "drive 1 m; wait 2 s; drive 1 m"),
        (
            ("前进四米，每一米停两秒",),
            "drive 1 m; wait 2 s; drive 1 m; wait 2 s; drive 1 m; wait 2 s; drive 1 m",
        ),
        (("您先倒个两步远也就是大概一米二，完了往左转",), "drive 1.2 m back; turn left 90 deg"),
        (
            ("向前走一米，往右走半米，再往后走一米，最后往左走半米，这样走两圈",),
            "drive 1 m; drive 0.5 m right; drive 1 m back; drive 0.5 m left; "
            "drive 1 m; drive 0.5 m right; drive 1 m back; drive 0.5 m left",
        ),
        (("左移三十公分，等下，右移，右移三十公分",), "drive 0.3 m right"),
        (("左转一百二十度", "转多了，九十度就可以了"), "turn right 30 deg"),
        (("帮忙往左，啊右，右边右边，横着挪一米",), "drive 1 m right"),
        (("往前两米，两米啊别走多了",), "drive 2 m"),
        (("往前走一米，一米一米，就一米",), "drive 1 m"),
        (("往前走二十厘米就可以，二十厘米",), "drive 0.2 m"),
        (("往右移半米", "太多了，二十公分就行"), "drive 0.3 m left"),
        (
            ("循环四遍前进一米右转",),
            "drive 1 m; turn right 90 deg; drive 1 m; turn right 90 deg; "
            "drive 1 m; turn right 90 deg; drive 1 m; turn right 90 deg",
        ),
        (("慢速前进两米", "太快了，中等速度退回来"), "drive 2 m back"),
        (("打个转转儿，转三圈",), "turn left 1080 deg"),
        (
            ("横移两米往左，每五十公分歇一秒",),
            "drive 0.5 m left; wait 1 s; drive 0.5 m left; wait 1 s; drive 0.5 m left; wait 1 s; drive 0.5 m left",
        ),
        (("等五秒，五秒啊，然后走半米",), "wait 5 s; drive 0.5 m"),
        (("话说回来，你先后退一米。",), "drive 1 m back"),
        (("走三十厘米，错了错了，三米，三米",), "drive 3 m"),
        (("转个圈，慢慢转，转两圈",), "turn left 720 deg at 0.3 rad/s"),
        (
            ("重复走三次前进半米再右转九十度然后等一秒",),
            "drive 0.5 m; turn right 90 deg; wait 1 s; drive 0.5 m; turn right 90 deg; "
            "wait 1 s; drive 0.5 m; turn right 90 deg; wait 1 s",
        ),
        (("one step is 40 cm", "take five steps forward"), "drive 2 m"),
        (("twirl clockwise",), "turn right 360 deg"),
        (("4 m forward, no, wait, 3 metres are enough",), "drive 3 m"),
        (("4 Meter vor, nee warte, 3 Meter reichen",), "drive 3 m"),
        (("4 m forward. Wait, no, 3 m.",), "drive 3 m"),
        (("drive one meter, then right turn, oh wait, left turn",), "drive 1 m; turn left 90 deg"),
        (
            ("first turn left, then go 2 m, oh no, first go 2 m then turn left",),
            "drive 2 m; turn left 90 deg",
        ),
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
        (("这个位置就是A点。往前走三米，那儿是B点。",), 'remember "a点"; drive 3 m; remember "b点"'),
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
        (("go left 2 m", "stay on this course for another 1 m"), "drive 1 m left"),
        (("forward 2 m", "turn around", "continue in this direction for 1 m"), "drive 1 m"),
        (
            ("forward 1 m, wait 3 seconds, left 1 m", "now all that with no waiting"),
            "drive 1 m; drive 1 m left",
        ),
        (("前进三米每隔一米停三秒",), "drive 1 m; wait 3 s; drive 1 m; wait 3 s; drive 1 m"),
        (("Drive 1 m.", "one more metre"), "drive 1 m"),
        (("Drive 1 m.", "another metre please"), "drive 1 m"),
        (("退一米，我往前站一米",), "drive 1 m back"),
        (("我绕着你转一圈，你等着",), "wait 1 s"),
        (("往左移一米，我再往右走一米",), "drive 1 m left"),
        (("往前走，不是往后，一米二",), "drive 1.2 m"),
        (("朝左前方不是右前方走一米",), "drive 1 m toward 45 deg"),
        (("顺时针不是逆时针转半圈",), "turn right 180 deg"),
        (
            ("正方形，不是三角形，边长半米",),
            "drive 0.5 m; turn left 90 deg; drive 0.5 m; turn left 90 deg; "
            "drive 0.5 m; turn left 90 deg; drive 0.5 m; turn left 90 deg",
        ),
        (("转左边，别转右边，六十度",), "turn left 60 deg"),
        (("右移三十公分，三十公分吧，谢谢",), "drive 0.3 m right"),
        (("转两圈，对，两圈",), "turn left 720 deg"),
        (("上一组走了五米，你走三米。",), "drive 3 m"),
        (("快下班了，最后一次，后退半米。",), "drive 0.5 m back"),
        (("forward 2 m, before turning right wait 3 seconds",), "drive 2 m; wait 3 s; turn right 90 deg"),
        (("go right 2 m, back to the left half of that",), "drive 2 m right; drive 1 m left"),
        (
            ("u go 1 meter to front and after make 90 degree to left and after 1 meter more",),
            "drive 1 m; turn left 90 deg; drive 1 m",
        ),
        (("strafe right 0.75m (+/- 5 mm is fine)",), "drive 0.75 m right"),
        (("back up 2 metres, no scrap that, 1 metre",), "drive 1 m back"),
        (("2 m ahead at 0.2 m/s, no, too slow, make it 0.4",), "drive 2 m at 0.4 m/s"),
        (("zwo Meter zurück, nein Moment, drei Meter zurück, ich hab mich vertan",), "drive 3 m back"),
        (("fahr einsfuffzig vor",), "drive 1.5 m"),
        (("elfhundert Millimeter vor",), "drive 1.1 m"),
        (("advance two decimal five metres",), "drive 2.5 m"),
        (("slide left 2 metres, then slide back to your mark",), "drive 2 m left; drive 2 m right"),
        (("回原点，车头还朝最开始那个方向",), "go to 0 0 facing 0 deg"),
        (("沿轴线往前走3米",), "drive 3 m"),
        (("2 m ahead, then ten seconds standing",), "drive 2 m; wait 10 s"),
        (("forward 2 s, then 3 s",), "drive 2 s; drive 3 s"),
        (("先到(1,0)，停两秒，再到(1,2)",), 'go to 1 0 named "(1, 0)"; wait 2 s; go to 1 2 named "(1, 2)"'),
        (("for i in range(2): 50cm vor, 2s warten",), "drive 0.5 m; wait 2 s; drive 0.5 m; wait 2 s"),
        (("全程15cm/s，前进60cm，再左移60cm",), "drive 0.6 m at 0.15 m/s; drive 0.6 m left at 0.15 m/s"),
        (("1m50 back",), "drive 1.5 m back"),
        (
            ("turn right 30 degrees and turn back to the left by the same angle",),
            "turn right 30 deg; turn left 30 deg",
        ),
        (("forward 1 m, then turn left and before that wait 3 s",), "drive 1 m; wait 3 s; turn left 90 deg"),
        (
            ("drive 5 s at 0.1 m/s, then back at twice the speed",),
            "drive 5 s at 0.1 m/s; drive 0.5 m back at 0.2 m/s",
        ),
        (("先往前两米再转回来再走两米",), "drive 2 m; turn left 180 deg; drive 2 m"),
        (("往前走一公尺喔",), "drive 1 m"),
        (("前进一米再左转,左转之前等两秒",), "drive 1 m; wait 2 s; turn left 90 deg"),
        (("先左转九十度再前进一米,不过左转之前先倒退半米",), "drive 0.5 m back; turn left 90 deg; drive 1 m"),
        (("直行四米,中途在两米处停三秒",), "drive 2 m; wait 3 s; drive 2 m"),
        (("drive 2 m, come back two thirds of the way",), "drive 2 m; drive 1.3333333334 m back"),
        (
            ("Give me an L: long arm 2 m, short arm 1 m, turning right",),
            "drive 2 m; turn right 90 deg; drive 1 m",
        ),
        (("drive 2 m", "now the half of this, but backwards"), "drive 1 m back"),
        (("drive 1.2 m", "that was 20 cm too much, take it back"), "drive 0.2 m back"),
        (("slide left 1 m", "undo 20 cm"), "drive 0.2 m right"),
        (("turn left 90", "ok undo 10 degrees of that"), "turn right 10 deg"),
        (("drive 1.2 m", "1 m would have been enough"), "drive 0.2 m back"),
        (("前进120公分", "应该前进1米，把多走的退回来"), "drive 0.2 m back"),
        (("drive 1 m, right 90", "same with left in place of right"), "drive 1 m; turn left 90 deg"),
        (("arc left 60 degrees, 1 m radius", "now drive it backwards"), "arc back left 60 deg radius 1 m"),
        (("drive for 2 s", "another 3 s"), "drive 3 s"),
        (("往前走两米", "再走一半那么远"), "drive 1 m"),
        (
            ("fahr 1.5 m vor", "jetzt rückwärts die strecke wieder zurück, halb so schnell"),
            "drive 1.5 m back at 0.15 m/s",
        ),
        (
            ("merk dir die stelle hier mal als ladeplatz", "fahr 1 m vor", "und wieder zum ladeplatz"),
            'go to 0 0 named "ladeplatz"',
        ),
        (
            ("This spot here's the dock, yeah? Remember it.", "forward 1 m", "back to the dock"),
            'go to 0 0 named "dock"',
        ),
        (
            (
                "remember this place as desk",
                "1 m ahead",
                "remember this place as mat",
                "1 m ahead",
                "go to the mat, no sorry, to the desk",
            ),
            'go to 0 0 named "desk"',
        ),
        (
            ("Three things. Forward a metre, slide right half a metre, forward another metre.",),
            "drive 1 m; drive 0.5 m right; drive 1 m",
        ),
        (("Right, that's done. go back 1 m",), "drive 1 m back"),
        (("go back 1 m", "now drive 2 m that way"), "drive 2 m back"),
        (("a car is coming at you, go back 1 m",), "drive 1 m back"),
        (("nobody move. robot, forward 1 m",), "drive 1 m"),
        (("drive 2 m", "shave 20 cm off"), "drive 0.2 m back"),
        (("turn right 60", "back to straight"), "face 0 deg"),
        (("Turn right 45 degrees.", "Hm. Bit over. Take 10 off."), "turn left 10 deg"),
        (("turn right 90", "now drive 2 yards that way"), "drive 1.8288 m"),
        (
            ("Make us a triangle with 1 meter sides, I don't care which way around you go.",),
            "drive 1 m; turn left 120 deg; drive 1 m; turn left 120 deg; drive 1 m; turn left 120 deg",
        ),
        (
            ("go forward 1 m and turn right", "Do that whole thing, the metre and the turn, once more"),
            "drive 1 m; turn right 90 deg",
        ),
        (
            ("circle to the left radius 1 m", "Now mirror it, the same size circle but to your right"),
            "arc right 360 deg radius 1 m",
        ),
        (("go to the point x equals 2, y equals minus 1, in meters",), 'go to 2 -1 named "(2, -1)"'),
        (("fahr zu x gleich 2 und y gleich 1,5",), 'go to 2 1.5 named "(2, 1.5)"'),
        (("去X等于2 Y等于负1那个点",), 'go to 2 -1 named "(2, -1)"'),
        (
            ("go to x 3 y 1 and finish up looking at 90 degrees",),
            'go to 3 1 facing 90 deg named "(3, 1, 90)"',
        ),
        (("drive up another 5 feet so Dolores can see you",), "drive 1.524 m"),
        (("Go diagonally front right, 1.4 m. Don't turn, just slide it.",), "drive 1.4 m toward -45 deg"),
        (
            ("turn right, no wait, I mean left: so turn 90 left and then 1.5 m ahead",),
            "turn left 90 deg; drive 1.5 m",
        ),
        (
            (
                "zigzag, 1 m diagonally forward left and then 1 m diagonally forward right, all of it twice, no turn",
            ),
            "drive 1 m toward 45 deg; drive 1 m toward -45 deg; drive 1 m toward 45 deg; drive 1 m toward -45 deg",
        ),
        (
            ("先往左前方走一米再往右前方走一米这样搞两遍",),
            "drive 1 m toward 45 deg; drive 1 m toward -45 deg; drive 1 m toward 45 deg; drive 1 m toward -45 deg",
        ),
        (("车头莫动往右边横移八十公分",), "drive 0.8 m right"),
        (("园地右转四十五度在往前走1米2",), "turn right 45 deg; drive 1.2 m"),
        (("往前走两米", "算了回到你最开始出发那个地方去"), "go to 0 0"),
        (("So, erstma anderthalb Meter geradeaus.", "Und dat Ganze nomma."), "drive 1.5 m"),
        (("Auffer Stelle 135 Grad nach rechts drehn.",), "turn right 135 deg"),
    ],
)
def test_the_last_turn_is_done(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan
