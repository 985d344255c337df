"""A pupil's way through a lesson: what counts, what begins anew, and that nothing moves unasked."""

from __future__ import annotations

from chatrobot.core.events import Interpreted, Result, Started
from chatrobot.core.sensed_events import TruePose
from chatrobot.lessons.run import LessonRun
from chatrobot.lessons.words import describe_end, describe_hint, describe_task, describe_verdict
from tests.eval.traces import forward, left, trace
from tests.lessons.made import FOOTPRINT, drive, sheet_with

ONE_METRE = "ends_at: {x_m: 1, y_m: 0, within_m: 0.1}, path_m: {at_most: 1.5}"


def test_a_broken_limit_stays_broken_until_the_task_begins_anew() -> None:
    run = LessonRun(sheet_with(ONE_METRE), FOOTPRINT)
    verdict = drive(run, trace(forward(2.0), forward(-1.0)))
    assert verdict is not None
    assert verdict.is_broken
    assert "Type /again" in describe_verdict(verdict, "en")
    assert "/again" in describe_verdict(verdict, "zh")
    sent: list[str] = []
    assert not run.again(lambda plan_text: sent.append(plan_text) or 7)
    assert sent == ["go to 0 0 facing 0 deg"]
    assert not run.has_begun
    run.hear(TruePose(0, 9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    back = run.hear(Result(7, "completed", "done", path_m=1.0))
    assert back is not None
    assert back.returned
    assert drive(run, trace(forward(1.0)), turn=8).is_passed
    assert run.is_passed
    assert run.records[0].try_count == 2


def test_what_is_missing_may_be_done_by_a_further_turn() -> None:
    run = LessonRun(sheet_with(ONE_METRE), FOOTPRINT)
    whole = trace(forward(0.5), forward(0.5))
    first = drive(run, whole[: len(whole) // 2 + 1])
    assert describe_verdict(first, "en") == (
        "Not yet: the goal is still 0.50 m away, straight ahead (within 0.1 m is near enough)."
    )
    assert drive(run, whole[len(whole) // 2 :], turn=2).is_passed


def test_a_turn_that_another_one_replaces_is_judged_together_with_it() -> None:
    run = LessonRun(sheet_with(ONE_METRE), FOOTPRINT)
    run.hear(Started(1))
    assert run.hear(Result(1, "stopped", "stopped", path_m=0.1), goes_on=True) is None
    assert drive(run, trace(forward(1.0)), turn=2).is_passed


def test_a_turn_that_the_way_back_replaces_does_not_end_it() -> None:
    run = LessonRun(sheet_with(ONE_METRE), FOOTPRINT)
    drive(run, trace(forward(0.5)))
    run.again(lambda _: 3)
    assert run.hear(Result(2, "stopped", "new instruction", path_m=0.1), goes_on=True) is None
    back = run.hear(Result(3, "completed", "done"))
    assert back is not None
    assert back.returned


def test_a_turn_that_moved_nothing_is_not_judged() -> None:
    run = LessonRun(sheet_with(ONE_METRE), FOOTPRINT)
    run.hear(Interpreted(1, "offline", "", "?"))
    assert run.hear(Result(1, "unclear", "?")) is None
    assert run.records[0].try_count == 0


def test_a_task_that_begins_elsewhere_waits_for_the_pupil_to_ask_for_the_way_there() -> None:
    sheet = sheet_with("path_m: {at_least: 0.5}", "home", more="begins_at: kitchen")
    run = LessonRun(sheet, FOOTPRINT)
    assert not run.has_begun
    assert describe_task(run, "zh")[-1].startswith("本任务从厨房开始")
    away = drive(run, trace(forward(0.5)))
    assert away is not None
    assert not away.findings, "it does not count yet"
    assert "does not count" in describe_verdict(away, "en")
    sent: list[str] = []
    run.again(lambda plan_text: sent.append(plan_text) or 5)
    assert sent == ["go to 4 0.7 facing 0 deg"]
    run.hear(Result(5, "stopped", "stopped", path_m=0.2))
    assert not run.has_begun, "the pupil stopped it on its way"


def test_it_begins_where_the_pupil_has_driven_to_where_it_begins() -> None:
    sheet = sheet_with("path_m: {at_least: 0.1}", "home", more="begins_at: living room")
    run = LessonRun(sheet, FOOTPRINT)
    verdict = drive(run, trace(forward(1.1), left(1.5707963), forward(0.7), left(1.5707963)))
    assert verdict is not None
    assert verdict.returned
    assert run.has_begun


def test_hints_and_skipped_tasks_are_told_at_the_end() -> None:
    run = LessonRun(sheet_with("path_m: {at_least: 0.5}", tasks=2), FOOTPRINT)
    assert describe_hint(run.hint(), "zh") == "提示：这样做"
    run.skip()
    assert drive(run, trace(forward(1.0)), turn=2).is_passed
    assert run.task is None
    assert not run.is_passed
    assert describe_end(run, "en") == [
        "1 a task: left out",
        "2 a task: passed, turns judged: 1, hints: 0",
        "Lesson not passed: 1 of 2 tasks.",
    ]
    assert run.hear(Started(3)) is None


def test_after_the_last_task_an_earlier_one_may_be_done_and_what_was_passed_stays_so() -> None:
    run = LessonRun(sheet_with(ONE_METRE, tasks=3), FOOTPRINT)
    run.skip()
    drive(run, trace(forward(1.0)))
    run.skip()
    assert run.task is None
    assert run.go_to(2)
    assert [record.state for record in run.records] == ["skipped", "passed", "skipped"]
    run.hear(TruePose(0, *trace(forward(1.0))[0]))
    assert run.go_to(1)
    verdict = drive(run, trace(forward(1.0)), turn=2)
    assert verdict is not None
    assert verdict.is_passed
    assert run.number == 3
    assert not run.go_to(4)
