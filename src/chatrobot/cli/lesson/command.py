"""`chatrobot lesson [FILE|NAME]`: list the lessons, take one at the console, or have lines and sheets checked."""

from __future__ import annotations

import argparse
import shlex
import sys
from dataclasses import replace

from chatrobot.cli.choices import setup_from
from chatrobot.cli.console.words import language_of_environment
from chatrobot.cli.folders import profile_folders
from chatrobot.cli.json_lines import json_line
from chatrobot.cli.recorder import recorded
from chatrobot.compose import Setup
from chatrobot.core.errors import LessonError, ProfileError, UsageError
from chatrobot.lessons.run import LessonRun
from chatrobot.lessons.sheet import Sheet, lesson_names, load_sheet
from chatrobot.lessons.words import describe_end, say
from chatrobot.link.processes import SIMULATED
from chatrobot.robots.load import load_profile, profile_argument

_NAME_COLUMNS = 26


def run(args: argparse.Namespace) -> int:
    """Return 0 where the lesson was passed, the sheet is right or the list is printed, 1 where not.

    Raises:
        LessonError: there is no such lesson, or its sheet cannot be used.
        UsageError: the options do not fit.
    """
    if not args.lesson:
        return _list(args)
    sheet = load_sheet(args.lesson)
    _check(args)
    if args.solutions:
        return _print_solutions(sheet)
    setup = setup_of(args, sheet, is_alone=bool(args.check or args.test))
    if args.check or args.test:
        from chatrobot.cli.lesson import check, trial

        robot = profile_argument(setup.robot, profile_folders(args))
        setup = replace(setup, fast=True, trace=True, robot=robot)
        if args.test:
            return trial.run(sheet, setup, is_json=args.json)
        return check.run(sheet, setup, args.check, is_json=args.json)
    return _take(args, sheet, setup)


def _take(args: argparse.Namespace, sheet: Sheet, setup: Setup) -> int:
    """Have a pupil take the lesson at the console."""
    from chatrobot.cli.console.app import run_console
    from chatrobot.cli.console.lesson import ConsoleLesson
    from chatrobot.cli.lines import TypedAhead

    lesson = ConsoleLesson(LessonRun(sheet, setup.profile.footprint))
    code = run_console(setup, TypedAhead(), recorded(args, unasked=True), has_page=args.web, lesson=lesson)
    print("\n".join(describe_end(lesson.run, lesson.language)))
    return code or (0 if lesson.run.is_passed else 1)


def check_robot(args: argparse.Namespace) -> None:
    """Refuse a robot or a world that is not the lesson's.

    Raises:
        UsageError: that is what was chosen.
    """
    if args.world:
        raise UsageError("a lesson has its own world", where="--world", allowed="world: NAME in the sheet")
    if args.on not in SIMULATED:
        raise UsageError("a lesson is judged by the simulated robot's true pose", where="--on", allowed="sim")


def _check(args: argparse.Namespace) -> None:
    """Refuse options that do not fit."""
    check_robot(args)
    ways = [name for name in ("check", "test", "solutions") if getattr(args, name)]
    if len(ways) > 1:
        raise UsageError("these do not go together", where=" ".join(f"--{name}" for name in ways))
    if args.fast and not ways:
        raise UsageError(
            "a lesson runs in real time", where="--fast", allowed="--check FILE, in simulated time"
        )
    if not ways and (args.json or not sys.stdin.isatty()):
        allowed = f"chatrobot lesson {shlex.quote(args.lesson)} --check FILE, or - for standard input"
        raise UsageError(
            "a lesson is for a person at a terminal", where="--json" * args.json, allowed=allowed
        )


def setup_of(args: argparse.Namespace, sheet: Sheet, *, is_alone: bool = False) -> Setup:
    """Gather what was chosen, with the world and the robot of the lesson. `is_alone`: no person is there."""
    setup = setup_from(args, world=sheet.world_name, named_model=is_alone, programs=True)
    if args.names_robot:
        return replace(setup, world=sheet.world_name, robot=args.robot)
    try:
        load_profile(sheet.robot, profile_folders(args))
    except ProfileError as error:
        raise LessonError(f"robot: {error}", where=sheet.robot_at) from error
    return replace(setup, world=sheet.world_name, robot=sheet.robot)


def _list(args: argparse.Namespace) -> int:
    if args.check or args.test or args.solutions:
        raise UsageError("no lesson is named", allowed=f"one of {', '.join(lesson_names())}, or a file")
    language = language_of_environment()
    for name in lesson_names():
        sheet = load_sheet(name)
        title, count = sheet.title.in_language(language), len(sheet.tasks)
        if args.json:
            about = {"event": "lesson", "name": name, "titles": dict(sheet.title.by_language)}
            print(
                json_line({**about, "world": sheet.world_name, "robot": sheet.robot, "tasks": count}), end=""
            )
        else:
            print(
                f"{name:<{_NAME_COLUMNS}}{say(language, 'list_row', title=title, count=count, world=sheet.world_name)}"
            )
    if not args.json:
        print(say(language, "list_hint"))
    return 0


def _print_solutions(sheet: Sheet) -> int:
    """Print what passes, in the form that `--check` reads."""
    language = language_of_environment()
    for number, task in enumerate(sheet.tasks, 1):
        print(f"# {say(language, 'solution_of', number=number, title=task.title.in_language(language))}")
        lines = task.solution.get(language) or next(iter(task.solution.values()))
        for text in lines:
            print(f"{text}\n" if "\n" in text else text)
    return 0
