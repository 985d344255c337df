"""A plan that waits for a `go`: what is said of it before changes it or asks about it, and never moves.

A plan that was asked about (“did you mean …?”) is changed alike. The words are `data/<code>/held.toml`. What changes a
plan is read back, and waits anew; what is not understood ends it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from chatrobot.language.answers import with_manner
from chatrobot.language.command import of_before, read_command
from chatrobot.language.data_files import load_table
from chatrobot.language.dialogue import refer
from chatrobot.language.earlier_turns import answer_to_question
from chatrobot.language.edit_words import Edit
from chatrobot.language.edits import scaled
from chatrobot.language.frames import DIRECTIONS, SIDES
from chatrobot.language.interpretation import Interpretation, asked_back
from chatrobot.language.inverse import is_sideways
from chatrobot.language.last_motion import in_unit_before, laps, said_unit_m
from chatrobot.language.normalise import normalise
from chatrobot.language.part_changed import as_if_done
from chatrobot.language.phrases import describe_steps, say
from chatrobot.language.proposals import proposed
from chatrobot.language.reading import Reading, frames_of
from chatrobot.language.resizing import resized
from chatrobot.language.rules import form, forms
from chatrobot.language.starting import without_hold
from chatrobot.language.step_kinds import places_of
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import once_of
from chatrobot.plan.steps import Arc, Drive, Plan, Step, Turn

_BESIDE = frozenset({"filler", "glue", "sep", "correction"})
_BESIDE_FLAGS = frozenset({"instead", "short_of"})
_CHANGING = frozenset(
    {"other_way", "mirrored", "reverse", "swapped", "leave_out", "scale", "fold", "percent"}
)
"""Words that change a motion and are none of their own."""
_NAMING = ("part", "sole", "each", "dropped", "only")
"""Forms of `held.toml` that name a part of the plan."""
ReadAnew = Callable[[str], Interpretation]


def changed(plain: str, plan: Plan, reading: Reading, read_anew: ReadAnew) -> list[Step] | None:
    """The steps of the plan as a normalised text wants them; None where it changes none of them.

    Args:
        read_anew: reads a motion of its own.

    Raises:
        Unclear: the plan has no such part, or several that could be meant.
    """
    in_part = changed_in_part(plain, plan, reading, read_anew)
    plain = plain.rpartition("? ")[2]
    is_instead = form(reading.language, "held", "instead").search(plain) is not None
    return in_part or (changed_by_motion(plain, plan, reading, read_anew) if is_instead else None)


def changed_by_motion(plain: str, plan: Plan, reading: Reading, read_anew: ReadAnew) -> list[Step] | None:
    """The steps of the plan with a motion that a normalised text says instead; None where it says none.

    Raises:
        Unclear: the plan has no such part, or several that could be meant.
    """
    own = read_anew(plain)
    return _in_place(own.plan.steps, [*plan.steps], plain, reading) if own.plan is not None else None


def adds(plain: str, reading: Reading) -> bool:
    """Whether a normalised text says what comes after a plan: `and then back 20 cm`."""
    return _said("added", plain, reading) is not None


def names_part(plain: str, reading: Reading) -> bool:
    """Whether a normalised text names a part of a plan: `the second drive`."""
    return any(_said(name, plain, reading) for name in _NAMING)


def is_no_order(plain: str, reading: Reading) -> bool:
    """Whether a normalised text names a part of a plan, or an amount or a way alone: both together are an order."""
    if names_part(plain, reading):
        return True
    kinds = {atom.kind for atom in reading.atoms(plain) if atom.kind != "q" or atom.value in _SIZES}
    return not ("q" in kinds and kinds & {"dir", "rot"}) and not kinds & {"verb", "shape", "place"}


def changed_in_part(plain: str, plan: Plan, reading: Reading, read_anew: ReadAnew) -> list[Step] | None:
    """The steps of the plan with another amount, way or part; None where a normalised text is no such change.

    Raises:
        Unclear: the plan has no such part, or several that could be meant.
    """
    if plain.rstrip().endswith("?"):
        return None
    plain = plain.rpartition("? ")[2]  # `class, is that too far? make it one`
    steps = list(plan.steps)
    named = _said("part", plain, reading) or _said("sole", plain, reading)
    if named is not None:
        return _with_part(named, steps, reading, read_anew)
    each = _said("each", plain, reading)
    if each is not None:
        at = places_of(steps, each["sole"], reading.language)
        every = [_of_one(each["new"], [s], reading) if i in at else [s] for i, s in enumerate(steps)]
        if any(part is None for part in every):
            raise Unclear("unclear_motion", each["new"])
        return [step for part in every for step in part or ()]
    for name in ("dropped", "only"):
        found = _said(name, plain, reading)
        if found is not None:
            at = _chosen(found, steps, plain, reading.language)
            kept = [step for i, step in enumerate(steps) if (i in at) == (name == "only")]
            if not kept:
                raise Unclear("all_left_out", plain[:60])
            return kept
    found = _said("added", plain, reading)
    ways = (
        [atom for atom in reading.atoms(found["new"]) if atom.kind not in SILENT] if found is not None else []
    )
    for change in (_of_one, _of_last) if not any(a.kind in ("dir", "rot", "verb") for a in ways) else ():
        new = change(plain, steps, reading)
        if new is not None:
            return new
    if len(ways) == 1 and ways[0].kind != "q":  # `and back`: how far?
        raise Unclear("how_far", plain[:60])
    return [*steps, *_steps(read_anew(found["new"]))] if found is not None else None


def _in_place(own: Sequence[Step], steps: list[Step], plain: str, reading: Reading) -> list[Step]:
    """What is meant instead: a motion of its own; without an amount it is the side of the one that takes it.

    Raises:
        Unclear: it is less than a motion, and several could be meant.
    """
    whole = len(own) > 1 or len(steps) == 1 or form(reading.language, "held", "instead_of_all").search(plain)
    if any(atom.kind in ("q", "shape", "place") for atom in reading.atoms(plain)):
        if whole:
            return list(own)
        raise Unclear("unclear_motion", plain[:60])  # instead of all of it, or of one step?
    at = [i for i, step in enumerate(steps) if len(own) == 1 and type(step) is type(own[0])]
    if len(at) != 1:
        raise Unclear("unclear_motion", plain[:60])
    return [*steps[: at[0]], _on_the_way_of(own[0], steps[at[0]]), *steps[at[0] + 1 :]]


def _on_the_way_of(new: Step, old: Step) -> Step:
    """The old step on the way of one that is said without an amount; the new one where it is of another kind."""
    if isinstance(old, Turn) and isinstance(new, Turn):
        return replace(old, left=new.left)
    if isinstance(old, Drive) and isinstance(new, Drive):
        return replace(old, direction_rad=new.direction_rad)
    return new


def is_taken_back(plain: str, language: str) -> bool:
    """Whether a normalised text takes the whole plan back: `actually, skip it`."""
    return any(one.fullmatch(plain.strip()) for one in forms(language, "held", "void"))


def may_be_change(plain: str, language: str) -> bool:
    """Whether a normalised text has words that deny or bound a part of the plan: `only forward`."""
    return form(language, "held", "limits").search(plain) is not None


def answered(plain: str, steps: tuple[Step, ...], reading: Reading) -> Interpretation | None:
    """What a text asks of the steps of a plan: `what is step two?`; None where it asks nothing of them.

    Raises:
        Unclear: there is no such step.
    """
    found = _said("asked", plain, reading)
    if found is None or not steps:
        return None
    language, named = reading.language, any(found.values())
    at = _chosen(found, list(steps), plain, language) if named else list(range(len(steps)))
    code = "answer_step" if named and len(at) == 1 else "answer_plan"
    text = describe_steps([steps[i] for i in at], language)
    return Interpretation("answered", say(language, code, n=at[0] + 1, text=text), language)


def answered_late(plain: str, reading: Reading) -> Interpretation | None:
    """What completes an order that was to wait and was asked back: it waits still; None for any other text.

    `Turn 90 when I say so`, then `left`.
    """
    dialogue, language = reading.context.dialogue, reading.language
    rest = without_hold(normalise(dialogue.pending), language) if dialogue.pending else ""
    if not rest or any(atom.kind in ("verb", "shape", "place", "defined") for atom in reading.atoms(plain)):
        return None
    context = replace(reading.context, dialogue=replace(dialogue, pending=rest))
    try:
        found = answer_to_question(plain, replace(reading, context=context))
        if found is not None:
            return proposed(found, language, code="held") or found
        moves = read_command(plain, reading).plan is not None
    except Unclear:
        return None
    return asked_back(Unclear("not_done_before", dialogue.pending[:60]), language) if moves else None


def _with_part(said: dict[str, str], steps: list[Step], reading: Reading, read_anew: ReadAnew) -> list[Step]:
    part = said["new"]
    at = _chosen(said, steps, part, reading.language)
    if len(at) != 1:
        raise Unclear("unclear_motion", part)
    new = _of_one(part, [steps[at[0]]], reading)
    if new is None:
        new = _steps(read_anew(part))
        if len(new) == 1 and not any(atom.kind == "q" for atom in reading.atoms(part)):
            new = [_on_the_way_of(new[0], steps[at[0]])]
    return [*steps[: at[0]], *new, *steps[at[0] + 1 :]]


def _steps(found: Interpretation) -> list[Step]:
    if found.plan is None:
        raise Unclear(found.code or "unknown_part", found.unaccounted)
    return list(found.plan.steps)


def _chosen(said: dict[str, str], steps: list[Step], plain: str, language: str) -> list[int]:
    """Where the parts stand that are named.

    Raises:
        Unclear: there are no such parts, or more than are named.
    """
    table = load_table(language, "selections")
    at = places_of(steps, said["kind"] or said["named"] or said["sole"], language)
    word = said["nth"] or said["n"]
    numbers = {**table["numbers"], **table["ordinals"]}
    nth = int(word) if word.isdecimal() else numbers.get(word, 0)
    if word:
        return _at(at, nth, plain)
    if not at or (len(at) > 1 and said["sole"] not in table["plurals"]):
        raise Unclear("unclear_motion", plain[:60])
    return at


def _at(at: list[int], nth: int, plain: str) -> list[int]:
    n = nth - 1 if nth > 0 else len(at) + nth
    if not nth or not 0 <= n < len(at):
        raise Unclear("nothing_before", plain[:60])
    return [at[n]]


def _of_one(plain: str, steps: list[Step], reading: Reading) -> list[Step] | None:
    """The steps with the amount, side or speed that is all a text says; None where it says anything else.

    Raises:
        Unclear: several of them could take it, or none.
    """
    found = _said("bare", plain, reading)
    atoms = _affirmed(reading.atoms(found["new"] if found else plain))
    if not atoms or any(
        atom.kind not in ("q", "dir", "rot", "pace") or atom.value in _CHANGING for atom in atoms
    ):
        return None
    if any(atom.kind == "pace" or atom.value in ("speed", "rate", "percent", "faster") for atom in atoms):
        paced = with_manner(Plan(tuple(steps)), plain, reading)
        return list(paced.steps) if paced is not None else None
    for atom in atoms:
        steps = _with_amount(steps, atom, reading) if atom.kind == "q" else _with_way(steps, atom)
    return steps


def _affirmed(atoms: list[Atom]) -> list[Atom]:
    """What is said, without what is denied: `forward, not back`."""
    out: list[Atom] = []
    said = [a for a in atoms if a.kind not in _BESIDE and not (a.kind == "flag" and a.value in _BESIDE_FLAGS)]
    denied = False
    for atom in said:
        if atom.kind == "negation":
            denied = True
        elif denied:
            denied = False
        else:
            out.append(atom)
    return [] if denied else out


def _with_amount(steps: list[Step], size: Atom, reading: Reading) -> list[Step]:
    if size.value == "times" and size.number in range(1, 21):
        drives = any(isinstance(step, (Drive, Arc)) for step in steps)
        is_closed = drives and len(steps) > 1 and laps(steps, 1) is not None  # a square, not its sides
        return (steps if is_closed else steps[: once_of(steps)]) * int(size.number)  # `no, three times`
    if size.value == "number" and size.number < 1.0 and not any(map(str.isdigit, size.text)):
        if size.number <= 0.0 or len(steps) != 1 or not isinstance(steps[0], (Drive, Turn)):
            raise Unclear("unclear_motion", size.text)  # half of which of them, or of its radius?
        return [scaled(steps[0], size.number)]  # `yes, but only half`
    turns = reversed(reading.context.dialogue.turns)
    unit_m = next((unit for unit in (said_unit_m(turn.text) for turn in turns) if unit), 0.0)
    if len(steps) == 1:
        size = in_unit_before(size, steps[0], unit_m)
    changed = resized(steps, Edit(amounts=[size])) if size.value in _SIZES else None
    if changed is None:
        raise Unclear("unclear_motion", size.text)
    return changed


_SIZES = frozenset({"length", "angle", "turns", "time"})


def _with_way(steps: list[Step], way: Atom) -> list[Step]:
    """One step, or the one that turns where that is what has a side, the other way.

    Raises:
        Unclear: several could be meant, or the way fits none.
    """
    at = [i for i, step in enumerate(steps) if _has_way(step, way.value)]
    turns = {step for step in steps if isinstance(step, Turn)}
    if len(turns) == 1 and len(at) > 2 and way.value in SIDES:  # a square: all of it goes round the other way
        return [replace(s, left=way.value == "left") if isinstance(s, Turn) else s for s in steps]
    if len(at) != 1 or (len(steps) > 1 and way.value not in SIDES):
        raise Unclear("unclear_motion", way.text)
    step, out = steps[at[0]], list(steps)
    if isinstance(step, (Turn, Arc)):
        out[at[0]] = replace(step, left=way.value == "left")
    elif isinstance(step, Drive):
        out[at[0]] = replace(step, direction_rad=DIRECTIONS[way.value])
    return out


def _has_way(step: Step, way: str) -> bool:
    if isinstance(step, (Turn, Arc)):
        return way in SIDES
    return isinstance(step, Drive) and way in DIRECTIONS and is_sideways(step) == (way in SIDES)


def _of_last(plain: str, steps: list[Step], reading: Reading) -> list[Step] | None:
    """`Mirror it`, `the other way round`: what changes a motion that was done changes one that waits.

    Raises:
        Unclear: it does not fit that motion.
    """
    atoms = reading.atoms(plain)
    if not any(atom.value in _CHANGING for atom in atoms if atom.kind in ("flag", "q", "order")):
        return None
    said = next(
        (turn.text for turn in reversed(reading.context.dialogue.turns) if turn.outcome == "unclear"), ""
    )
    context = as_if_done(steps, said, reading.context)
    hypothetical = replace(reading, context=context)
    return of_before(plain, atoms, hypothetical) or refer(frames_of(atoms), context, reading.pace)


def _said(name: str, plain: str, reading: Reading) -> dict[str, str] | None:
    """What a text that is wholly one of these forms says in each of its gaps."""
    said = (one.fullmatch(plain.strip()) for one in forms(reading.language, "held", name))
    found = next(filter(None, said), None)
    gaps = dict.fromkeys(("nth", "kind", "named", "n", "sole", "new"), "")
    return {**gaps, **{k: v or "" for k, v in found.groupdict().items()}} if found else None
