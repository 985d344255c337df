"""Words of numbers and units that turned out to be no amount: what they mean depends on their neighbours."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from chatrobot.language.numbers import is_chinese, is_kind
from chatrobot.language.tokens import Atom, quantity

_WHOLE = ("full ", "complete ", "whole ", "entire ", "整")
"""Beginnings of words that say that all of a circle is meant."""


def settled_word(atoms: Sequence[Atom], i: int) -> Atom:
    """The atom at `i` as what it is when it is no part of an amount."""
    atom = atoms[i]
    follows = i + 1 < len(atoms) and atoms[i + 1].kind in ("verb", "dir", "rot", "sep", "glue", "conn")
    after = ("q", "verb", "shape", "dir") if atom.text == "以后" else ("q", "verb", "shape")
    if (atom.text == "以后" or (atom.text == "后" and follows)) and i and atoms[i - 1].kind in after:
        return Atom("conn", "then", atom.text)
    settle = _SETTLED.get(atom.kind)
    return settle(atoms, i) if settle is not None else atom


def _verb(atoms: Sequence[Atom], i: int) -> Atom:
    to_a_side = atoms[i].text.endswith("back to") and is_kind(atoms, i + 1, "dir")
    if to_a_side:  # `go back to the left`: backwards, or to where it was?
        return Atom("unknown", atoms[i].text, f"{atoms[i].text} {atoms[i + 1].text}")
    driven = atoms[i].text == "hold" and is_kind(atoms, i + 1, "q", "speed")  # `hold 0.4 m/s forward`
    return Atom("verb", "go", atoms[i].text) if driven else atoms[i]


def _direction(atoms: Sequence[Atom], i: int) -> Atom:
    straight = atoms[i].text.endswith("straight") and is_kind(atoms, i + 1, "dir")
    return _glue(atoms, i) if straight else atoms[i]  # `driving straight back`


def _glue(atoms: Sequence[Atom], i: int) -> Atom:
    return Atom("glue", "x", atoms[i].text)


def _then(atoms: Sequence[Atom], i: int) -> Atom:
    return Atom("conn", "then", atoms[i].text)


def _connective(atoms: Sequence[Atom], i: int) -> Atom:
    """`Go forward then, 2 m`: nothing follows in its clause, so that it parts nothing."""
    loose = i and atoms[i - 1].kind != "sep" and is_kind(atoms, i + 1, "sep", "weak")
    return _glue(atoms, i) if loose else atoms[i]


def _second(atoms: Sequence[Atom], i: int) -> Atom:
    """`30 degrees for second`: how fast, or for how long?"""
    loose = is_kind(atoms, i - 1, "glue", "x") and atoms[i - 1].text == "for" and is_kind(atoms, i - 2, "q")
    return Atom("unknown", atoms[i].text, f"for {atoms[i].text}") if loose else _then(atoms, i)


def _ordinal(atoms: Sequence[Atom], i: int) -> Atom:
    return _then(atoms, i) if atoms[i].text == "third" else atoms[i]


def _leftover_number(atoms: Sequence[Atom], i: int) -> Atom:
    atom = atoms[i]
    if atom.value == "point" and is_chinese(atom.text):
        return Atom("flag", "bit", atom.text)
    if atom.value == "point":  # `point left`, but not `back to the point`
        ends = i + 1 >= len(atoms) or atoms[i + 1].kind in ("sep", "conn")
        noun = i and (ends or atoms[i - 1].text in ("the", "a", "to the", "that"))
        return Atom("unknown", atom.text, atom.text) if noun else Atom("verb", "face", atom.text)
    unknown = atom.value in ("minus", "parts", "root")
    return Atom("unknown", atom.text, atom.text) if unknown else _glue(atoms, i)


def _pause(atoms: Sequence[Atom], i: int) -> Atom:
    atom = atoms[i]
    timed = is_kind(atoms, next_real(atoms, i + 1), "q", "time")
    stops = atom.text.split()[-1] in ("stop", "halt")
    return Atom("verb", "wait", atom.text) if stops and timed else atom


def _unit_of_length(atoms: Sequence[Atom], i: int) -> Atom:
    inching = atoms[i].text == "inch" and is_kind(atoms, i + 1, "dir")
    return Atom("verb", "shift", atoms[i].text) if inching else atoms[i]


def _letter(atoms: Sequence[Atom], i: int) -> Atom:
    atom = atoms[i]
    if atom.text == "r" and is_kind(atoms, next_real(atoms, i + 1), "q", "length"):
        return Atom("role", "radius", atom.text)  # r = 0.5 m
    after = is_kind(atoms, i - 1, "q") and not is_kind(atoms, i + 1, "unknown")
    beside = is_kind(atoms, i + 1, "q") or after
    return Atom("dir", atom.value, atom.text) if beside else Atom("unknown", atom.text, atom.text)


def _counter(atoms: Sequence[Atom], i: int) -> Atom:
    atom = atoms[i]
    counted = i > 0 and atoms[i - 1].kind in ("q", "number", "num")
    if atom.text == "edge" and not counted and any(is_kind(atoms, i + 1, k) for k in ("dir", "q", "flag")):
        return Atom("verb", "shift", atom.text)  # `edge forward 20 cm`
    if atom.text not in ("step", "pace", "steps"):
        return Atom("role", atom.value, atom.text)
    return Atom("verb", "go", atom.text) if is_kind(atoms, i + 1, "dir") else _glue(atoms, i)


def _times(atoms: Sequence[Atom], i: int) -> Atom:
    atom = atoms[i]
    if atom.text == "回":
        return Atom("verb", "return", atom.text)
    return _glue(atoms, i) if atom.text in ("time", "次", "下来") else atom


def _full_turn(atoms: Sequence[Atom], i: int) -> Atom:
    if atoms[i].text.startswith(_WHOLE):  # `full circle clockwise, radius 75 cm`
        return quantity("turns", 2.0 * math.pi, atoms[i].text)
    measured = is_kind(atoms, i + 1, "role")  # 每个圈半径三十厘米
    return _glue(atoms, i) if measured else Atom("verb", "turn", atoms[i].text)


def _role(atoms: Sequence[Atom], i: int) -> Atom:
    round_ = any(a.kind == "shape" or (a.kind, a.value) == ("verb", "curve") for a in atoms)
    way = not round_ and is_kind(atoms, next_real(atoms, i + 1), "dir")  # `30 cm across to the right`
    return _glue(atoms, i) if atoms[i].text == "across" and way else atoms[i]


def _percent(atoms: Sequence[Atom], i: int) -> Atom:
    return _glue(atoms, i) if atoms[i].text == "成" else atoms[i]


def _flag(atoms: Sequence[Atom], i: int) -> Atom:
    amount = is_kind(atoms, i - 1, "q", "time") or is_kind(atoms, i - 1, "q", "length")
    ahead = (
        atoms[i].text == "of forward" and amount
    )  # `two seconds of forward`, not `30 degrees left of forward`
    return Atom("dir", "forward", atoms[i].text) if ahead else atoms[i]


def _glue_word(atoms: Sequence[Atom], i: int) -> Atom:
    """Words that say nothing beside an amount; alone they would say something that nobody reads."""
    atom = atoms[i]
    sides = atom.text == "左右" and not (i and atoms[i - 1].kind == "q")  # 一米左右 is about a metre
    amounts = [a for a in atoms[max(i - 2, 0) : i + 4] if a.kind == "q"]
    angle = atom.text in ("angle", "the angle") and not amounts  # `the angle of a triangle`
    return Atom("unknown", atom.text, atom.text) if sides or angle else atom


def _unit_of_angle(atoms: Sequence[Atom], i: int) -> Atom:
    atom = atoms[i]
    if atom.text == "弧":
        return Atom("verb", "curve", atom.text)
    right = atom.text.lstrip("个") in ("直角", "直角弯", "平角")
    return quantity("angle", float(atom.value), atom.text) if right else atom


_SETTLED: dict[str, Callable[[Sequence[Atom], int], Atom]] = {
    "verb": _verb, "dir": _direction, "num": _leftover_number, "filler": _pause, "unit_length": _unit_of_length,
    "second": _second, "fraction": _ordinal, "letter": _letter, "counter": _counter, "unit_times": _times,
    "per": _glue, "unit_turn": _full_turn, "role": _role, "flag": _flag, "unit_percent": _percent,
    "glue": _glue_word, "conn": _connective, "unit_angle": _unit_of_angle,
}  # fmt: skip


def next_real(atoms: Sequence[Atom], i: int) -> int:
    """The index of the first atom from `i` on that is more than an article or the like."""
    while i < len(atoms) and atoms[i].kind == "glue":
        i += 1
    return i
