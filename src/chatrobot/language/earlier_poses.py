"""`Go back to where you were before the square`: a pose that the robot had earlier in the dialogue.

The forms and their words are `data/<code>/earlier_poses.toml`. What was done there is named by a shape, by a motion
(`before the turn`), or counted back (`two moves ago`); the poses are those that were measured.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from chatrobot.core.geometry import ORIGIN, Pose, wrap_angle
from chatrobot.language.context import Dialogue
from chatrobot.language.data_files import in_full, load_table
from chatrobot.language.frames import DIRECTIONS, GO, TURN
from chatrobot.language.inverse import inverse, is_sideways
from chatrobot.language.last_motion import CURVES, atoms_said, laps, shapes_said
from chatrobot.language.leading import pose_after
from chatrobot.language.ledger import TurnRecord, Way
from chatrobot.language.rules import Form, forms_of
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.language.units import turn_nouns
from chatrobot.plan.base import rounded_angle
from chatrobot.plan.steps import Arc, Drive, Go, Step, Turn, Wait

_NAMED = ("before", "after", "at", "ago", "corner", "before_step", "after_step")


@dataclass(frozen=True)
class _Done:
    """A part of an earlier turn: the poses around it, and what was driven since it began, where that is known."""

    before: Pose
    after: Pose
    record: int
    since: Way


def names_earlier_pose(plain: str, language: str) -> bool:
    """Return whether all that a normalised text says is to go back to such a pose."""
    return _found(plain, language) is not None


def to_earlier_pose(plain: str, language: str, dialogue: Dialogue) -> list[Step] | None:
    """Return the way to the pose that a normalised text names; None where it names none.

    Straight drives since then are driven back as they were, without turning; else it goes straight to the place.

    Raises:
        Unclear: nothing of that kind was done, it could be several, or nobody knows the pose any more.
    """
    named = _found(plain, language)
    if named is None:
        return None
    kind, found = named
    table, said = load_table(language, "earlier_poses"), found.groupdict(default="")
    at, count = (_number(said.get(name, ""), table["numbers"]) for name in ("nth", "count"))
    if kind == "ago":
        done = _chosen([*_turns(dialogue)], -(count or 1), plain)
    elif "step" in kind:
        done = _chosen([*_steps_of_last(dialogue)], count, plain)
    elif kind == "corner":
        if any(name in plain for name in dialogue.places):
            return None  # a place of that name
        done = _chosen([*_corners(said.get("what", ""), dialogue)], at or -1, plain)
    else:
        done = _chosen([*_units(_in_present(said["what"], language), dialogue)], at, plain)
    lost = next((turn.lost for turn in dialogue.turns[done.record :] if turn.lost), "")
    if lost:
        raise Unclear(lost, refused=True)
    return _way_to(done, kind, dialogue)


def _number(word: str, numbers: Mapping[str, int]) -> int:
    return int(word) if word.isdecimal() else int(numbers.get(word, 0))


def _way_to(done: _Done, kind: str, dialogue: Dialogue) -> list[Step]:
    """Return the way to the place and, before something, to the heading there; straight drives are driven back."""
    if "after" in kind or kind == "corner":
        pose = done.after if "after" in kind else done.before
        return [Go(round(pose.x_m, 3) + 0.0, round(pose.y_m, 3) + 0.0, frame="odom")]  # no -0
    moved = [step for step in done.since or () if not isinstance(step, Wait)]
    straight = all(isinstance(step, Drive) and step.distance_m for step in moved)
    if straight and done.since is not None and not any(turn.walk for turn in dialogue.turns[done.record :]):
        return inverse(moved)
    x_m, y_m = round(done.before.x_m, 3) + 0.0, round(done.before.y_m, 3) + 0.0
    return [Go(x_m, y_m, rounded_angle(wrap_angle(done.before.yaw_rad), 2), frame="odom")]


def _chosen(units: Sequence[_Done], at: int, plain: str) -> _Done:
    """Return the unit by its number, else the last one, where its turn has no other.

    Raises:
        Unclear: there is none, or the turn has several.
    """
    if not units or abs(at) > len(units):
        raise Unclear("nothing_before", plain[:60])
    if at:
        return units[at - 1 if at > 0 else at]
    if sum(unit.record == units[-1].record for unit in units) > 1:
        raise Unclear("nothing_before", plain[:60])
    return units[-1]


def _found(plain: str, language: str) -> tuple[str, re.Match[str]] | None:
    for kind in _NAMED:
        for form in _forms(language, kind):
            found = form.fullmatch(plain)
            if found is not None and _names_something(found.groupdict().get("what"), language):
                return kind, found
    return None


def _names_something(what: str | None, language: str) -> bool:
    """Return whether it is a motion or a shape; what is counted back needs none."""
    atoms = atoms_said(_in_present(what, language)) if what else []
    kinds = ("verb", "shape", "dir", "rot", "flag")
    return what is None or any(a.kind in kinds or (a.kind, a.value) == ("q", "turns") for a in atoms)


@cache
def _forms(language: str, kind: str) -> tuple[Form, ...]:
    def written() -> Iterator[str]:
        table = load_table(language, "earlier_poses")
        numbers = "|".join(sorted(map(re.escape, table["numbers"]), key=len, reverse=True))
        return (in_full(form, {**table["parts"], "number": rf"(?:{numbers}|\d)"}) for form in table[kind])

    return forms_of(f"earlier_poses_{language}_{kind}", written)


def _in_present(what: str, language: str) -> str:
    """Return the words with verbs as they are listed: `turned left` is `turn left`."""
    pasts = load_table(language, "rephrase").get("wish", {}).get("pasts", {})
    verbs = {past: verb for verb, past in pasts.items()}
    return " ".join(verbs.get(word, word) for word in what.split(" "))


def _turns(dialogue: Dialogue) -> Iterator[_Done]:
    """Yield each turn that moved and was no undo."""
    for k, turn in enumerate(dialogue.turns):
        if turn.moved and turn.walk is None:
            yield _Done(turn.start_pose, turn.end_pose, k, _driven(dialogue.turns[k:]))


def _steps_of_last(dialogue: Dialogue) -> Iterator[_Done]:
    """Yield the steps of the last turn that was ordered as several."""
    last = next(
        (unit for unit in reversed([*_turns(dialogue)]) if len(dialogue.turns[unit.record].way or ()) > 1),
        None,
    )
    if last is not None:
        yield from _steps(dialogue.turns[last.record], last, None)


def _corners(shape: str, dialogue: Dialogue) -> Iterator[_Done]:
    """Yield where the robot turned on the spot, of a named shape or of all that it drove."""
    wanted = shapes_said(shape) if shape else frozenset()
    for unit in _turns(dialogue):
        turn = dialogue.turns[unit.record]
        if not shape or wanted & shapes_said(turn.text):
            way = turn.way or ()
            yield from (done for i, done in enumerate(_steps(turn, unit, None)) if isinstance(way[i], Turn))


def _units(what: str, dialogue: Dialogue) -> Iterator[_Done]:
    """Yield each part of what was done that `what` names.

    Raises:
        Unclear: a shape that was drawn beside other motions in one turn.
    """
    atoms = atoms_said(what)
    shapes = {atom.value for atom in atoms if atom.kind == "shape" or atom.value == "curve"}
    for unit in _turns(dialogue):
        way, drawn = dialogue.turns[unit.record].way or (), shapes_said(dialogue.turns[unit.record].text)
        if shapes & drawn or (shapes & CURVES and (drawn & CURVES or _is_curved(way))):
            if not (_is_curved(way) or laps(way, 1) is not None):
                raise Unclear("nothing_before", what)
            yield unit
        elif not shapes and not drawn:
            yield from _steps(dialogue.turns[unit.record], unit, atoms)


def _steps(turn: TurnRecord, unit: _Done, atoms: Sequence[Atom] | None) -> Iterator[_Done]:
    """Yield each step of a turn that is of the kind and the way that the atoms name; without them, each."""
    way = turn.way or ()
    for i, step in enumerate(way):
        ends = [pose_after(way[:n], ORIGIN) for n in (i, i + 1)]
        if (atoms is None or _is_named(step, atoms)) and None not in ends:
            before, after = (turn.start_pose.compose(pose) for pose in ends if pose is not None)
            since = (*way[i:], *unit.since[len(way) :]) if unit.since is not None else None
            yield _Done(before, after, unit.record, since)


def _is_named(step: Step, atoms: Sequence[Atom]) -> bool:
    said = {atom.value for atom in atoms if atom.kind in ("verb", "q", "flag")}
    ways = {atom.value for atom in atoms if atom.kind in ("dir", "rot") and atom.value in DIRECTIONS}
    if isinstance(step, Turn):
        turned = said & {*TURN, "turns", "uturn"} or any(atom.text in turn_nouns() for atom in atoms)
        return bool(turned) and ways <= {"left" if step.left else "right"}
    if isinstance(step, Wait):
        return bool(said & {"wait", "halt"})
    if not isinstance(step, Drive) or said & {*TURN, "turns", "uturn", "wait", "halt"}:
        return False
    aside = not said & {"slide", "sideways"} or is_sideways(step)
    return bool(said & {*GO, "slide", "sideways"} or ways) and aside and _heads(step, ways)


def _heads(step: Drive, ways: set[str]) -> bool:
    return all(abs(math.remainder(step.direction_rad - DIRECTIONS[way], math.tau)) < 1e-6 for way in ways)


def _is_curved(way: Sequence[Step]) -> bool:
    return bool(way) and all(isinstance(step, Arc) for step in way)


def _driven(turns: Sequence[TurnRecord]) -> Way:
    """Return what was driven in these turns; None where that is not known of one."""
    steps: list[Step] = []
    for turn in turns:
        if turn.moved and turn.way is None:
            return None
        steps += turn.way or ()
    return tuple(steps)
