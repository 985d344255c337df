"""`Stop after 2 m`, `go straight, turn left after 3 s`: an amount at which the motion said before ends or is cut."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.frames import EXTENTS, STILL
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_MOVING = ("verb", "dir", "rot", "shape", "place")
_LIGHT = ("sep", "conn", "glue", "filler")
_STOPS = ("stop", "halt", "stopping", "halting", "finish")
_THEN, _COMMA = Atom("conn", "then", ""), Atom("sep", "weak", ",")


def ended_by_amount(head: Sequence[Atom], tail: Sequence[Atom]) -> list[Atom] | None:
    """The atoms of `head after tail`, where `tail` begins with an amount alone; None where it means something else.

    Raises:
        Unclear: where the motion before says another amount itself.
    """
    amount, rest = _lone_amount(tail)
    if amount is None:
        return None
    # A comma before a delay that ends the text begins no clause of its own: `turn left, but only | after 3 s`.
    delays = amount.value == "time" and not rest
    before, clause = _cut(_without_end(list(head)) if delays else _with_stop(list(head)))
    if not any(a.kind in _MOVING for a in before):
        delayed = amount.value == "time" and any(a.kind in _MOVING and a.value not in STILL for a in clause)
        return [Atom("verb", "wait", "wait"), amount, _THEN, *clause, *rest] if delayed else None
    does = clause or _first_clause(rest)
    if not any(a.kind in _MOVING for a in does):
        return None
    after = [*clause, *rest]
    if not any(_is_extent(a) or (a.kind, a.value) == ("q", "number") for a in _cut(before)[1]):
        return [*before, amount, _THEN, *after]
    if amount.value == "time" and not clause:
        return [*before, _THEN, Atom("verb", "wait", "wait"), amount, _THEN, *after]
    if amount.value == "length" and _is_pause(does):
        return [*before, _COMMA, Atom("flag", "at_point", amount.text), amount, _COMMA, *after]
    raise Unclear("contradiction", " ".join(a.text for a in (*before, *clause, amount)))


def with_after(atoms: Sequence[Atom]) -> list[Atom]:
    """`…, and after 2 m stop`: no `and then`, for an amount follows.

    Raises:
        Unclear: where it ends with a time after which nothing is said.
    """
    if len(atoms) > 2 and _ends_open(atoms):
        raise Unclear("unclear_motion", " ".join(a.text for a in atoms[-2:]))
    out: list[Atom] = []
    for i, atom in enumerate(atoms):
        amount = i + 1 < len(atoms) and _is_extent(atoms[i + 1])
        if atom.kind == "conn" and amount and atom.text.endswith(" after"):
            out += [_COMMA, Atom("order", "after", "after")]
        else:
            out.append(atom)
    return out


def _ends_open(atoms: Sequence[Atom]) -> bool:
    """左转，但是3秒之后: to begin then, or to do something else then?"""
    time, after, at = atoms[-2], atoms[-1], len(atoms) - 3
    while at > 0 and atoms[at].kind in ("filler", "glue"):
        at -= 1
    return (time.kind, time.value, after.kind) == ("q", "time", "conn") and atoms[at].kind == "sep"


def _with_stop(head: list[Atom]) -> list[Atom]:
    """`Reverse and stop after half a metre`: here the stop, which elsewhere goes without saying, says when."""
    last = head[-1]
    if last.kind == "filler" and last.text.split()[-1] in _STOPS:
        return [*head[:-1], Atom("verb", "halt", last.text)]
    return head


def _without_end(head: list[Atom]) -> list[Atom]:
    """The atoms without the punctuation and light words at their end."""
    head = _with_stop(head)
    while head and head[-1].kind in ("sep", "glue", "filler"):
        del head[-1]
    return head


def _lone_amount(tail: Sequence[Atom]) -> tuple[Atom | None, list[Atom]]:
    """The amount that `tail` begins with, and what comes after it."""
    if not tail or not _is_extent(tail[0]):
        return None, []
    alone = len(tail) == 1 or tail[1].kind in ("sep", "conn", "verb", "dir", "rot")
    return (tail[0], _stripped(list(tail[1:]))) if alone else (None, [])


def _cut(atoms: list[Atom]) -> tuple[list[Atom], list[Atom]]:
    """What stands before the last clause, and that clause; a stop begins one of its own."""
    breaks = [i for i, a in enumerate(atoms) if a.kind == "conn" or (a.kind == "sep" and a.value != "paren")]
    at = breaks[-1] + 1 if breaks else 0
    still = next((i for i in range(at, len(atoms)) if _is_still(atoms[i])), at)
    if any(a.kind in _MOVING for a in atoms[at:still]):
        at = still
    return _stripped(atoms[:at], end=True), _stripped(atoms[at:])


def _first_clause(atoms: list[Atom]) -> list[Atom]:
    end = next((i for i, a in enumerate(atoms) if a.kind in ("sep", "conn")), len(atoms))
    return atoms[:end]


def _stripped(atoms: list[Atom], *, end: bool = False) -> list[Atom]:
    at = -1 if end else 0
    while atoms and atoms[at].kind in _LIGHT:
        del atoms[at]
    return atoms


def _is_pause(clause: Sequence[Atom]) -> bool:
    timed = any(a.kind == "q" and a.value == "time" for a in clause)
    return timed and any(map(_is_still, clause)) and not any(a.kind in ("dir", "rot") for a in clause)


def _is_still(atom: Atom) -> bool:
    return atom.kind == "verb" and atom.value in STILL


def _is_extent(atom: Atom) -> bool:
    return atom.kind == "q" and atom.value in EXTENTS
