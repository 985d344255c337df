"""Several amounts that are one: `2 m minus 50 cm`, `30 cm times four`, `twice as far as 60 cm`, `1 m 20 cm`."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.numbers import is_kind
from chatrobot.language.tokens import Atom, quantity

_TIMES, _OVER = (
    frozenset({"times", "multiplied by", "*", "乘", "乘以"}),
    frozenset({"divided by", "/", "÷", "除以"}),
)

_FACTORS = frozenset({"double", "triple", "treble", "quadruple"})

_SUMS = ("length", "angle", "time")


@lru_cache(maxsize=1)
def _signs() -> dict[str, float]:
    signs = {"plus": 1.0, "minus": -1.0}
    tables = [(load_table(code, "more_or_less"), name) for code in LANGUAGES for name in signs]
    return {word: signs[name] for table, name in tables for word in table[name]}


def sign_of(atom: Atom) -> float:
    """1 for `plus`, -1 for `minus` or `shorter`, else 0."""
    return _signs().get(atom.text, 0.0) if atom.kind != "q" else 0.0


def is_another(atom: Atom) -> bool:
    """`another 20 cm`: it may be added to what was said, or stand by itself."""
    return any(atom.text in load_table(code, "more_or_less").get("another", ()) for code in LANGUAGES)


def calculated(atoms: list[Atom]) -> list[Atom]:
    """`2 m minus 50 cm`, `30 cm times four`, `twice as far as 60 cm`: one quantity."""
    lone = sum(a.kind == "q" and a.value in (*_SUMS, "turns") for a in atoms) == 1
    drawn = any(a.kind in ("shape", "counter") for a in atoms)  # 3 * 2 m is a rectangle
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        found = _added(out, atoms, i) or (_multiplied(out, atoms, i) if lone and not drawn else None)
        if found is not None:
            out[-1], i = found
            continue
        atom = atoms[i]
        factor = _factor_before(out) if atom.kind == "q" and atom.value in ("length", "angle") else None
        if factor is not None:
            text = f"{out[factor].text} {atom.text}"
            atom = quantity(atom.value, atom.number * out[factor].number, text, atom.role)
            del out[factor:]
        out.append(atom)
        i += 1
    return out


def _added(out: list[Atom], atoms: list[Atom], i: int) -> tuple[Atom, int] | None:
    """The last quantity of `out` with what is added or taken away at `i`, and the index after that."""
    first, atom = out[-1] if out else None, atoms[i]
    if first is None or first.kind != "q" or first.value not in _SUMS:
        return None
    if is_kind(atoms, i, "q", first.value) and atom.number < 0:  # `2 m minus 50 cm`, as a number below zero
        text = f"{first.text} {atom.text}"
        return quantity(first.value, first.number + atom.number, text, first.role), i + 1
    sign = sign_of(atom)
    if not sign or not is_kind(atoms, i + 1, "q", first.value):
        return None
    text = f"{first.text} {atom.text} {atoms[i + 1].text}"
    return quantity(first.value, first.number + sign * atoms[i + 1].number, text, first.role), i + 2


def _multiplied(out: list[Atom], atoms: list[Atom], i: int) -> tuple[Atom, int] | None:
    """`30 cm times four`, `3 * 20 cm`, `1.2 m / 2`; only where there is no other amount, which could be meant too."""
    times, over = atoms[i].text in _TIMES, atoms[i].text in _OVER
    first, second = out[-1] if out else None, atoms[i + 1] if i + 1 < len(atoms) else None
    if not (times or over) or first is None or second is None or not first.kind == second.kind == "q":
        return None
    text = f"{first.text} {atoms[i].text} {second.text}"
    if times and first.value == "number" and second.value in _SUMS:
        return quantity(second.value, first.number * second.number, text, second.role), i + 2
    ends = i + 2 >= len(atoms) or atoms[i + 2].kind in ("sep", "conn", "filler")
    if first.value not in _SUMS or second.value != "number" or second.number <= 0 or not (times or ends):
        return None
    factor = second.number if times else 1.0 / second.number
    return quantity(first.value, first.number * factor, text, first.role), i + 2


def _factor_before(out: list[Atom]) -> int | None:
    """Where `twice as far [as]` or `double` stands at the end of `out`."""
    at = len(out) - 1
    while at > 0 and out[at].kind == "glue" and out[at].text in ("as", "of"):
        at -= 1
    if at < 0 or not is_kind(out, at, "q", "scale"):
        return None
    return at if out[at].text in _FACTORS or (at < len(out) - 1 and " as " in out[at].text) else None


def summed(atoms: list[Atom]) -> list[Atom]:
    """`1 m 20 cm`, `2 minutes and 30 seconds`: one quantity, if the second is the smaller unit."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        if atom.kind == "q" and out and atom.value in ("length", "time") and "." not in atom.text:
            joined = is_kind(out, len(out) - 1, "conn", "and")
            before = out[-2] if joined and len(out) > 1 else out[-1]
            if before.kind == "q" and before.value == atom.value and _is_part(before, atom):
                follows = next((a for a in atoms[i + 1 :] if a.kind not in ("glue", "num")), None)
                apart = follows is not None and follows.kind in ("dir", "verb", "rot", "flag")
                if not (joined and (_is_a_list(out) or (apart and _has_way(out)))):
                    del out[-2 if joined else -1 :]
                    out.append(
                        quantity(atom.value, before.number + atom.number, f"{before.text} {atom.text}")
                    )
                    i += 1
                    continue
        out.append(atom)
        i += 1
    return out


def _is_a_list(atoms: Sequence[Atom]) -> bool:
    """Whether `sides [of]` stands before the amount that ends `atoms`: `sides 1 m and 50 cm` are two."""
    before = [a for a in atoms[:-2] if a.kind != "glue"][-1:]
    return any(
        a.kind in ("counter", "role") and a.text.endswith(("sides", "edges", "legs")) for a in before
    ) or any(a.text.endswith(("sides of", "edges of")) for a in before)


def _has_way(atoms: Sequence[Atom]) -> bool:
    """Whether the clause has its direction before the amount: `forward 1 m and 20 cm left` are two."""
    for atom in reversed(atoms):
        if atom.kind == "sep" or (atom.kind == "conn" and atom.value == "then"):
            return False
        if atom.kind in ("dir", "rot"):
            return True
    return False


def _is_part(whole: Atom, part: Atom) -> bool:
    same = whole.text.split()[-1] == part.text.split()[-1]
    return not same and 0 < part.number < whole.number and part.number < (60 if part.value == "time" else 1.0)
