"""Nothing said may be passed over in silence: what changes nothing when it is changed was not understood.

Where the rules lose an amount or a direction on the way (a slot that nobody reads, two clauses merged into one), the
plan looks fine and is not what was said. So every amount is changed a little, every direction turned round, and the
rules are asked again: the plan must change. In a long list all of it is read again once for each kind of clause, and
else only the clauses around the change: to read all of it again for each of hundreds would take seconds.
"""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Callable, Sequence

from chatrobot.language.inverse import is_sideways
from chatrobot.language.numbers import is_chinese, is_kind
from chatrobot.language.tokens import SILENT, Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Go, Step, Turn

_CHANGE = 1.07
"""Small enough that no limit or sign turns over, and nothing that is rounded hides it."""

_AMOUNTS = frozenset({"length", "time", "speed", "rate", "radius", "percent", "fold", "faster", "scale"})
"""Changed wherever they are said. Counts and angles are changed where nothing is drawn: a shape tells them twice, as in
`a triangle with three sides`."""

_OTHER_SIDE = {"left": "right", "right": "left"}

_OPPOSITE = {
    "left": "right", "right": "left", "forward": "back", "back": "forward",
    "forward_left": "back_right", "back_right": "forward_left",
    "forward_right": "back_left", "back_left": "forward_right",
}  # fmt: skip

_TAKEN_BACK = frozenset({"correction", "condition", "negation"})
"""Words after which what was said before may rightly count for nothing."""

_DOINGS = frozenset({"uturn", "return", "face", "wait"})
_ABOUT = frozenset({"uturn", "face"})
"""Verbs that do something by themselves, and are no manner of doing something else."""
_RETURNING = frozenset({"undo", "trip"})
"""What has a return in it already."""
_WAYS_OF_DOING = frozenset(
    {
        "other_way",
        "mirrored",
        "trip",
        "between",
        "halfway",
        "diagonal",
        "swapped",
        "leave_out",
    }
)
"""Flags that say how all of it is done: what is drawn with one of them is another figure."""
_OF_SEVERAL = frozenset({"each", "after_each", "until", "all"})
"""Flags of what is done several times, or till something; what is drawn, counted or bounded may tell it twice."""
_EXTENTS = frozenset({"length", "angle", "turns", "time"})
_COUNTED = frozenset({"trip", "between", "original_heading", "move", "times", "count"})
_TURNED = frozenset({"angle", "turns"})
_LONG = 40
"""So many amounts and directions are each asked about by themselves; it takes about a tenth of a second."""

_AROUND = 3
"""Separators on either side up to which a change in a long list is looked for: `, then` are two."""


def check_heeded(
    atoms: Sequence[Atom],
    steps: Sequence[Step],
    read: Callable[[list[Atom]], Sequence[Step]],
    *,
    follows: bool = False,
) -> None:
    """Ask back where an amount, a count or a direction in `atoms` plays no part in `steps`, which `read` made of them.

    `follows`: there was a motion before, of which `in all` may be said.

    Raises:
        Unclear: naming it.
    """
    if any(atom.kind in _TAKEN_BACK for atom in atoms):
        return
    instead = [i for i, atom in enumerate(atoms) if (atom.kind, atom.value) == ("flag", "instead")]
    if instead:
        _check_amounts(atoms, steps, read, instead[-1])
        return
    if any(isinstance(a, Go) and a.place and a == b for a, b in itertools.pairwise(steps)):
        # `to the dock and the desk twice`: it stands there already
        raise Unclear("unclear_motion", " ".join(atom.text for atom in atoms))
    _check_clauses(atoms, steps, read)
    _check_each(atoms, steps)
    _check_no_turn(atoms, steps)
    _check_sides(atoms, steps)
    _check_flags(atoms, steps, read, follows=follows)
    _check_amounts(atoms, steps, read)


def _check_amounts(
    atoms: Sequence[Atom], steps: Sequence[Step], read: Callable[[list[Atom]], Sequence[Step]], start: int = 0
) -> None:
    """Ask back where an amount or a direction from `start` on may be another for nothing."""
    asked = [(i, changed) for i, atom in enumerate(atoms) if (changed := _changed(atom, atoms)) is not None]
    asked = [(i, changed) for i, changed in asked if i >= start and not _is_adverb(atoms, i)]
    if len(asked) > _LONG:
        asked = _not_seen_nearby(asked, atoms, read)
    for i, changed in asked:
        try:
            other = read([*atoms[:i], changed, *atoms[i + 1 :]])
        except Unclear:
            continue  # it matters
        if list(other) == list(steps):
            raise Unclear("unclear_motion", atoms[i].text)


def _check_clauses(
    atoms: Sequence[Atom], steps: Sequence[Step], read: Callable[[list[Atom]], Sequence[Step]]
) -> None:
    """Ask back where a clause can be left out for nothing: one that names a motion alone, or says what comes then."""
    breaks = [-1, *(i for i, a in enumerate(atoms) if a.kind in ("sep", "conn")), len(atoms)]
    if not 3 <= len(breaks) <= _LONG:
        return
    for before, end in itertools.pairwise(breaks):
        inside = atoms[before + 1 : end]
        others = [a for i, a in enumerate(atoms) if not before < i < end and a.kind not in SILENT]
        if not others or not (_comes_next(atoms, before, inside) or _is_only_named(inside, atoms, others)):
            continue
        try:
            other = read([*atoms[: before + 1], *atoms[end:]])
        except Unclear:
            continue
        if list(other) == list(steps):
            raise Unclear("unclear_motion", " ".join(a.text for a in inside))


def _comes_next(atoms: Sequence[Atom], before: int, inside: Sequence[Atom]) -> bool:
    """`…, then forward 1 m`: a motion in full behind a word for what comes then."""
    if before < 0 or (atoms[before].kind, atoms[before].value) != ("conn", "then"):
        return False
    told = any(a.kind == "q" and a.value in _EXTENTS for a in inside) and any(a.kind == "dir" for a in inside)
    figures = sum(
        a.kind == "shape" for a in atoms
    )  # `a figure eight, a circle to the left and then …` says it twice
    return told and figures < 2 and not any(a.value == "each" for a in atoms)


def _is_only_named(inside: Sequence[Atom], atoms: Sequence[Atom], others: Sequence[Atom]) -> bool:
    """Whether it says what to do by a verb alone, and nobody says it again: `wait, wait 2 s`, 掉个头，左转180度."""
    doing = {a.value for a in inside if a.kind == "verb"} & _DOINGS
    if not doing or any(_changed(a, atoms) for a in inside):
        return False
    if doing == {"uturn"} and any(a.value == "angle" and math.isclose(a.number, math.pi) for a in others):
        return False
    doing |= _ABOUT if doing & _ABOUT else set()
    return not any((a.kind == "verb" and a.value in doing) or a.value in _RETURNING for a in others)


def _check_each(atoms: Sequence[Atom], steps: Sequence[Step]) -> None:
    """Ask back where `80 cm each` is one drive: each of what?"""
    each = next((atom for atom in atoms if (atom.kind, atom.value) == ("flag", "each")), None)
    if each is not None and [*map(type, steps)] == [Drive]:
        raise Unclear("unclear_motion", each.text)


def _check_no_turn(atoms: Sequence[Atom], steps: Sequence[Step]) -> None:
    """Ask back where it turns or bends though it is said not to: 原地别转半圈, `diagonal, forwards and right`."""
    denied = next((a for a in atoms if a.kind == "flag" and a.value in ("no_turn", "diagonal")), None)
    told = any(
        atom.kind in ("verb", "dir", "rot", "shape") or (atom.kind == "q" and atom.value not in _TURNED)
        for atom in atoms
    )
    bends = any(isinstance(step, Arc) for step in steps)
    turns = any(isinstance(step, Turn) for step in steps) and not told
    if denied is not None and (bends or (turns and denied.value == "no_turn")):
        raise Unclear("unclear_motion", denied.text)


def _check_sides(atoms: Sequence[Atom], steps: Sequence[Step]) -> None:
    """Ask back where a figure bends to one side only though both are named: `two circles, one left one right`."""
    ways = [atom for atom in atoms if atom.kind in ("dir", "rot") and atom.value in _OTHER_SIDE]
    drawn = any(atom.kind == "shape" for atom in atoms) and all(
        isinstance(s, (Drive, Turn, Arc)) for s in steps
    )
    bends = {step.left for step in steps if isinstance(step, (Turn, Arc))}
    slides = any(isinstance(step, Drive) and math.sin(step.direction_rad) for step in steps)
    if drawn and len({atom.value for atom in ways}) == 2 and len(bends) == 1 and not slides:
        raise Unclear("unclear_motion", ways[-1].text)
    slid = [step.direction_rad > 0 for step in steps if isinstance(step, Drive) and is_sideways(step)]
    if (
        drawn
        and len({*slid}) == 2
        and len({a.value for a in ways}) == 2
        and slid[0] != (ways[0].value == "left")
    ):
        raise Unclear("unclear_motion", ways[0].text)  # `sideways: forward, right, back, left`


def _check_flags(
    atoms: Sequence[Atom],
    steps: Sequence[Step],
    read: Callable[[list[Atom]], Sequence[Step]],
    *,
    follows: bool,
) -> None:
    """Ask back where a word for a way of doing it, for once more or several times, can be left out for nothing."""
    for i, atom in enumerate(atoms):
        if not (_must_matter(atoms, i) or (follows and _is_whole_told(atoms, i))):
            continue
        try:
            other = read([a for at, a in enumerate(atoms) if at != i and not _is_same_word(atoms, i, at)])
        except Unclear:
            continue
        if list(other) == list(steps):
            raise Unclear("unclear_motion", atom.text)


def _must_matter(atoms: Sequence[Atom], i: int) -> bool:
    """Whether the flag at `i` says something that no other word says, too."""
    flag = atoms[i].value
    others = [atom for at, atom in enumerate(atoms) if at != i]
    if atoms[i].kind == "dir":  # 倒着走一个正方形
        turns = not any(atom.value in ("no_turn", "sideways") for atom in others)
        return flag == "back" and turns and any(atom.kind == "shape" for atom in others)
    if atoms[i].kind == "pace":
        return any(atom.kind == "defined" for atom in others)
    if atoms[i].kind != "flag":
        return False
    if flag == "sideways" and any(atom.value == "again" for atom in others):
        return not any(atom.value in _OTHER_SIDE for atom in others)
    if flag == "again":
        return _repeats_what_is_told(atoms, i)
    if flag == "diagonal":  # `diagonally to the front left`
        return not any(atom.kind in ("dir", "shape") and "_" in atom.value for atom in others)
    ways = {atom.value for atom in others if atom.kind == "dir"}
    if flag == "trip" and (ways >= {"forward", "back"} or ways >= {"left", "right"}):
        return False  # `to and fro: a metre ahead, a metre back`
    if flag in _WAYS_OF_DOING:
        return not any(atom.value == flag for atom in others)
    drawn = any(atom.kind in ("shape", "role", "counter") or atom.value == "curve" for atom in others)
    if flag == "all" and (
        sum(atom.kind == "q" for atom in others) > 1 or {a.value for a in others} <= {"again", "extra"}
    ):
        return False  # 全部再来一次: which turns, dialogue.py asks
    if flag != "until" and any(atom.value == "total" for atom in others):
        return False
    if flag == "each" and is_kind(atoms, i + 1, "q", "times"):  # 前进一米后退一米各三次
        return sum(atom.kind == "q" for atom in others) > 2
    return flag in _OF_SEVERAL and not drawn and not any({a.value, a.role} & _COUNTED for a in others)


def _is_whole_told(atoms: Sequence[Atom], i: int) -> bool:
    """总共左转九十度, after a turn: whether one amount is told that may be meant with what was done."""
    amounts = [atom for atom in atoms if atom.kind == "q"]
    bound = any(atom.value == "short_of" for atom in atoms)
    return (atoms[i].kind, atoms[i].value) == ("flag", "total") and len(amounts) == 1 and not bound


def _repeats_what_is_told(atoms: Sequence[Atom], i: int) -> bool:
    """走一个正方形，然后原样再来: once more what stands before it, and not how often or what else."""
    told = any(a.kind == "shape" or (a.kind == "q" and a.value in _EXTENTS) for a in atoms[:i])
    told = told or sum(a.kind == "verb" for a in atoms[i + 1 :]) > 1  # 刚才那个先左转再前进
    others = (a for at, a in enumerate(atoms) if at != i and not _is_same_word(atoms, i, at))
    bound = any(a.value in ("again", "extra", "times", "other_way", "same_amount") for a in others)
    return told and not bound and is_chinese(atoms[i].text)


def _is_same_word(atoms: Sequence[Atom], i: int, at: int) -> bool:
    """Whether the atom at `at` is another meaning of the word at `i`."""
    return at == i + 1 and atoms[i].kind == "flag" and atoms[at] == atoms[i]._replace(value="extra")


def _not_seen_nearby(
    asked: Sequence[tuple[int, Atom]], atoms: Sequence[Atom], read: Callable[[list[Atom]], Sequence[Step]]
) -> list[tuple[int, Atom]]:
    """The first change in each kind of clause, and those that change nothing in the clauses around them."""
    breaks = [-1, *(i for i, a in enumerate(atoms) if a.kind in ("sep", "conn")), len(atoms)]
    kinds = [(a.kind, a.value, "" if a.kind == "q" else a.text) for a in atoms]
    seen: set[object] = set()
    left = []
    for i, changed in asked:
        at = bisect.bisect_left(breaks, i)
        clause = kinds[breaks[at - 1] + 1 : breaks[at]]
        around = range(breaks[max(at - 1 - _AROUND, 0)] + 1, breaks[min(at + _AROUND, len(breaks) - 1)])
        known = (i - breaks[at - 1], tuple(clause))
        nearby = (i - around.start, tuple(kinds[around.start : around.stop]))
        if known in seen and (nearby in seen or _changes(list(atoms), i, changed, around, read)):
            seen.add(nearby)
            continue
        seen.add(known)
        left.append((i, changed))
    return left


def _changes(
    atoms: list[Atom], i: int, changed: Atom, around: range, read: Callable[[list[Atom]], Sequence[Step]]
) -> bool:
    """Whether the plan of the clauses around atom `i` is another one with `changed` in its place."""
    try:
        steps = list(read(atoms[around.start : around.stop]))
        return list(read([*atoms[around.start : i], changed, *atoms[i + 1 : around.stop]])) != steps
    except Unclear:
        return False


def _is_adverb(atoms: Sequence[Atom], i: int) -> bool:
    """`straight forward`: no way of its own."""
    return atoms[i].text.endswith("straight") and i + 1 < len(atoms) and atoms[i + 1].kind == "dir"


def _changed(atom: Atom, atoms: Sequence[Atom]) -> Atom | None:
    """`atom` as it would have been had something else been said; None where it may be said for nothing."""
    if atom.kind == "q" and atom.value in _AMOUNTS:
        return quantity(atom.value, atom.number * _CHANGE, atom.text, atom.role)
    drawn = any(other.kind in ("shape", "role") for other in atoms)  # a shape may name a side for looks
    if not drawn and (counted := _counted_otherwise(atom, atoms)) is not None:
        return counted
    if not drawn and atom.kind == "rot" and atom.value in _OTHER_SIDE:
        return atom._replace(value=_OTHER_SIDE[atom.value])
    if atom.kind != "dir" or atom.value not in _OPPOSITE or atom.text.endswith("of you"):
        return None
    twice = sum(other.kind == "dir" and other.value == atom.value for other in atoms) > 1
    return None if drawn or twice else atom._replace(value=_OPPOSITE[atom.value])


def _counted_otherwise(atom: Atom, atoms: Sequence[Atom]) -> Atom | None:
    """A count or an angle changed; `the third turn` and the half turn of a U-turn only tell it again."""
    if atom.kind != "q" or any((other.kind, other.value) == ("verb", "uturn") for other in atoms):
        return None
    if atom.value in ("times", "count") and atom.role != "move":  # 走两下: a little
        return quantity(atom.value, atom.number + 1.0, atom.text, atom.role)
    if atom.value in ("angle", "turns") and not atom.text.startswith(("third", "second", "first", "fourth")):
        return quantity(atom.value, atom.number * _CHANGE, atom.text, atom.role)
    if atom.value == "number" and atom.number > 2:
        return quantity(atom.value, atom.number + 15.0, atom.text, atom.role)
    return None
