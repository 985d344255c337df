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
    said = [part for part in map(_way_or_joint, words) if part is not None]
    is_diagonal = atom.kind == "dir" and atom.value in DIAGONALS.values()
    if is_diagonal and verb in TURN and len(words) > 2 and len(said) == len(words):
        return said
    asks = atom.kind == "filler" and words[-1:] == ["?"]
    if asks and verb in _SIDED and said and said[0].text == words[0] and said[0].kind == "dir":
        return [said[0], Atom("sep", "strong", "?")]
    return [atom]


def _way_or_joint(word: str) -> Atom | None:
    meanings = lexicon().words.get((word,), ())
    return next((Atom(kind, value, word) for kind, value in meanings if kind in ("dir", "conn")), None)
