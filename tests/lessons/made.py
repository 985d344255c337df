"""Sheets and tries made by hand."""

from __future__ import annotations

from pathlib import Path

from chatrobot.core.events import Interpreted, Result, Started
from chatrobot.core.sensed_events import TruePose
from chatrobot.lessons.checks import Finding
from chatrobot.lessons.run import LessonRun, Verdict
from chatrobot.lessons.sheet import Sheet, parse_sheet
from chatrobot.sim.trace import Sample

FOOTPRINT = ((-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1))


def sheet_with(check: str, world: str = "empty", *, more: str = "", tasks: int = 1) -> Sheet:
    task = f"""
  - title: a task
    task: do it
    hint: {{en: like this, zh: 这样做}}
    solution: forward 1 m
    check: {{{check}}}
    {more}"""
    return parse_sheet(f"title: a lesson\nworld: {world}\ntasks:{task * tasks}", "made", "made", Path())


def drive(
    run: LessonRun, trace: list[Sample], text: str = "", turn: int = 1, plan_text: str = ""
) -> Verdict | None:
    """Have the robot drive so for that text; what the checks say."""
    run.note_said(turn, text)
    run.hear(Interpreted(turn, "offline", plan_text, ""))
    run.hear(TruePose(0, *trace[0]))
    run.hear(Started(turn))
    for sample in trace[1:]:
        run.hear(TruePose(0, *sample))
    return run.hear(Result(turn, "completed", "done", path_m=1.0))


def judged(check: str, trace: list[Sample], world: str = "empty", **how: str) -> Finding:
    """What that one check says of a drive."""
    verdict = drive(LessonRun(sheet_with(check, world), FOOTPRINT), trace, **how)
    assert verdict is not None
    return verdict.findings[0]
