"""`After turning left, go ahead` and `turn left before you go ahead`: clauses put in the order of doing."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.tokens import Atom

_CONTENT = ("verb", "dir", "rot", "q", "shape", "place")
_THEN = Atom("conn", "then", "")


def in_order(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with what is done first said first."""
    at = next((i for i, a in enumerate(atoms) if a.kind == "order"), None)
    if at is None:
        return list(atoms)
    word, head, tail = atoms[at], list(atoms[:at]), list(atoms[at + 1 :])
    leads = not any(a.kind in _CONTENT for a in head)
    if word.value == "after" and not leads and any(a.kind == "flag" and a.value == "first" for a in head):
        return in_order([*head, _THEN, *tail])  # `first …, after you …`: as said
    if word.value == "reverse":
        return _swapped(head, tail)
    if word.value == "preceding" and not leads and _is_told_again(head, tail):
        return tail
    end = next((i for i, a in enumerate(tail) if (a.kind, a.value) == ("flag", "finally")), None)
    if word.value == "preceding" and end and not leads:  # `A, but before that B, and at the end C`
        return [*tail[: end - 1], _THEN, *head, *tail[end - 1 :]]
    if word.value == "preceding":  # A 之前 B
        return [*tail, _THEN, *head] if not leads else list(atoms)
    if leads:
        comma = next((i for i, a in enumerate(tail) if a.kind == "sep" and a.value == "weak"), None)
        if comma is None:
            return list(atoms)
        first, second = tail[:comma], tail[comma + 1 :]
        return [*first, _THEN, *second] if word.value == "after" else [*second, _THEN, *first]
    return [*tail, _THEN, *head] if word.value == "after" else [*head, _THEN, *tail]


def _is_told_again(head: list[Atom], tail: list[Atom]) -> bool:
    """前进之前先左转，前进一米: what comes after is told in full later on."""
    ways = [a.value for a in head if a.kind == "dir"]
    later = [a.value for a in tail if a.kind == "dir"]
    if any(a.kind == "q" for a in head):
        return False
    if not ways:  # 走之前先左转，然后走一米半
        goes = [k for k, a in enumerate(tail) if a.kind == "verb" and a.value == "go"]
        return any(a.kind == "verb" and a.value == "go" for a in head) and any(
            a.kind == "q" for k in goes[:1] for a in tail[k:]
        )
    return ways[-1] in later


def _swapped(head: list[Atom], tail: list[Atom]) -> list[Atom]:
    """`In the opposite order: A, B`: the clauses from the last to the first, signs unchanged."""
    whole = tail if any(a.kind in _CONTENT for a in tail) else head
    clauses: list[list[Atom]] = [[]]
    for atom in whole:
        if atom.kind in ("sep", "conn") and atom.value != "paren":
            clauses.append([])
        else:
            clauses[-1].append(atom)
    clauses = [c for c in clauses if any(a.kind in _CONTENT for a in c)]
    out: list[Atom] = []
    for clause in reversed(clauses):
        out += [*clause, _THEN]
    return out
