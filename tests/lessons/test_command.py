"""`chatrobot lesson` as a teacher and as a script use it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.running import Command, chatrobot

__all__ = ["chatrobot"]

SHEET = """\
title: {en: One metre, zh: 一米}
world: empty
tasks:
  - title: {en: There, zh: 去}
    task: {en: One metre ahead, zh: 前进一米}
    check: {ends_at: {x_m: 1, y_m: 0, within_m: 0.1}, path_m: {at_most: 1.2}}
    solution: {en: forward 1 m, zh: 前进一米}
  - title: {en: And turn, zh: 再转}
    task: {en: Look to the left, zh: 看左边}
    hint: {en: turn left, zh: 左转}
    check: {heading_deg: 90}
    solution: {en: turn left, zh: 左转}
    mistake: {en: turn left 95 degrees, zh: 右转}
"""


@pytest.fixture
def sheet(tmp_path: Path) -> str:
    path = tmp_path / "one-metre.yaml"
    path.write_text(SHEET, encoding="utf-8")
    return str(path)


def test_lessons_are_listed(chatrobot: Command) -> None:
    done = chatrobot("lesson")
    assert done.code == 0
    assert "first-moves               First moves: 4 tasks, world empty" in done.out
    first = chatrobot("lesson", "--json").named("lesson")[0]
    assert (first["name"], first["titles"]["zh"], first["tasks"]) == ("first-moves", "第一步", 4)


def test_the_solutions_of_a_sheet_pass_as_they_are_printed(chatrobot: Command, sheet: str) -> None:
    printed = chatrobot("lesson", sheet, "--solutions").out
    assert printed == "# task 1: There\nforward 1 m\n# task 2: And turn\nturn left\n"
    done = chatrobot("lesson", sheet, "--check", "-", stdin=printed)
    assert done.code == 0, done.out
    assert done.out.endswith("Lesson passed: all 2 tasks.\n")


def test_lines_that_do_not_pass_are_told_and_the_exit_code_is_1(chatrobot: Command, sheet: str) -> None:
    lines = "# task 1\nforward 2 m\n/again\nforward 90 cm\n# task 2\n/hint\n右转\n"
    done = chatrobot("lesson", sheet, "--check", "-", "--json", stdin=lines)
    assert done.code == 1
    broken, passed, missing = done.named("verdict")
    assert (broken["task"], broken["passed"], broken["broken"]) == (1, False, True)
    assert broken["checks"][1] == {
        "check": "path_m", "state": "broken", "code": "path_m_high", "is": "2.00", "high": "1.2",
    }  # fmt: skip
    assert passed["passed"]
    assert missing["sentence"] == "还没有完成：还要再向左转 180°。"
    (lesson,) = done.named("lesson_ended")
    assert not lesson["passed"]
    assert [(task["state"], task["tries"], task["hints"]) for task in lesson["tasks"]] == [
        ("passed", 2, 0),
        ("open", 1, 1),
    ]


def test_a_sheet_whose_mistake_passes_is_told_to_be_wrong(chatrobot: Command, sheet: str) -> None:
    done = chatrobot("lesson", sheet, "--test")
    assert done.code == 1
    assert "2 And turn, mistake (en)\n  WRONG, it passes: Task 2 passed: it looks the right way." in done.out
    assert done.out.endswith("6 tries, 1 wrong\n")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ["first-moves"],
            "a lesson is for a person at a terminal (chatrobot lesson first-moves --check FILE",
        ),
        (["first-moves", "--world", "home", "--test"], "a lesson has its own world"),
        (["first-moves", "--on", "dds", "--test"], "judged by the simulated robot's true pose"),
        (["first-moves", "--test", "--solutions"], "these do not go together"),
        (["--test"], "no lesson is named"),
        (["first-moves", "--check", "/nowhere"], "/nowhere: No such file or directory"),
        (["nowhere"], "there is no lesson named 'nowhere'"),
    ],
)
def test_what_cannot_be_done_is_told_with_the_way_out(
    chatrobot: Command, arguments: list[str], said: str
) -> None:
    done = chatrobot("lesson", *arguments)
    assert done.code == 2
    assert said in done.err


def test_plan_text_keeps_the_language_of_the_pupil(chatrobot: Command, sheet: str) -> None:
    done = chatrobot("lesson", sheet, "--check", "-", stdin="后退\n/again\ndrive 1 m\n")
    assert "✓ 任务 1 通过" in done.out, done.err
    assert "课程没有通过" in done.out
