"""The lessons that come with ChatRobot, driven; and sheets that cannot be used, told by their lines."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.cli.lesson.trial import Trial, trials
from chatrobot.compose import Setup
from chatrobot.core.errors import LessonError
from chatrobot.dialogue.options import Options
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.lessons.sheet import Sheet, lesson_names, load_sheet, parse_sheet


def setup_of(sheet: Sheet) -> Setup:
    offline = Options(interpreter="offline")
    return Setup(
        fast=True, trace=True, programs=True, world=sheet.world_name, robot=sheet.robot, options=offline
    )


def test_there_are_five_lessons_in_their_order_in_all_languages() -> None:
    assert lesson_names() == [
        "first-moves", "turns-and-shapes", "places-and-obstacles", "conditions-and-repetition", "first-program",
    ]  # fmt: skip
    for name in lesson_names():
        sheet = load_sheet(name)
        sayings = [
            sheet.title,
            *(text for task in sheet.tasks for text in (task.title, task.task, task.hint)),
        ]
        assert all(
            saying is not None and set(saying.by_language) == set(REPLY_LANGUAGES) for saying in sayings
        )
        assert all(set(task.solution) == set(task.mistake) == set(REPLY_LANGUAGES) for task in sheet.tasks)


@pytest.mark.parametrize("name", lesson_names())
def test_solutions_pass_and_mistakes_are_told_in_the_language_they_are_made_in(name: str) -> None:
    """Every solution in all languages; the mistakes in turn in one of them."""
    sheet = load_sheet(name)

    def is_tried(number: int, kind: str, language: str) -> bool:
        texts = sheet.tasks[number - 1].mistake
        is_its_turn = language == REPLY_LANGUAGES[(number + 1) % 3] or texts["en"] == texts["zh"]
        return kind == "solution" or is_its_turn

    tried: list[Trial] = list(trials(sheet, setup_of(sheet), is_tried))
    assert [trial.sentence for trial in tried if not trial.is_right] == []
    told = [trial for trial in tried if trial.kind == "mistake"]
    assert {trial.language for trial in told} == set(REPLY_LANGUAGES)
    for trial in told:
        assert trial.sentence.startswith(NOT_PASSED)


NOT_PASSED = ("Not yet: ", "Not this time: ", "还没有完成：", "这次不行：", "Noch nicht: ", "Diesmal nicht: ")
RIGHT = """\
title: one
world: home
tasks:
  - title: a
    task: b
    check: {ends_at: kitchen}
    solution: go to the kitchen
"""


@pytest.mark.parametrize(
    ("was", "now", "line", "said"),
    [
        ("world: home", "world: hoem", 2, "world: there is no world named 'hoem' (did you mean home? "),
        ("world: home", "world: [home]", 2, "world: must be a line of text"),
        ("title: one", "titel: one", 1, "titel: unknown field (did you mean title? allowed: title, intro"),
        ("    task: b\n", "", 4, "tasks[0]: task is missing (required: title, task, check, solution)"),
        ("kitchen}", "kitschen}", 6, "the world home has no place 'kitschen' (did you mean kitchen? allowed: start"),
        ("ends_at: kitchen", "passes: []", 6, "passes: is empty (one entry at least)"),
        ("ends_at: kitchen", "time_s: {at_most: -5}", 6, "at_most: -5 is not possible (a number from 0 to 100000)"),
        ("ends_at: kitchen", "end_at: kitchen", 6, "unknown field (did you mean ends_at? allowed: ends_at, passes"),
        ("ends_at: kitchen", "path_m: {at_most: far}", 6, "'far' is not a number (a number from 0 to 100000)"),
        ("ends_at: kitchen", "path_m: {at_least: 3, at_most: 2}", 6, "at_least is more than at_most"),
        ("ends_at: kitchen", "plan_text: yes", 6, "plan_text: 'yes' is not possible (allowed: true, True"),
        ("ends_at: kitchen", "plan_has: loop", 6, "'loop' is not possible (allowed: drive, turn, arc"),
        ("ends_at: kitchen", "heading_deg: {within: 5}", 6, "heading_deg: is is missing"),
        ("{ends_at: kitchen}", "{}", 6, "check: is empty (one or more of ends_at, passes"),
        ("task: b", "task: {en: come here, please}", 5, "a text with a comma or a colon goes in quotation marks"),
        ("title: a", "title: {fr: a}", 4, "unknown field (by language: en, zh, de"),
        ("    solution: go to the kitchen\n", "    solution: []\n", 7, "solution: is empty (a text or a list"),
        ("    task: b", "    begins_at: Mars\n    task: b", 5, "the world home has no place 'Mars'"),
        ("    task: b", "\ttask: b", 5, "is not YAML"),
    ],
)  # fmt: skip
def test_a_broken_sheet_is_told_by_its_line_what_is_wrong_and_what_is_allowed(
    was: str, now: str, line: int, said: str
) -> None:
    parse_sheet(RIGHT, "mine.yaml", "mine", Path())
    assert was in RIGHT
    with pytest.raises(LessonError) as error:
        parse_sheet(RIGHT.replace(was, now, 1), "mine.yaml", "mine", Path())
    assert f"mine.yaml, line {line}" in str(error.value)
    assert said in str(error.value)


def test_a_lesson_that_is_not_there_is_told_with_those_that_are(tmp_path: Path) -> None:
    with pytest.raises(LessonError, match=r"no lesson named 'first' .*first-moves"):
        load_sheet("first")
    with pytest.raises(LessonError, match="cannot be read"):
        load_sheet(str(tmp_path / "none.yaml"))
