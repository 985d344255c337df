"""Several amounts that are one: `2 m minus 50 cm`, `twice as far as 60 cm`, `1 m 20 cm`."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.numbers import is_kind
from chatrobot.language.tokens import Atom, quantity

_LESS, _MORE = frozenset({"minus", "less", "take away", "减", "减去"}), frozenset({"plus", "+", "加", "加上"})

_SUMS = ("length", "angle", "time")


def calculated(atoms: list[Atom]) -> list[Atom]:
    """`2 m minus 50 cm`, `twice as far as 60 cm`: one quantity."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        sign = -1.0 if atom.text in _LESS else 1.0 if atom.text in _MORE else 0.0
        second = atoms[i + 1] if sign and i + 1 < len(atoms) else None
        first = out[-1] if out else None
        if first and second and first.kind == second.kind == "q" and first.value == second.value in _SUMS:
            text = f"{first.text} {atom.text} {second.text}"
            out[-1] = quantity(first.value, first.number + sign * second.number, text, first.role)
            i += 2
            continue
        if (
            first
            and atom.kind == first.kind == "q"
            and atom.value == first.value in _SUMS
            and atom.number < 0
        ):
            text = f"{first.text} {atom.text}"  # `2 m minus 50 cm`, read as a number below zero
            out[-1] = quantity(first.value, first.number + atom.number, text, first.role)
            i += 1
            continue
        factor = _factor_before(out) if atom.kind == "q" and atom.value in ("length", "angle") else None
        if factor is not None:
            text = f"{out[factor].text} {atom.text}"
            atom = quantity(atom.value, atom.number * out[factor].number, text, atom.role)
            del out[factor:]
        out.append(atom)
        i += 1
    return out


def _factor_before(out: list[Atom]) -> int | None:
    """Where `twice as far [as]` stands at the end of `out`."""
    at = len(out) - 1
    while at > 0 and out[at].kind == "glue" and out[at].text in ("as", "of"):
        at -= 1
    said = at >= 0 and at < len(out) - 1 and is_kind(out, at, "q", "scale")
    return at if said and " as " in out[at].text else None


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
