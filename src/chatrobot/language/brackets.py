"""`Forward 1 m, (left 90, forward 50 cm) twice`, `…, then twice: left 90, forward 50 cm`: repeated as one."""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.language.tokens import Atom

_THEN = Atom("conn", "then", "")
_CONTENT = ("verb", "dir", "rot", "q", "shape", "place")
_MOVING = ("verb", "dir", "rot", "shape")
_MOST = 20


def unrolled(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with a counted group in the midst of a sentence, in brackets or after a colon, written out so often."""
    return _after_colon(atoms) or _in_brackets(atoms) or list(atoms)


def _after_colon(atoms: Sequence[Atom]) -> list[Atom]:
    """What a count announces after other motions, up to `. Then …`; none where it announces none."""
    for i, atom in enumerate(atoms):
        at = _announced_from(atoms, i - 1)
        counted = (atom.kind, atom.value) == ("sep", "colon") and 1 < _times(atoms, i - 1) <= _MOST
        if not counted or not at or atoms[at - 1].kind not in ("sep", "conn"):
            continue
        ends = (k for k in range(i + 1, len(atoms) - 1) if _ends_loop(atoms[k], atoms[k + 1]))
        end = next(ends, len(atoms))
        inside, before = atoms[i + 1 : end], atoms[:at]
        if any(a.kind in _MOVING for a in inside) and any(a.kind in _CONTENT for a in before):
            return _written_out(before, inside, _times(atoms, i - 1), atoms[end:])
    return []


def _in_brackets(atoms: Sequence[Atom]) -> list[Atom]:
    """A counted group in brackets; none where there is none."""
    opening = next((i for i, a in enumerate(atoms) if _is(a, "(")), len(atoms))
    closing = next((i for i in range(opening, len(atoms)) if _is(atoms[i], ")")), None)
    if closing is None or not any(a.kind in ("sep", "conn") for a in atoms[opening + 1 : closing]):
        return []
    before, count, after = atoms[:opening], _times(atoms, closing + 1), atoms[closing + 1 :]
    if count:
        after = atoms[closing + 2 :]
    else:
        at = opening - 1
        while at >= 0 and (atoms[at].kind, atoms[at].value) in (("sep", "colon"), ("flag", "again")):
            at -= 1
        count, before = _times(atoms, at), before[: _announced_from(atoms, max(at, 0))]
    if not 1 < count <= _MOST or not any(a.kind in _CONTENT for a in before):
        return []
    return _written_out(before, atoms[opening + 1 : closing], count, after)


def _written_out(
    before: Sequence[Atom], inside: Sequence[Atom], count: int, after: Sequence[Atom]
) -> list[Atom]:
    rounds = [atom for _ in range(count) for atom in (_THEN, *inside)]
    return [*before, *rounds, _THEN, *after]


def _announced_from(atoms: Sequence[Atom], at: int) -> int:
    """Where what announces a count begins: `do the following` three times."""
    while at > 0 and (
        atoms[at - 1].kind in ("glue", "filler")
        or (atoms[at - 1].kind, atoms[at - 1].value) in (("flag", "again"), ("verb", "make"))
    ):
        at -= 1
    return at


def _ends_loop(mark: Atom, after: Atom) -> bool:
    is_end = (mark.kind, mark.value) == ("sep", "strong")
    return is_end and ((after.kind, after.value) == ("conn", "then") or after.value == "finally")


def _is(atom: Atom, written: str) -> bool:
    return atom.kind == "sep" and atom.text == written


def _times(atoms: Sequence[Atom], i: int) -> int:
    """How often, where a whole number of times stands at `i`; else 0."""
    said = 0 <= i < len(atoms) and atoms[i].kind == "q" and atoms[i].value == "times"
    whole = said and math.isfinite(atoms[i].number) and atoms[i].number.is_integer()
    return int(atoms[i].number) if whole else 0
