"""A plan that waits for a `go` is changed, asked about or taken back by what is said before, and never by a guess."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation

PLAN = "forward 1 m, turn left 90, back 50 cm. Don't do it yet."


def waits(*turns: str) -> str:
    """The plan that waits after these turns, in one line; an empty string where none does."""
    held = conversation(*turns).dialogue.held
    return format_plan(held).replace("\n", "; ").strip("; ") if held is not None else ""


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("change step two to right", "drive 1 m; turn right 90 deg; drive 0.5 m back"),
        ("the first step should be 80 cm", "drive 0.8 m; turn left 90 deg; drive 0.5 m back"),
        ("make the turn 60 instead", "drive 1 m; turn left 60 deg; drive 0.5 m back"),
        ("both drives 30 cm please", "drive 0.3 m; turn left 90 deg; drive 0.3 m back"),
        ("drop the turn", "drive 1 m; drive 0.5 m back"),
        ("only the first step", "drive 1 m"),
        ("and then turn right 30", "drive 1 m; turn left 90 deg; drive 0.5 m back; turn right 30 deg"),
        ("mirror it", "drive 1 m; turn right 90 deg; drive 0.5 m back"),
        ("no, drive 2 m instead", "drive 2 m"),
        ("what is step two?", "drive 1 m; turn left 90 deg; drive 0.5 m back"),
        ("thank you", "drive 1 m; turn left 90 deg; drive 0.5 m back"),
        ("actually, skip it", ""),
        ("2 m", ""),
        ("change step nine to left", ""),
        ("it is rather zorblax 2 m forward", ""),
    ],
)
def test_what_is_said_of_a_plan_that_waits_changes_it_or_ends_it(said: str, left: str) -> None:
    talk = conversation(PLAN)
    assert talk.say(said).plan is None
    assert waits(PLAN, said) == left


@pytest.mark.parametrize(
    ("order", "said", "left"),
    [
        ("Drive five metres forward when I tell you to.", "Actually three's plenty.", "drive 3 m"),
        ("Drive one metre back on my signal.", "Wait, forward, not back.", "drive 1 m"),
        ("get ready to turn left 90", "no wait, 50", "turn left 50 deg"),
        ("back 60 cm, but not yet", "slowly", "drive 0.6 m back at 0.15 m/s"),
    ],
)
def test_an_amount_or_a_side_alone_is_that_of_the_motion_that_waits(order: str, said: str, left: str) -> None:
    assert waits(order, said) == left


@pytest.mark.parametrize("said", ["read me the plan", "what will you do?", "what's the plan again"])
def test_the_plan_that_waits_is_told(said: str) -> None:
    told = conversation(PLAN).say(said)
    assert told.outcome == "answered"
    assert "turn left 90°" in told.reply


def test_a_new_order_is_done_and_nothing_waits_any_more() -> None:
    talk = conversation(PLAN)
    assert talk.say("turn left 30").plan is not None
    assert talk.dialogue.held is None


PLAN_ZH = "前进一米，左转九十度，后退半米，先别动"


@pytest.mark.parametrize(
    ("order", "said", "left"),
    [
        (PLAN_ZH, "第二步改往右转", "drive 1 m; turn right 90 deg; drive 0.5 m back"),
        (PLAN_ZH, "转弯改六十度", "drive 1 m; turn left 60 deg; drive 0.5 m back"),
        (PLAN_ZH, "最后一步不要了", "drive 1 m; turn left 90 deg"),
        (PLAN_ZH, "最后再前进一米", "drive 1 m; turn left 90 deg; drive 0.5 m back; drive 1 m"),
        (PLAN_ZH, "请问第二步是什么", "drive 1 m; turn left 90 deg; drive 0.5 m back"),
        (PLAN_ZH, "只要往前就好", ""),
        ("等我口令前进三米左转九十度", "三米改两米", "drive 2 m; turn left 90 deg"),
        (
            "等一下我说走你才走喔。先右转九十度，再往前六十公分",
            "转弯改成往左",
            "turn left 90 deg; drive 0.6 m",
        ),
        ("我喊开始你再跑哦，往前跑两米", "不跑了", ""),
    ],
)
def test_a_plan_that_waits_is_changed_in_chinese(order: str, said: str, left: str) -> None:
    talk = conversation(order)
    assert talk.dialogue.held is not None
    assert talk.say(said).plan is None
    assert waits(order, said) == left
