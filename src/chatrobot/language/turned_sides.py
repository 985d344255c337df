"""Sides behind a verb that a longer phrase has taken: `turn left and forward 1 m`, `could you turn right?`."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.frames import DIAGONALS, TURN
from chatrobot.language.lexicon import lexicon
from chatrobot.language.tokens import Atom

_SIDED = frozenset({*TURN, "slide", "shift", "go"})
_LIGHT = frozenset({"glue", "filler"})


def with_turned_sides(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with such phrases taken apart: a turn has no diagonal, and `turn right?` no `right?` that asks."""
    out: list[Atom] = []
    for atom in atoms:
        verb = next((a for a in reversed(out) if a.kind not in _LIGHT), None)
        out += _parts(atom, verb.value) if verb is not None and verb.kind == "verb" else [atom]
    return out


def _parts(atom: Atom, verb: str) -> list[Atom]:
    words = atom.text.split()
    said = [_way(word) or _conn(word) for word in words]
    is_diagonal = atom.kind == "dir" and atom.value in DIAGONALS.values()
    if is_diagonal and verb in TURN and len(words) > 2 and all(said):
        return [part for part in said if part is not None]
    side = said[0] if said else None
    if (
        atom.kind == "filler"
        and verb in _SIDED
        and words[-1] == "?"
        and side is not None
        and side.kind == "dir"
    ):
        return [side, Atom("sep", "strong", "?")]
    return [atom]


def _way(word: str) -> Atom | None:
    return next(
        (Atom("dir", value, word) for kind, value in lexicon().words.get((word,), ()) if kind == "dir"), None
    )


def _conn(word: str) -> Atom | None:
    return next(
        (Atom("conn", value, word) for kind, value in lexicon().words.get((word,), ()) if kind == "conn"),
        None,
    )
