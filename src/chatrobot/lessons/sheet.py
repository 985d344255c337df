"""Lesson sheets: YAML files of a teacher's, checked field by field, and those that come with ChatRobot."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from chatrobot.core.errors import LessonError, WorldError
from chatrobot.core.geometry import Pose
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.lessons.checks import CHECKS, START, Check, read_place
from chatrobot.options import DEFAULT_ROBOT
from chatrobot.sim.fields import Field, compose, read_text
from chatrobot.sim.load import load_world
from chatrobot.sim.world import World

_BUILT_IN = Path(__file__).with_name("sheets")
_HAS = "a lesson has a title, a world and tasks"
_ENDINGS = (".yaml", ".yml")


@dataclass(frozen=True)
class Saying:
    """A text in one language or more."""

    by_language: Mapping[str, str]

    def in_language(self, language: str) -> str:
        """Return it in that language, else in one that it has."""
        return self.by_language.get(language) or next(iter(self.by_language.values()))


Lines = Mapping[str, tuple[str, ...]]
"""What is typed, by language: each text is one turn."""


@dataclass(frozen=True)
class Task:
    """One task: what is asked, the checks of what was done, and what a teacher knows of it.

    `begins_at` is where it begins, in the frame of the world, with its names; None: wherever the robot stands.
    """

    title: Saying
    task: Saying
    hint: Saying | None
    checks: tuple[Check, ...]
    begins_at: Pose | None
    begins_names: tuple[str, ...]
    solution: Lines
    mistake: Lines


@dataclass(frozen=True)
class Sheet:
    """A lesson. `world_name` and `robot` are what a session is set up with; `robot_at` is where it is named."""

    name: str
    title: Saying
    intro: Saying | None
    world_name: str
    world: World
    robot: str
    robot_at: str
    tasks: tuple[Task, ...]


def lesson_names() -> list[str]:
    """Return the names of the lessons that come with ChatRobot, in the order in which they build on each other."""
    return [file.stem.partition("-")[2] for file in _files()]


def _files() -> list[Path]:
    return sorted(_BUILT_IN.glob("*.yaml"))


def load_sheet(name_or_path: str) -> Sheet:
    """Return the lesson of that name, or in that file (anything with a slash, or ending in .yaml or .yml).

    Raises:
        LessonError: there is none, or it cannot be used; names file, line, field and what is allowed.
    """
    if "/" in name_or_path or name_or_path.endswith(_ENDINGS):
        path = Path(name_or_path).expanduser()
        return parse_sheet(read_text(path, LessonError), str(path), path.stem, path.parent)
    found = {file.stem.partition("-")[2]: file for file in _files()}
    if name_or_path not in found:
        near = difflib.get_close_matches(name_or_path, found, n=1)
        allowed = (
            f"{f'did you mean {near[0]}? ' if near else ''}{', '.join(found)}, or a path to a .yaml file"
        )
        raise LessonError(f"there is no lesson named {name_or_path!r}", allowed=allowed)
    path = found[name_or_path]
    return parse_sheet(read_text(path, LessonError), path.name, name_or_path, _BUILT_IN)


def parse_sheet(text: str, source: str, name: str, folder: Path) -> Sheet:
    """Read a lesson; `source` is what errors call it, a world file of its own is looked for in `folder`."""
    fields = compose(text, source, LessonError, _HAS).mapping(
        "title", "intro", "world", "robot", "tasks", required=("title", "world", "tasks")
    )
    world_name, world = _world(fields["world"], folder)
    tasks = fields["tasks"].items()
    if not tasks:
        raise fields["tasks"].error("is empty", "a list of tasks")
    return Sheet(
        name=name,
        title=_saying(fields["title"]),
        intro=_saying(fields["intro"]) if "intro" in fields else None,
        world_name=world_name,
        world=world,
        robot=fields["robot"].text() if "robot" in fields else DEFAULT_ROBOT,
        robot_at=fields["robot"].where if "robot" in fields else source,
        tasks=tuple(_task(item, world) for item in tasks),
    )


def _world(named: Field, folder: Path) -> tuple[str, World]:
    """Load the world; a file is meant beside the sheet."""
    name = named.text()
    if name.endswith(_ENDINGS):
        name = str((folder / Path(name).expanduser()).resolve())
    try:
        return name, load_world(name)
    except WorldError as error:
        raise named.error(
            f"{error.where}: {error.problem}" if error.where else error.problem, error.allowed
        ) from error


def _by_language(given: Field) -> dict[str, Field]:
    try:
        fields = given.mapping(*REPLY_LANGUAGES)
    except LessonError as error:
        allowed = f"by language: {', '.join(REPLY_LANGUAGES)}; a text with a comma or a colon goes in quotation marks"
        raise LessonError(error.problem, where=error.where, allowed=allowed) from error
    if not fields:
        raise given.error("is empty", f"by language: {', '.join(REPLY_LANGUAGES)}")
    return fields


def _saying(given: Field) -> Saying:
    if not given.is_mapping:
        return Saying({REPLY_LANGUAGES[0]: given.lines()})
    fields = _by_language(given)
    return Saying({language: text.lines() for language, text in fields.items()})


_MUST = ("title", "task", "check", "solution")


def _task(item: Field, world: World) -> Task:
    fields = item.mapping(*_MUST, "hint", "begins_at", "mistake", required=_MUST)
    spot = read_place(fields["begins_at"], world) if "begins_at" in fields else None
    checks = fields["check"].mapping(*CHECKS)
    if not checks:
        raise fields["check"].error("is empty", f"one or more of {', '.join(CHECKS)}")
    return Task(
        title=_saying(fields["title"]),
        task=_saying(fields["task"]),
        hint=_saying(fields["hint"]) if "hint" in fields else None,
        checks=tuple(CHECKS[name](given, world) for name, given in checks.items()),
        begins_at=spot.pose if spot is not None else None,
        begins_names=spot.names if spot is not None else START,
        solution=_lines(fields["solution"]),
        mistake=_lines(fields["mistake"]) if "mistake" in fields else {},
    )


def _lines(given: Field) -> Lines:
    """Read what is typed: a text or a list of texts, for all languages or by language."""
    if not given.is_mapping:
        return dict.fromkeys(REPLY_LANGUAGES, _texts(given))
    return {language: _texts(texts) for language, texts in _by_language(given).items()}


def _texts(given: Field) -> tuple[str, ...]:
    items = given.items() if given.is_list else [given]
    if not items:
        raise given.error("is empty", "a text or a list of texts")
    return tuple(item.lines() for item in items)
