"""A lesson in the conversation of the console: what is shown, and its commands beside all others."""

from __future__ import annotations

import pytest

from chatrobot.cli.console import commands
from chatrobot.cli.console.controller import ChatController
from chatrobot.cli.console.lesson import ConsoleLesson
from chatrobot.cli.recorder import _Tap
from chatrobot.core.events import Event, Interpreted, Notice, Result, Started
from chatrobot.core.reason import Reason
from chatrobot.core.sensed_events import TruePose
from chatrobot.lessons.run import LessonRun
from tests.console.conftest import controller, log
from tests.console.fakes import told
from tests.eval.traces import forward, trace
from tests.lessons.made import FOOTPRINT, sheet_with

__all__ = ["controller", "log"]


@pytest.fixture
def lesson(controller: ChatController) -> ConsoleLesson:
    lesson = ConsoleLesson(LessonRun(sheet_with("path_m: {at_least: 0.9}, plan_text: true"), FOOTPRINT))
    controller.display.print(*lesson.begin(controller))
    return lesson


def drive(controller: ChatController, lesson: ConsoleLesson, turn: int, distance_m: float) -> None:
    for event in (Interpreted(turn, "offline", "", ""), Started(turn)):
        controller.hear(event)
        lesson.hear(event)
    for sample in trace(forward(distance_m)):
        lesson.hear(TruePose(0, *sample))
    lesson.hear(Result(turn, "completed", "done", path_m=distance_m))


def test_a_pupil_types_and_the_lesson_ends_where_all_is_passed(
    controller: ChatController, lesson: ConsoleLesson, log: list[tuple[str, ...]]
) -> None:
    controller.enter("drive 1 m")
    drive(controller, lesson, lesson_turn(log), 1.0)
    assert ("leave", 0) in log
    assert lesson.run.is_passed


def test_a_pasted_plan_counts_as_plan_text_and_a_sentence_does_not(
    controller: ChatController, lesson: ConsoleLesson, log: list[tuple[str, ...]]
) -> None:
    controller.enter("go ahead one metre")
    drive(controller, lesson, lesson_turn(log), 1.0)
    assert not lesson.run.is_passed
    lesson.run.again(lambda _: 0)
    lesson.run.hear(Result(0, "completed", "done"))
    controller.enter("drive 0.5 m\ndrive 0.5 m")
    drive(controller, lesson, lesson_turn(log), 1.0)
    assert lesson.run.is_passed


def lesson_turn(log: list[tuple[str, ...]]) -> int:
    """The fake session numbers its turns by what it has noted so far."""
    return max(place for place, entry in enumerate(log, 1) if entry[0] in ("say", "say_plan"))


def test_that_a_lesson_is_recorded_is_told_by_no_true_pose() -> None:
    """It comes on the wire's thread, before there is a display: the wire would end, and nothing be judged."""
    heard: list[Event] = []
    tap = _Tap(heard.append)
    tap.waiting.append(notice := Notice(0, Reason("recording", {"path": "run.mcap"})))
    tap.hear(pose := TruePose(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert heard == [pose]
    tap.hear(result := Result(1, "completed", "Done."))
    assert heard == [pose, notice, result]


def test_the_commands_of_a_lesson_are_those_of_a_lesson_alone(
    controller: ChatController, log: list[tuple[str, ...]]
) -> None:
    for name in ("task", "hint", "again", "skip"):
        assert name not in commands.BY_NAME
    lesson = ConsoleLesson(LessonRun(sheet_with("path_m: {at_least: 0.9}", tasks=2), FOOTPRINT))
    lesson.begin(controller)
    by_name = {command.name: command for command in controller.commands}
    by_name["hint"].act(controller, "")
    assert lesson.run.records[0].hint_count == 1
    by_name["skip"].act(controller, "")
    assert lesson.run.number == 2
    by_name["again"].act(controller, "")
    assert told(log) == [], "the robot stands where the task begins: nothing is driven"
    lesson.hear(TruePose(0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0))
    by_name["again"].act(controller, "")
    assert told(log) == [("say_plan", "go to 0 0 facing 0 deg")]
