"""`Forward 1 m, (left 90, forward 50 cm) twice`: what stands in brackets is repeated as one."""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.language.tokens import Atom

_THEN = Atom("conn", "then", "")
_CONTENT = ("verb", "dir", "rot", "q", "shape", "place")
_MOST = 20


def unrolled(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with a counted group in brackets, in the midst of a sentence, written out so often."""
    opening = next((i for i, a in enumerate(atoms) if _is(a, "(")), None)
    if opening is None or not any(a.kind in _CONTENT for a in atoms[:opening]):
        return list(atoms)
    closing = next((i for i in range(opening, len(atoms)) if _is(atoms[i], ")")), None)
    if closing is None:
        return list(atoms)
    inside = list(atoms[opening + 1 : closing])
    if not any(a.kind in ("sep", "conn") for a in inside):
        return list(atoms)
    before, count, after = list(atoms[:opening]), _times(atoms, closing + 1), list(atoms[closing + 1 :])
    if count:
        after = list(atoms[closing + 2 :])
    else:
        at = opening - 1
        while at >= 0 and (atoms[at].kind, atoms[at].value) in (("sep", "colon"), ("flag", "again")):
            at -= 1
        count, before = _times(atoms, at), before[: max(at, 0)]
    if not 1 < count <= _MOST or not any(a.kind in _CONTENT for a in before):
        return list(atoms)
    rounds = [atom for _ in range(count) for atom in (_THEN, *inside)]
    return [*before, *rounds, _THEN, *after]


def _is(atom: Atom, written: str) -> bool:
    return atom.kind == "sep" and atom.text == written


def _times(atoms: Sequence[Atom], i: int) -> int:
    """How often, where a whole number of times stands at `i`; else 0."""
    said = 0 <= i < len(atoms) and atoms[i].kind == "q" and atoms[i].value == "times"
    whole = said and math.isfinite(atoms[i].number) and atoms[i].number.is_integer()
    return int(atoms[i].number) if whole else 0
