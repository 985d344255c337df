"""`Do this three times drive a metre turn left`: what is announced to be repeated is all that follows."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.numbers import is_kind
from chatrobot.language.tokens import Atom

_LIGHT = ("filler", "glue")
_BEGINS = ("verb", "dir", "rot", "shape", "q")
_BACKWARDS = ("again", "that", "it", "once", "more", "them", "those", "both")
"""Words that point at what was said before; what follows is then another motion."""

_FORWARDS = ("following", "循环")


def with_announced(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with a colon after `do this three times`, 重复三次 and the like at the very beginning."""
    at = next((i for i, a in enumerate(atoms) if a.kind not in _LIGHT and not _announces(a)), len(atoms))
    lead, rest = atoms[:at], atoms[at + 1 :]
    counted = is_kind(atoms, at, "q", "times") and any(_announces(a) for a in lead)
    if counted and rest and _announces(rest[0]):  # `repeat twice the sequence of 1 m forward and …`
        rest = rest[1 + is_kind(rest, 1, "num", "of") :]
    if not counted or not rest or rest[0].kind not in _BEGINS:
        return list(atoms)
    if sum(a.kind == "q" for a in rest) < 2:
        return list(atoms)
    return [*atoms[: at + 1], Atom("sep", "colon", ":"), *rest]


def _announces(atom: Atom) -> bool:
    again = (atom.kind, atom.value) in (("flag", "again"), ("verb", "make")) or atom.text.endswith(_FORWARDS)
    return again and not set(atom.text.split()) & set(_BACKWARDS)
