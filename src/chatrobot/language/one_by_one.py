"""Orders that each begin with a verb of their own are read one by one: `turn three times, drive 1 m`.

Rules that read a text as a whole let one clause tell of another: `draw a square, 1 m`, `go on, slowly`. Where each
part orders a whole motion by itself nothing is told of another, and each is done, in the order it is said.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import cache

from chatrobot.language.data_files import load_table
from chatrobot.language.frames import EXTENTS, GO, STILL, TURN, Frame
from chatrobot.language.in_words import read_in_words
from chatrobot.language.interpretation import Interpretation, LanguageCode, planned
from chatrobot.language.reading import Reading, frames_of
from chatrobot.language.rephrase import rephrased
from chatrobot.language.rules import form
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Plan, Step
from chatrobot.plan.text import format_plan

_SILENT = frozenset({"filler", "glue", "conn"})
_OWN = frozenset({"to_start", "around", "bit", "no_turn", "sideways"})
_TOLD = frozenset({*EXTENTS, "times", "number", "speed", "rate", "count"})
_ELSEWHERE = frozenset({"order", "condition", "negation", "correction"})
_MOST_PARTS = 12

Reader = Callable[[str], Interpretation]


def one_by_one(text: str, rephrased_text: str, reading: Reading, read: Reader) -> Interpretation:
    """What the parts of a normalised text order, where each is an order of its own; else of the text as a whole.

    Raises:
        Unclear: for a text that is not understood, and for a part that is unclear by itself, for as a whole it was
            read with what another part says.
    """
    try:
        meant = read_in_words(rephrased_text, reading)
    except Unclear as problem:
        is_open = problem.code == "unclear_motion" and not problem.refused
        steps = _steps(_orders(text, reading), read) if is_open else []
        if not steps:
            raise
        return planned(steps, reading.language)
    steps = _steps(_orders(text, reading), read) if meant.plan is not None else []
    if meant.plan is None or not steps:
        return meant
    has_moved = any(turn.moved for turn in reading.context.dialogue.turns)
    told, apart = (_route(plan, has_moved) for plan in (meant.plan, Plan(tuple(steps))))
    return meant if told == apart else planned(steps, reading.language)


def _steps(orders: Sequence[tuple[str, list[Frame]]], read: Reader) -> list[Step]:
    """The steps of all parts; none where a part orders nothing."""
    plans = [read(part).plan for part, _ in orders]
    return [] if None in plans else [step for plan in plans if plan is not None for step in plan.steps]


def _orders(text: str, reading: Reading) -> list[tuple[str, list[Frame]]]:
    """The parts of a text, each with its frames; none where one of them is no order of its own."""
    parts = _parts(text, reading.language)
    if not 1 < len(parts) <= _MOST_PARTS:
        return []
    orders: list[tuple[str, list[Frame]]] = []
    for part in parts:
        frames = _frames(part, reading)
        if not _are_whole(frames) or (orders and _goes_on(orders[-1][1], frames)):
            return []
        orders.append((part, frames))
    if any("times" in frame.q for frame in orders[-1][1]):
        return []  # `go 50 cm and turn right, 4 times`: both, maybe
    return orders


def _parts(text: str, language: LanguageCode) -> list[str]:
    """The text cut where one order may end and the next begin."""
    return [
        part.strip(" ,.!;，。！；") for part in _joints(language).split(text) if part.strip(" ,.!;，。！；")
    ]


@cache
def _joints(language: LanguageCode) -> re.Pattern[str]:
    return re.compile(str(load_table(language, "one_by_one")["joints"]))


def _frames(part: str, reading: Reading) -> list[Frame]:
    """The frames of a part that begins with a verb and points at nothing outside of it; else none."""
    if form(reading.language, "one_by_one", "tells").search(part):
        return []
    atoms = [atom for atom in reading.atoms(rephrased(part, reading.language)) if atom.kind not in _SILENT]
    if not atoms or atoms[0].kind not in ("verb", "shape") or _ELSEWHERE & {atom.kind for atom in atoms}:
        return []
    try:
        return frames_of(atoms)
    except Unclear:
        return []


def _are_whole(order: Sequence[Frame]) -> bool:
    """Whether the frames of a part order whole motions."""
    return bool(order) and all(map(_is_whole, order))


def _goes_on(before: Sequence[Frame], order: Sequence[Frame]) -> bool:
    """Whether a part depends on the one before: `slide 1 m left, slide back`, `a circle, turn right`."""
    last, first = before[-1], order[0]
    if first.direction == "back":
        return not first.has_extent or last.verb in ("uturn", *TURN)  # `turn round and go back a metre`
    open_side = bool(last.shape) or (last.verb in TURN and not last.sided)
    how_it_is_drawn = open_side and first.verb in TURN and first.sided and not first.q
    return how_it_is_drawn or last.verb == first.verb == "uturn"


def _is_whole(frame: Frame) -> bool:
    if frame.flags - _OWN or frame.q.keys() - _TOLD or (frame.roles and not frame.shape):
        return False
    if "to_start" in frame.flags:
        return frame.verb == "go" and not frame.direction
    if frame.place:
        return frame.verb in GO  # `look at the desk`: from where the part before leads
    if frame.shape or frame.verb in TURN:
        return True
    if frame.verb in GO:
        return bool(frame.direction or frame.has_extent or {"number", "times"} & frame.q.keys())
    return frame.verb in ("curve", "uturn", *STILL)


def _route(plan: Plan, has_moved: bool) -> str:
    """The plan as text. What begins where the robot began has one start: `turn left and go home`."""
    told = format_plan(plan)
    return told if has_moved else told.replace(" from start", "")
