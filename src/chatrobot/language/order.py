"""`After turning left, go ahead` and `turn left before you go ahead`: clauses put in the order of doing."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from chatrobot.language.after_amount import ended_by_amount, with_after
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.language.unclear import Unclear

_CONTENT = ("verb", "dir", "rot", "q", "shape", "place")
_NOTHING = SILENT | {"num"}
"""Kinds of words that say nothing to do before or after something else."""
_THEN = Atom("conn", "then", "")


def in_order(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with what is done first said first.

    Raises:
        Unclear: where a word for before or after has nothing behind it.
    """
    atoms = _first_told_last(_settled_after(with_after(atoms)))
    at = next((i for i, a in enumerate(atoms) if a.kind == "order"), None)
    if at is None:
        return list(atoms)
    word, head, tail = atoms[at], list(atoms[:at]), list(atoms[at + 1 :])
    before = [a for a in head if a.kind not in ("filler", "glue") and (a.kind, a.value) != ("sep", "weak")]
    goes_on = (before[-1].kind, before[-1].value) if before[1:] else ("", "")
    if goes_on == ("conn", "then") or (goes_on[0] in ("conn", "sep") and _leads_to_order(tail)):
        return [*head, *in_order(atoms[at:])]  # `turn right and then, after waiting 3 s, go 1 m`
    leads = not any(a.kind in _CONTENT for a in head)
    if not leads and word.value in ("after", "before") and all(a.kind in _NOTHING for a in tail):
        raise Unclear("unknown_part", " ".join(a.text for a in atoms[at:]))  # `stop 20 cm before me`
    if word.value == "after" and not leads and any(a.kind == "flag" and a.value == "first" for a in head):
        return in_order([*head, _THEN, *tail])  # `first …, after you …`: as said
    ended = ended_by_amount(head, tail) if word.text == "after" and not leads else None
    if ended is not None:
        return in_order(ended)
    if word.value == "reverse":
        return _swapped(head, tail)
    if word.value == "preceding":  # A 之前 B
        return _preceded(word, head, tail) if not leads else list(atoms)
    if leads:
        comma = next((i for i, a in enumerate(tail) if a.kind == "sep" and a.value == "weak"), None)
        at = _second_order(tail[:comma], word.text.endswith(" you"))
        if at is None or (comma is not None and tail[at - 1].kind == "conn"):
            at = comma  # `before you turn and drive 1 m, wait 2 s`
        if at is None:
            return list(atoms)
        first, second = tail[:at], tail[at + (at == comma) :]
        if word.value == "after":
            return [*first, _THEN, *second]
        end = _ends_at(second)
        return [*second[:end], _THEN, *first, *second[end:]]
    if word.value == "after":
        end = _ends_at(tail, at_then=True)
        cut = _behind_last_then(head)  # `go 1 m, then turn left after waiting 3 s`
        return [*head[:cut], *tail[:end], _THEN, *head[cut:], *tail[end:]]
    return [*head, _THEN, *tail]


def _first_told_last(atoms: list[Atom]) -> list[Atom]:
    """`A, then B, and first of all C`: C first; where something comes after C, it is as said."""
    real = [i for i, atom in enumerate(atoms) if atom.kind not in ("filler", "glue")]
    for i, at in itertools.pairwise(real):
        conn, flag = atoms[i], atoms[at]
        if (conn.kind, conn.value, flag.kind, flag.value) != ("conn", "and", "flag", "first"):
            continue
        head, tail = atoms[:i], atoms[at + 1 :]
        is_last = not any(a.kind == "conn" or (a.kind, a.value) == ("sep", "strong") for a in tail)
        if is_last and all(any(a.kind == "verb" for a in part) for part in (head, tail)):
            return [*tail, _THEN, *head]
    return atoms


def _preceded(word: Atom, head: list[Atom], tail: list[Atom]) -> list[Atom]:
    """`A, but before that B`: B first; behind the `then` before A, where that is what is meant."""
    if _is_told_again(head, tail):
        return tail
    end = next((i for i, a in enumerate(tail) if (a.kind, a.value) == ("flag", "finally")), None)
    if end:  # `A, but before that B, and at the end C`
        return [*tail[: end - 1], _THEN, *head, *tail[end - 1 :]]
    cut = _behind_last_then(head) if word.text.endswith("that") else 0  # `A, then B, and before that C`
    return [*head[:cut], *tail, _THEN, *head[cut:]]


def _behind_last_then(atoms: Sequence[Atom]) -> int:
    return max((i + 1 for i, a in enumerate(atoms) if (a.kind, a.value) == ("conn", "then")), default=0)


def _settled_after(atoms: Sequence[Atom]) -> list[Atom]:
    """`Turn left right after going …` tells an order; `turn left, and immediately after go …` only goes on."""
    out, parted = list(atoms), 0
    real = [i for i, a in enumerate(atoms) if a.kind not in ("filler", "glue")]
    for before, i, after in zip(real, real[1:], real[2:]):
        if atoms[i].text.split()[-1:] != ["after"] or atoms[after].kind not in ("verb", "dir"):
            continue
        gerund = _is_gerund(atoms[after])
        if gerund and atoms[i].kind == "conn":
            out[i] = Atom("order", "after", atoms[i].text)
            parted = parted or (i if _leads_to_order(list(atoms[i + 1 :])) else 0)
        elif (
            not gerund
            and after == i + 1
            and atoms[i].kind == "order"
            and atoms[before].kind in ("sep", "conn")
        ):
            out[i] = _THEN
    return [*out[:parted], _THEN, *out[parted:]] if parted else out


def _second_order(tail: list[Atom], said_you: bool) -> int | None:
    """`After waiting for 3 s | go 1 m`: where, without a comma, what is told ends and the order begins."""
    begins = next((i for i, a in enumerate(tail) if a.kind in ("verb", "dir")), len(tail))
    later = (i for i, a in enumerate(tail) if i > begins and a.kind == "verb" and a.text != tail[begins].text)
    second = next(later, None)
    if second is None or not (said_you or _is_gerund(tail[begins])) or _is_gerund(tail[second]):
        return None
    said = any(a.kind in ("q", "place") for a in tail[:second])
    said |= not said_you and any(a.kind in ("dir", "rot") for a in tail[:second])
    return second if said else None


def _leads_to_order(tail: list[Atom]) -> bool:
    """`Before driving 2 m, wait`, as a part of its own: `turn left, and before …`."""
    begins = [a for a in tail if a.kind not in ("filler", "glue")][:1]
    comma = next((i for i, a in enumerate(tail) if (a.kind, a.value) == ("sep", "weak")), len(tail))
    told = (any(a.kind in _CONTENT for a in part) for part in (tail[:comma], tail[comma:]))
    return bool(begins) and begins[0].kind == "verb" and _is_gerund(begins[0]) and all(told)


def _is_gerund(atom: Atom) -> bool:
    return atom.text.split()[0].endswith("ing")


def _ends_at(atoms: list[Atom], *, at_then: bool = False) -> int:
    """Where that which is done first ends: at a full stop, or at an `afterwards` that comes after both.

    `at_then`: at a comma and `then` too (`turn left after you drive 1 m, then drive 2 m`).
    """
    for i, atom in enumerate(atoms):
        broken = (
            at_then and i > 0 and atoms[i - 1].kind == "sep" and (atom.kind, atom.text) == ("conn", "then")
        )
        ends = (
            broken
            or (atom.kind, atom.value) == ("sep", "strong")
            or (atom.kind == "conn" and ("after" in atom.text or _is_last(atoms[i + 1 : i + 2])))
        )
        if not ends or not any(a.kind in _CONTENT for a in atoms[:i]):
            continue
        if any(a.kind in _CONTENT for a in atoms[i + 1 :]):
            return i
    return len(atoms)


def _is_last(atoms: list[Atom]) -> bool:
    return any((a.kind, a.value) == ("flag", "finally") for a in atoms)


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
