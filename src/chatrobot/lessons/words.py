"""A lesson in words: tasks, verdicts and the summary, in the language of the pupil (`data/<code>/lesson.toml`)."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.core.reason import Value
from chatrobot.language.data_files import load_table
from chatrobot.language.phrases import by_language
from chatrobot.lessons.attempt import Values
from chatrobot.lessons.checks import Finding
from chatrobot.lessons.run import LessonRun, Verdict
from chatrobot.lessons.sheet import Task


def say(language: str, phrase: str, /, **values: Value) -> str:
    """Return the phrase of that code."""
    return str(load_table(language, "lesson")[phrase]).format(**values)


def describe_finding(finding: Finding, language: str) -> str:
    """What one check says."""
    values = finding.values
    told: dict[str, Value] = {
        key: by_language(value, language)[0] if isinstance(value, tuple) else value
        for key, value in values.items()
    }
    if "way" in told:
        told["way"] = say(language, f"seen_{told['way']}")
    return say(language, finding.code, **told, range=_range(values, language))


def _range(values: Values, language: str) -> str:
    low, high = str(values.get("low", "")), str(values.get("high", ""))
    if low and high:
        return say(language, "range_exact" if low == high else "range_both", low=low, high=high)
    return say(language, "range_low" if low else "range_high", low=low, high=high)


def describe_verdict(verdict: Verdict, language: str) -> str:
    """What is achieved and what is still missing, in a sentence."""
    if not verdict.findings:
        return say(language, "task_begins" if verdict.returned else "task_not_begun")
    if verdict.is_passed:
        return say(language, "passed", number=verdict.number, done=_join(verdict.findings, language))
    if verdict.is_broken:
        broken = [finding for finding in verdict.findings if finding.state == "broken"]
        return say(language, "broken", missing=_join(broken, language))
    missing = _join([finding for finding in verdict.findings if finding.state == "missing"], language)
    right = [finding for finding in verdict.findings if finding.state == "done" and not finding.is_limit]
    if right:
        return say(language, "missing_right", missing=missing, done=_join(right, language))
    return say(language, "missing", missing=missing)


def _join(findings: Sequence[Finding], language: str) -> str:
    return say(language, "list_separator").join(describe_finding(each, language) for each in findings)


def describe_lesson(run: LessonRun, robot_title: str, language: str) -> list[str]:
    """What a pupil reads at the beginning."""
    sheet = run.sheet
    lines = [say(language, "lesson_of", title=sheet.title.in_language(language), count=len(sheet.tasks))]
    lines += [sheet.intro.in_language(language)] if sheet.intro is not None else []
    return [
        *lines,
        say(language, "lesson_world", robot=robot_title, world=sheet.world.name),
        say(language, "lesson_keys"),
    ]


def describe_task(run: LessonRun, language: str) -> list[str]:
    """The task that is to be done: its head, what is asked, and where it begins if the robot is elsewhere."""
    task = run.task
    if task is None:
        return []
    count = len(run.sheet.tasks)
    title = task.title.in_language(language)
    lines = [
        say(language, "task_head", number=run.number, count=count, title=title),
        task.task.in_language(language),
    ]
    if not run.has_begun:
        lines.append(say(language, "task_elsewhere", place=by_language(task.begins_names, language)[0]))
    return lines


def describe_hint(task: Task | None, language: str) -> str:
    """The hint of a task."""
    if task is None or task.hint is None:
        return say(language, "hint_none")
    return say(language, "hint_is", hint=task.hint.in_language(language))


def describe_end(run: LessonRun, language: str) -> list[str]:
    """What became of each task, and of the lesson."""
    lines = [
        say(
            language, f"summary_{record.state}", number=number, title=task.title.in_language(language),
            tries=record.try_count, hints=record.hint_count,
        )
        for number, (task, record) in enumerate(zip(run.sheet.tasks, run.records), 1)
    ]  # fmt: skip
    count, passed = len(run.records), sum(record.state == "passed" for record in run.records)
    code = "lesson_passed" if run.is_passed else "lesson_left"
    return [*lines, say(language, code, count=count, passed=passed)]
