"""Words that point at an earlier motion, and play no part in the plan: such a plan is asked about, not done.

`heeded.py` changes each amount and side of an order that is told in full. An order that is told by what was done
before has words besides that no atom carries (“step 4”, “the very first order”, “just as long”): each is left out here
in turn, and the plan must change. What they are is `passed_over.toml`.
"""

from __future__ import annotations

import cmath
import contextlib
import math
from collections.abc import Callable, Iterator, Sequence

from chatrobot.language.data_files import load_table
from chatrobot.language.frames import SIDES
from chatrobot.language.inverse import is_sideways
from chatrobot.language.last_motion import atoms_said
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.rules import form
from chatrobot.language.selection_forms import number_said
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import expanded
from chatrobot.plan.steps import Arc, Drive, Plan, Step, Turn

_TURNED_ROUND = frozenset(
    {"undo", "return", "redo", "restore", "other_way", "mirrored", "swapped", "overshot"}
)
"""Verbs and flags by which a side that is named may be that of what was done, and not of what is to be done."""
_MAY_BE_OF_BEFORE = frozenset({"correction", "negation", "complaint"})
_TURNING = frozenset({"angle", "turns", "number"})
"""Amounts of a turn: `left 90`, in degrees."""
_SIDED = frozenset({"dir", "rot"})
_STEPS = frozenset({"wait", "turn"})
_CLOSED = frozenset({"square", "rectangle", "triangle", "pentagon", "hexagon", "octagon", "circle", "star"})
_SENSES = frozenset({"same_way", "other_way"})
_SAME = 1e-6
"""Metres, and radians."""


def passed_over(
    plain: str, language: str, plan: Plan, turns: Sequence[TurnRecord], read: Callable[[str], Plan | None]
) -> str:
    """The words of a normalised text that point at an earlier motion and are without effect in `plan`; "" for none.

    `read` makes a plan of a text; None of one that orders nothing.
    """
    moved = [turn for turn in turns if turn.moved and turn.plan is not None]
    before = [[*turn.plan.steps] for turn in moved if turn.plan is not None]
    atoms = atoms_said(plain)
    found = (
        _shape(plain, atoms, plan.steps)
        or _denied(atoms, plan.steps)
        or _withdrawn(plain, language, plan, read)
    )
    if found or not moved:
        return found or (_likeness(plain, language, atoms, plan.steps, before) if turns else "")
    return (
        _other_side(atoms, plan.steps, before[-1])
        or _side_of_slide(atoms, plan.steps, before[-1])
        or _again(atoms, plan.steps, before[-1])
        or _measure(plain, language, plan.steps, before)
        or _likeness(plain, language, atoms, plan.steps, before)
        or next(
            (said for said, rest in _without_part(plain, language, len(moved)) if _is_same(plan, rest, read)),
            "",
        )
    )


def _shape(plain: str, atoms: Sequence[Atom], steps: Sequence[Step]) -> str:
    """The shape that is named where straight lines are driven that end elsewhere: `a rectangle 1.2 m by 0.5 m`.

    A word that only looks like one (“hopp”, which may be taught) names none.
    """
    drives = [step for step in expanded(steps) if isinstance(step, Drive)]
    if len(drives) < len(list(expanded(steps))) or not drives:
        return ""
    end = sum(cmath.rect(drive.distance_m or 0.0, drive.direction_rad) for drive in drives)
    shapes = (atom.text for atom in atoms if atom.kind == "shape" and atom.value in _CLOSED)
    named = (text for text in shapes if text in plain)
    return next(named, "") if abs(end) > _SAME else ""


def _denied(atoms: Sequence[Atom], steps: Sequence[Step]) -> str:
    """The denied wait or turn that is in the plan all the same: `the same to the left, but without the wait`."""
    told = [atom for atom in atoms if atom.kind != "glue"]
    sided = {atom.text for atom in atoms if atom.kind in _SIDED}  # 不是右转: of a side, not of all turns
    done = {step.kind for step in expanded(steps)} & _STEPS
    for no, verb, behind in zip(told, told[1:], [*told[2:], None]):
        is_of_side = verb.text in sided or (behind is not None and behind.kind in _SIDED)
        if no.kind == "negation" and verb.value in done and not is_of_side:
            return verb.text
    return ""


def _withdrawn(plain: str, language: str, plan: Plan, read: Callable[[str], Plan | None]) -> str:
    """What takes a part of the order back, where all of it is in the plan: `…, then turn left, no, skip that`."""
    found = form(language, "passed_over", "withdrawn").search(plain)
    if found is None:
        return ""
    return (
        found.group()
        if _is_same(plan, f"{plain[: found.start()]}{plain[found.end() :]}".strip(), read)
        else ""
    )


def _is_same(plan: Plan, rest: str, read: Callable[[str], Plan | None]) -> bool:
    with contextlib.suppress(Unclear):
        return bool(rest) and read(rest) == plan
    return False


def _other_side(atoms: Sequence[Atom], steps: Sequence[Step], last: Sequence[Step]) -> str:
    """The one side that is named, where all that has a side in the plan has the other, and nothing was left out."""
    if len(steps) < len(last) and all(step in last for step in steps):
        return ""
    said = {atom.value: atom.text for atom in atoms if atom.kind in ("dir", "rot") and atom.value in SIDES}
    turned = any(atom.value in _TURNED_ROUND or atom.kind in _MAY_BE_OF_BEFORE for atom in atoms)
    done = {side for step in steps if (side := _side_of(step))}
    return next(iter(said.values())) if len(said) == 1 and done and not done & {*said} and not turned else ""


def _side_of_slide(atoms: Sequence[Atom], steps: Sequence[Step], last: Sequence[Step]) -> str:
    """The side that is named without a turn, where the robot would turn after a slide: `to the right, twice`."""
    sides = [atom.text for atom in atoms if atom.kind == "dir" and atom.value in SIDES]
    tells_turn = any(atom.kind in ("verb", "rot") or atom.value in _TURNING for atom in atoms)
    turns = all(isinstance(step, Turn) for step in steps)
    slid = isinstance(last[-1], Drive) and is_sideways(last[-1])
    return sides[0] if sides and turns and slid and not tells_turn else ""


def _side_of(step: Step) -> str:
    if isinstance(step, (Turn, Arc)):
        return "left" if step.left else "right"
    if isinstance(step, Drive) and is_sideways(step):
        return "left" if math.sin(step.direction_rad) > 0 else "right"
    return ""


def _measure(plain: str, language: str, steps: Sequence[Step], before: Sequence[list[Step]]) -> str:
    """The measure of a figure that is named, where the figure before is only done several times."""
    last = before[-1]
    count = len(steps) // len(last)
    found = form(language, "passed_over", "measure").search(plain)
    return found.group() if found is not None and count > 1 and [*steps] == last * count else ""


def _again(atoms: Sequence[Atom], steps: Sequence[Step], last: Sequence[Step]) -> str:
    """The word for once more, where only one motion is done so often after several: `again twice, but 50 cm`."""
    counted = any((atom.kind, atom.value) == ("q", "times") for atom in atoms)
    again = [atom.text for atom in atoms if (atom.kind, atom.value) == ("flag", "again")]
    alone = len(set(steps)) == 1 < len(set(last)) and steps[0] not in last
    return again[0] if again and counted and alone else ""


def _likeness(
    plain: str, language: str, atoms: Sequence[Atom], steps: Sequence[Step], before: Sequence[list[Step]]
) -> str:
    """What likens an order without an amount to a motion before, where no motion before was as large."""
    found = form(language, "passed_over", "likeness").search(plain)
    if found is None or any(atom.kind == "q" and not _is_pronoun(atom) for atom in atoms):
        return ""
    if any(atom.value in _SENSES for atom in atoms) and not _sizes(steps, Drive):
        return ""  # `the same way`, after `turn 30`
    done = {size for each in before for size in (*_sizes(each, Drive), *_sizes(each, Turn))}
    sizes = _sizes(steps, Drive) or _sizes(steps, Turn)
    new = [(kind, size) for kind, size in sizes if not any(_is_like(kind, size, other) for other in done)]
    return found.group() if new and len(sizes) == 1 else ""


def _is_like(kind: str, size: float, other: tuple[str, float]) -> bool:
    return kind == other[0] and abs(size - other[1]) < _SAME


def _sizes(steps: Sequence[Step], kind: type[Drive] | type[Turn]) -> set[tuple[str, float]]:
    """How far its drives went, in metres, or its turns on the spot, in radians."""
    alike = [step for step in expanded(steps) if isinstance(step, kind)]
    sizes = [step.distance_m if isinstance(step, Drive) else step.angle_rad for step in alike]
    return {(kind.__name__, size) for size in sizes if size is not None}


def _is_pronoun(atom: Atom) -> bool:
    """`The last one`."""
    return atom.value == "number" and atom.text.isalpha()


def _without_part(plain: str, language: str, turns: int) -> Iterator[tuple[str, str]]:
    """Each part of what was done before that the text names, with the text without it.

    A heading (“step two: turn left”) names none, and that of the last of so many turns only tells it again.
    """
    at, part = 0, form(language, "passed_over", "part")
    numbers = load_table(language, "selections")
    while (found := part.search(plain, at)) is not None:
        at = found.end()
        said = found.groupdict(default="")
        number = number_said(said, "nth", numbers) or number_said(said, "count", numbers)
        if number != turns and plain[at : at + 1] not in (*":,，",):
            yield found.group(), f"{plain[: found.start()]} {plain[at:]}".strip()
