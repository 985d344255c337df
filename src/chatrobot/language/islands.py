"""The order in a text that the rules do not cover: only what says motion is read, and all else is passed over.

An island parser: each clause that tells an amount is kept, with the words of motion in it, in their order; a clause that
only says which way or how is kept beside one. Whatever denies, bounds, doubts or puts right what is kept ends the search,
and so does an amount that plays no part in the steps. What is found is proposed, never done.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from chatrobot.language.acts import Read, order_log_odds, read_acts
from chatrobot.language.clauses import read_frames
from chatrobot.language.heeded import check_heeded
from chatrobot.language.names import names_in
from chatrobot.language.order import in_order
from chatrobot.language.reading import Reading
from chatrobot.language.tidy import tidy
from chatrobot.language.tokens import SILENT, Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Step

LEAST_ODDS = -1.0
"""A text with lower odds of an order is offered nothing."""
TALK_ODDS = -1.0
"""A clause with words of motion and higher odds of an order is not passed over."""
_SIZES = frozenset({"length", "angle", "turns", "time", "clock"})
_SLOTS = frozenset({"verb", "dir", "rot", "q", "pace", "shape", "role"})
_FLAGS = frozenset(
    {"in_place", "no_turn", "sideways", "each", "diagonal", "bearing", "after_each", "between", "while"}
)
_IDLE = frozenset({"until", "more", "total", "first", "all", "bit", "closer", "again"})
"""Flags that an amount behind them makes idle: `until you've covered 2 m`."""
_ENDS = frozenset(
    {"condition", "negation", "correction", "doubt", "refuse", "operator", "place", "defined", "order"}
)
_BOUND = frozenset({"not", "condition", "later", "hypothetical"})
_TOLD = frozenset({"earlier", "did", "past", "sees"})
_MARKS = " ,.;:!?"


def island_steps(plain: str, rephrased: str, reading: Reading) -> tuple[list[Step], list[str]]:
    """The steps that the words of motion in a text say, and the parts passed over; no steps where that is not sure.

    `plain` is the text as it was normalised, `rephrased` as the rules read it.
    """
    names = names_in(reading.context)
    if order_log_odds(read_acts(plain, names)) < LEAST_ODDS:
        return [], []
    atoms: list[Atom] = []
    over: list[str] = []
    passable = frozenset({"there", "in_place", "no_turn"})
    if reading.context.dialogue.last_motion is None:
        passable |= {"again"}
    try:
        for read in read_acts(rephrased, names):
            said = rephrased[read.clause.start : read.clause.stop]
            clause = reading.atoms(said)
            kept = _kept(clause, read)
            if kept is None:
                _check_passable(clause, read, passable, follows=bool(atoms))
                over.append(said.strip(_MARKS))
            else:
                over += [atom.text for atom in clause if atom.kind == "unknown"]
                is_end = read.clause.end in tuple(".!?;\n")
                atoms += [*kept, Atom("sep", "strong" if is_end else "weak", read.clause.end)]
        return _steps(atoms, reading), over
    except Unclear:
        return [], []


def _labels(read: Read) -> set[str]:
    return {sign.label for sign in read.clause.signs}


def _check_passable(
    atoms: Sequence[Atom], read: Read, passable: frozenset[str] = frozenset(), *, follows: bool
) -> None:
    """Raises where a clause that tells no amount may bear on what is kept: `follows` says that some of that came before.

    Raises:
        Unclear: naming it.
    """
    labels = _labels(read)
    bound = labels & (_BOUND if follows else _BOUND - {"not"})
    quotes = "report" in {sign.label for sign in read.clause.signs[-2:]} and read.clause.end != "."
    flags = [atom for atom in atoms if atom.kind == "flag" and atom.value not in passable]
    does = any(atom.kind in ("verb", "dir", "rot", "shape", "pace") for atom in atoms)
    ordered = read.log_odds > TALK_ODDS and (does or flags)
    corrects = any(atom.kind in ("correction", "refuse") for atom in atoms) and follows
    if bound or quotes or ordered or corrects or read.clause.end == "?":
        raise Unclear("unknown_part", " ".join(atom.text for atom in atoms))


def _kept(atoms: Sequence[Atom], read: Read) -> list[Atom] | None:
    """What a clause says of motion; None where it tells no amount.

    Raises:
        Unclear: where something in it bears on that, and nobody knows how.
    """
    ways = any(atom.kind in ("verb", "dir", "rot", "pace") for atom in atoms)
    if not any(_is_size(atom) for atom in atoms) and not (_bare_numbers(atoms) and ways):
        bare = all(atom.kind in (*_SLOTS, *SILENT) for atom in atoms)
        slots = [atom for atom in atoms if atom.kind in _SLOTS or atom.kind == "conn"]
        return slots if bare and ways and read.log_odds > TALK_ODDS else None
    labels = _labels(read)
    bound = labels & (_BOUND | _TOLD) - ({"condition"} if any(a.value == "until" for a in atoms) else set())
    flags = [atom for atom in atoms if atom.kind == "flag" and atom.value not in _FLAGS | _IDLE]
    quotes = "report" in labels and "mine" not in labels
    if bound or flags or quotes or any(atom.kind in _ENDS for atom in atoms):
        raise Unclear("unknown_part", " ".join(atom.text for atom in atoms))
    kinds = (*_SLOTS, "conn", "sep", "flag", "letter")
    return [atom for atom in _mended(atoms) if atom.kind in kinds and (atom.kind, atom.value) not in _IDLE_ATOMS]


_IDLE_ATOMS = frozenset(("flag", value) for value in _IDLE)


def _is_size(atom: Atom) -> bool:
    return atom.kind == "shape" or (atom.kind == "q" and atom.value in _SIZES)


def _bare_numbers(atoms: Sequence[Atom]) -> list[Atom]:
    return [atom for atom in atoms if (atom.kind, atom.value) == ("q", "number")]


def _mended(atoms: Sequence[Atom]) -> Iterator[Atom]:
    """The atoms; a bare number beside a side is degrees.

    Raises:
        Unclear: for any other bare number.
    """
    for i, atom in enumerate(atoms):
        if (atom.kind, atom.value) != ("q", "number"):
            yield atom
            continue
        beside = (*atoms[max(i - 1, 0) : i], *atoms[i + 1 : i + 2])
        sided = any(other.kind == "rot" or other.value in ("left", "right") for other in beside)
        if not (sided and 10 <= atom.number <= 720 and atom.number % 5 == 0):
            raise Unclear("no_unit", atom.text)
        yield quantity("angle", math.radians(atom.number), atom.text)


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
