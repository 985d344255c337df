"""Chinese that is a letter or a word away from an order: what is denied, put off, told or of no size moves nothing."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation
from tests.language.test_usual import done

STILL = [
    ("不对，别左转",),
    ("左转", "不，不是右转"),
    ("前进一米", "停，不是左转"),
    ("九点钟出发",),
    ("稍后左转",),
    ("先来后到",),
    ("后方来车",),
    ("身后",),
    ("让车先走",),
    ("让我后退一米",),
    ("左转太多了",),
    ("又走一米",),
    ("前进中",),
    ("走不过去",),
    ("动不动就左转",),
    ("我要走一米",),
    ("忘掉左转",),
    ("去A",),
    ("前进一米", "左转", "上上个再来一次"),
    ("左转右转都行",),
    ("前进个头",),
    ("退到1,1",),
    ("一米宽的路",),
    ("百米",),
    ("往前拖三十秒",),
    ("一周后左转",),
    ("前进两个方格",),
    ("两秒之前左转",),
    ("三角函数",),
    ("左下角",),
    ("靠左行驶",),
    ("走来走去",),
    ("把圆画大",),
    ("跳一米",),
    ("走过来",),
    ("又转",),
    ("左后方来车",),
    ("能左转就左转",),
    ("沿左边走",),
    ("走到我这里",),
]
DONE = [
    (("向三点钟方向走",), "drive 0.5 m right"),
    (("先后左转右转",), "turn left 90 deg; turn right 90 deg"),
    (("先后退，再前进",), "drive 0.5 m back; drive 0.5 m"),
    (("最后左转，先前进一米",), "drive 1 m; turn left 90 deg"),
    (("左边来车，往右让",), "drive 0.5 m right"),
    (("左转改成右转",), "turn right 90 deg"),
    (("前进和左转各两次",), "drive 0.5 m; drive 0.5 m; turn left 90 deg; turn left 90 deg"),
    (("记住这里叫A", "前进一米", "去A"), 'go to 0 0 named "a"'),
    (("左转四十度", "再来一半"), "turn left 20 deg"),
    (("前进一米", "后退两米", "第一个再来一次"), "drive 1 m"),
    (("后退一米", "继续一米"), "drive 1 m back"),
    (("后退一米", "继续走"), "drive 0.5 m back"),
    (("前进一点再一点",), "drive 0.25 m; drive 0.25 m"),
    (("前进一米", "我说两米"), "drive 1 m"),
    (("前进一米，左转，前进两米", "再走同样远"), "drive 2 m"),
    (("往前走一个半米",), "drive 1.5 m"),
    (("停一下再走",), "wait 1 s; drive 0.5 m"),
    (("左转后，前进前，等两秒",), "turn left 90 deg; wait 2 s; drive 0.5 m"),
]


@pytest.mark.parametrize("turns", STILL, ids=lambda turns: turns[-1])
def test_it_moves_nothing(turns: tuple[str, ...]) -> None:
    assert conversation(*turns[:-1]).say(turns[-1]).plan is None


@pytest.mark.parametrize(("turns", "plan"), DONE, ids=lambda said: said[-1])
def test_it_is_done_as_said(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan
