"""The order in a text that the rules do not cover: only what says motion is read, and all else is passed over.

An island parser: each clause that tells an amount is kept, with the words of motion in it, in their order; a clause
that only says which way or how is kept beside one. Whatever denies, bounds, doubts or puts right what is kept ends the
search, and so does an amount that plays no part in the steps. What is found is proposed, never done (decision 65).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from chatrobot.language.acts import ORDER, Read, order_log_odds, read_acts
from chatrobot.language.clauses import read_frames
from chatrobot.language.data_files import relation_words
from chatrobot.language.frames import GO, SIDES, TURN
from chatrobot.language.heeded import check_heeded
from chatrobot.language.interpretation import Interpretation, planned
from chatrobot.language.names import names_in
from chatrobot.language.numbers import FAR_M
from chatrobot.language.order import in_order
from chatrobot.language.reading import Reading
from chatrobot.language.rephrase import rephrased
from chatrobot.language.strange_words import may_be_needed
from chatrobot.language.tidy import tidy
from chatrobot.language.tokens import SILENT, Atom, quantity
from chatrobot.language.unclear import STUMBLED, Unclear
from chatrobot.plan.steps import Step

LEAST_ODDS = -1.0
"""A text with lower odds of an order is offered nothing."""
LEAST_DEG, MOST_DEG = 10.0, 720.0
"""A bare number of degrees is at least and at most so many."""
TALK_ODDS = -1.0
"""A clause with words of motion and higher odds of an order is not passed over."""
_SIZES = frozenset({"length", "angle", "turns", "time", "clock"})
_SLOTS = frozenset({"verb", "dir", "rot", "q", "pace", "shape", "role"})
_FLAGS = frozenset(
    {"in_place", "no_turn", "sideways", "each", "diagonal", "bearing", "after_each", "between", "while"}
)
_IDLE = frozenset({"until", "more", "total", "first", "all", "bit", "closer", "again", "there"})
"""Flags that an amount beside them makes idle: `until you've covered 2 m`, `a quarter turn right again`."""
_PASSABLE = frozenset({"there", "in_place", "no_turn"})
_ENDS = frozenset({"condition", "negation", "correction", "doubt", "refuse", "operator", "order"}) | {
    "place", "defined", "compass"
}  # fmt: skip
_BOUND = frozenset({"not", "condition", "later", "hypothetical"})
_TOLD = frozenset({"earlier", "did", "past", "sees"})
_WAYS = frozenset({"verb", "dir", "rot", "shape", "pace"})
_MARKS = " ,.;:!?"


def read_islands(plain: str, problem: Unclear, reading: Reading) -> tuple[Interpretation, list[str]] | None:
    """What the words of motion in a normalised text say, and what was passed over; None where that is doubtful.

    `problem` is why the rules did not read it: what contradicts itself, say, is not read otherwise.
    """
    may_change = (
        reading.context.dialogue.last_motion is not None
    )  # `two more`: a bare number is of what was done
    if problem.refused or problem.code not in STUMBLED | (set() if may_change else {"no_unit"}):
        return None
    steps, passed_over = _read(plain, rephrased(plain, reading.language), reading)
    return (planned(steps, reading.language), passed_over) if steps else None


def _read(plain: str, rewritten: str, reading: Reading) -> tuple[list[Step], list[str]]:
    """The steps, and the parts passed over. `rewritten` is the text as the rules read it."""
    names = names_in(reading.context)
    if order_log_odds(read_acts(plain, names)) < LEAST_ODDS:
        return [], []
    atoms: list[Atom] = []
    over: list[str] = []
    try:
        for read in read_acts(rewritten, names):
            said = rewritten[read.clause.start : read.clause.stop]
            clause = _atoms_of(said, reading, follows=bool(atoms))
            kept = _kept(clause, read)
            if kept is None:
                _check_passable(clause, read, follows=bool(atoms))
                over.append(said.strip(_MARKS))
            else:
                unknown = [atom.text for atom in clause if atom.kind == "unknown"]
                if may_be_needed(read.clause, names) or not relation_words("words").isdisjoint(unknown):
                    return [], []
                over += unknown
                is_end = read.clause.end in tuple(".!?;\n")
                atoms += [*kept, Atom("sep", "strong" if is_end else "weak", read.clause.end)]
        return _steps(atoms, reading), over
    except Unclear:
        return [], []


def _atoms_of(clause: str, reading: Reading, *, follows: bool) -> list[Atom]:
    """The atoms of a clause. Where nothing was done or said before, `one more try` refers to nothing."""
    atoms = reading.atoms(clause)
    if follows or reading.context.dialogue.last_motion is not None or any(map(_counts, atoms)):
        return atoms
    return [atom for atom in atoms if (atom.kind, atom.value) != ("flag", "again")]


def _labels(read: Read) -> set[str]:
    return {sign.label for sign in read.clause.signs}


def _check_passable(atoms: Sequence[Atom], read: Read, *, follows: bool) -> None:
    """See that a clause without an amount may be passed over. `follows`: something that is kept came before it.

    Raises:
        Unclear: it may bear on what is kept.
    """
    bound = _labels(read) & (_BOUND if follows else _BOUND - {"not"})
    quotes = "report" in {sign.label for sign in read.clause.signs[-2:]} and read.clause.end != "."
    flags = [atom for atom in atoms if atom.kind == "flag" and atom.value not in _PASSABLE]
    does = any(atom.kind in _WAYS and atom.value not in ("halt", "make") for atom in atoms)
    ordered = read.log_odds > TALK_ODDS and (does or flags)
    refused = any(atom.kind == "refuse" or (follows and atom.kind == "correction") for atom in atoms)
    if bound or quotes or ordered or refused or any(map(_counts, atoms)) or read.clause.end == "?":
        raise Unclear("unknown_part", " ".join(atom.text for atom in atoms))


def _kept(atoms: Sequence[Atom], read: Read) -> list[Atom] | None:
    """What a clause says of motion; None where it tells no amount.

    Raises:
        Unclear: where something in it bears on that, and nobody knows how.
    """
    ways = any(atom.kind in _WAYS and atom.value not in ("halt", "make") for atom in atoms)
    if not ways and "verdict" in _labels(read) and read.log_odds < TALK_ODDS:
        return None  # `the wall is a metre off`
    if not any(_is_size(atom) for atom in atoms) and not (_bare_numbers(atoms) and ways):
        bare = all(atom.kind in (*_SLOTS, *SILENT) or atom.value in _PASSABLE for atom in atoms)
        slots = [atom for atom in atoms if atom.kind in (*_SLOTS, "conn") or atom.value == "in_place"]
        return slots if bare and ways and read.log_odds > TALK_ODDS else None
    labels = _labels(read)
    is_order = read.log_odds >= ORDER
    bound = labels & (_BOUND if is_order else _BOUND | _TOLD)
    bound -= {"condition"} if any(atom.value == "until" for atom in atoms) else set()
    flags = [atom for atom in atoms if atom.kind == "flag" and atom.value not in _FLAGS | _IDLE]
    quotes = "report" in labels and "mine" not in labels and not is_order
    if bound or flags or quotes or any(atom.kind in _ENDS for atom in atoms):
        raise Unclear("unknown_part", " ".join(atom.text for atom in atoms))
    kinds = (*_SLOTS, "conn", "sep", "letter")
    return [a for a in _mended(atoms) if a.kind in kinds or (a.kind == "flag" and a.value not in _IDLE)]


def _counts(atom: Atom) -> bool:
    """Whether it says how often, or how many times as much as something else."""
    return atom.kind == "q" and atom.value in ("times", "count", "scale", "fold", "percent")


def _is_size(atom: Atom) -> bool:
    return atom.kind == "shape" or (atom.kind == "q" and atom.value in _SIZES)


def _bare_numbers(atoms: Sequence[Atom]) -> list[Atom]:
    return [atom for atom in atoms if (atom.kind, atom.value) == ("q", "number")]


def _mended(atoms: Sequence[Atom]) -> Iterator[Atom]:
    """The atoms; a bare number is degrees beside a side or a turn, else metres, or centimetres where that would be far.

    One that counts, or numbers, what nobody knows is left out: `bay two`.

    Raises:
        Unclear: for any other bare number.
    """
    told = [atom for atom in atoms if atom.kind not in ("filler", "glue")]
    for i, atom in enumerate(told):
        if (atom.kind, atom.value) != ("q", "number"):
            yield atom
        elif "unknown" not in [other.kind for other in (*told[max(i - 1, 0) : i], *told[i + 1 : i + 2])]:
            yield _measured(atom, told, i)


def _measured(number: Atom, atoms: Sequence[Atom], at: int) -> Atom:
    """The bare number that stands `at` a place among the atoms of its clause, as an amount.

    Raises:
        Unclear: nothing beside it says what it measures.
    """
    beside = (*atoms[max(at - 1, 0) : at], *atoms[at + 1 : at + 2])
    if number.number < 1.0:
        raise Unclear("no_unit", number.text)
    sided = any(atom.kind == "rot" or atom.value in SIDES for atom in beside)
    turns = any(atom.kind == "rot" or (atom.kind == "verb" and atom.value in TURN) for atom in atoms)
    if (sided or turns) and LEAST_DEG <= number.number <= MOST_DEG:
        return quantity("angle", math.radians(number.number), number.text)
    if sided or turns or not any(atom.kind == "dir" or atom.value in GO for atom in atoms):
        raise Unclear("no_unit", number.text)
    return quantity("length", number.number * (1.0 if number.number <= FAR_M else 0.01), number.text)


def _steps(atoms: list[Atom], reading: Reading) -> list[Step]:
    """The steps of what is kept; none where it tells no amount.

    Raises:
        Unclear: where it cannot be acted on, or part of it would count for nothing.
    """

    def read(some: list[Atom]) -> list[Step]:
        return reading.steps_of_their_own(read_frames(tidy(in_order(some))))

    if not any(_is_size(atom) for atom in atoms):
        return []
    try:
        steps = read(atoms)
    except Unclear:
        atoms = list(_parted(atoms))
        steps = read(atoms)
    check_heeded(atoms, steps, read)
    return steps


def _parted(atoms: Sequence[Atom]) -> Iterator[Atom]:
    """The atoms with a mark between an amount with its way and the next amount: `45 left 50 cm`."""
    for i, atom in enumerate(atoms):
        if _is_size(atom) and i > 1 and atoms[i - 1].kind == "dir" and _is_size(atoms[i - 2]):
            yield Atom("sep", "weak", ",")
        yield atom
