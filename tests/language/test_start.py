"""A bare `go` starts what was said before: where that was not done, nothing is driven."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation

STARTS = (
    "go",
    "Go!",
    "drive",
    "let's go",
    "okay, go",
    "go slowly",
    "get going",
    "start moving",
    "run",
    "start",
)
STARTS_ZH = ("走", "走吧", "开始", "快走", "开动", "好，走", "行动", "开车", "冲", "出发")


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("before", ["blarg the fnord", "fly to the moon", "turn"])
def test_a_start_after_a_turn_that_was_not_done_drives_nothing(before: str, start: str) -> None:
    assert conversation(before).say(start).outcome == "unclear"


@pytest.mark.parametrize("start", STARTS_ZH)
@pytest.mark.parametrize("before", ["呱唧呱唧三下", "飞起来", "转"])
def test_a_start_in_chinese_after_a_turn_that_was_not_done_drives_nothing(before: str, start: str) -> None:
    assert conversation(before).say(start).outcome == "unclear"


def test_praise_after_a_turn_that_was_not_done_starts_nothing_and_names_nothing() -> None:
    meant = conversation("blarg the fnord").say("nice moves")
    assert meant.outcome == "unclear"
    assert "blarg" not in meant.reply


def test_the_question_names_what_was_not_done() -> None:
    assert "blarg the fnord" in conversation("blarg the fnord").say("go").reply
    assert "呱唧呱唧三下" in conversation("呱唧呱唧三下").say("走").reply
    assert "blarg the fnord" in conversation("blarg the fnord", "what is your battery level?").say("go").reply


@pytest.mark.parametrize(
    "turns",
    [
        ("go",),
        ("forward 1 m", "go"),
        ("走",),
        ("前进一米", "走"),
        ("blarg the fnord", "forward 1 m", "go"),
        ("blarg the fnord", "go forward"),
        ("呱唧呱唧三下", "往前走"),
    ],
)
def test_a_start_after_a_turn_that_was_done_or_with_a_direction_drives(turns: tuple[str, ...]) -> None:
    assert conversation(*turns[:-1]).say(turns[-1]).outcome == "plan"
