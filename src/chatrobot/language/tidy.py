"""Amounts and words put together as they belong: radii, pauses, relative speeds, fractions of something."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.leftovers import next_real, settled_word
from chatrobot.language.numbers import is_chinese, is_kind
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear

_HALVES = ("一半", "half")
_COUNTED = frozenset({"polygon", "star", "eight", "racetrack", "sbend", "zigzag", "stairs", "lawn", "spiral"})
"""Shapes whose number may be that of their parts."""


def tidy(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms as the clause reader wants them.

    Raises:
        Unclear: for a number behind a shape that may be its size.
    """
    settled = [settled_word(atoms, i) for i in range(len(atoms))]
    if any(atom.kind == "shape" for atom in settled):
        _check_sizes(settled)
        settled = _first_side(settled)
        settled = [_times_sign(settled, i) for i in range(len(settled))]
    else:
        settled = _radii(settled)
    settled = _pauses(settled)
    return _headings(_fractions_of(_relative_speeds(settled)))


def _check_sizes(atoms: Sequence[Atom]) -> None:
    """`Square 50`, `circle left 60`: how big, in what, and not how often."""
    drawn = ""
    for i, atom in enumerate(atoms):
        if atom.kind == "shape":
            drawn = atom.value
        elif atom.kind not in ("dir", "rot", "glue", "filler"):
            size = atom.kind == "q" and atom.value == "number" and not is_chinese(atom.text)
            counts_sides = is_kind(atoms, next_real(atoms, i + 1), "role", "side")
            if size and drawn and drawn not in _COUNTED and not counts_sides:
                raise Unclear("no_unit", atom.text)
            drawn = ""


def _first_side(atoms: Sequence[Atom]) -> list[Atom]:
    """`1 m by 50 cm, the short side first`: the two lengths in that order."""
    out = list(atoms)
    sizes = [i for i, atom in enumerate(out) if (atom.kind, atom.value) == ("q", "length")]
    for i, atom in enumerate(out):
        before = i - 1
        while before > 0 and out[before].kind == "glue":
            before -= 1
        beside = [at for at in (before, next_real(out, i + 1)) if is_kind(out, at, "flag", "first")]
        if len(sizes) != 2 or atom.kind != "role" or atom.value not in ("long", "short") or not beside:
            continue
        first, second = sizes
        if (out[first].number > out[second].number) != (atom.value == "long"):
            out[first], out[second] = out[second], out[first]
        out[i] = out[beside[0]] = Atom("glue", "x", atom.text)
    return out


def _radii(atoms: Sequence[Atom]) -> list[Atom]:
    """`a 1.5 m radius`, `radius of 1.5 m`, `3 m in diameter`: a quantity of its own beside the length of an arc."""
    out = list(atoms)
    for i, atom in enumerate(atoms):
        if atom.kind != "role" or atom.value not in ("radius", "diameter"):
            continue
        after, before = next_real(out, i + 1), i - 1
        while before > 0 and out[before].kind == "glue":
            before -= 1
        at = next((j for j in _binding(atoms, i, before, after) if is_kind(out, j, "q", "length")), None)
        if at is None:
            continue
        size = out[at].number / (2.0 if atom.value == "diameter" else 1.0)
        out[at] = quantity("radius", size, f"{out[at].text} {atom.text}")
        out[i] = Atom("glue", "x", atom.text)
    return out


def _binding(atoms: Sequence[Atom], i: int, before: int, after: int) -> tuple[int, ...]:
    """Where the amount of the role at `i` stands: before it, unless `of`, `is` or `with` say it follows."""
    of = after > i + 1 or (i > 0 and atoms[i - 1].text in ("with", "the", "a", "its", "of"))
    apart = before >= 0 and atoms[before].kind != "q"
    return (after, before) if of or apart else (before, after)


def _times_sign(atoms: Sequence[Atom], i: int) -> Atom:
    """`1 m by 50 cm`: the sides of a shape, not one length after the other."""
    joins = (
        atoms[i].text in ("by", "x", "乘", "乘以")
        and is_kind(atoms, i - 1, "q")
        and is_kind(atoms, i + 1, "q")
    )
    return Atom("sep", "weak", atoms[i].text) if joins else atoms[i]


def _pauses(atoms: Sequence[Atom]) -> list[Atom]:
    """`a two second break` is `break two seconds`: the verb first, so that the time is its own."""
    out: list[Atom] = []
    for atom in atoms:
        if atom.kind == "verb" and atom.value == "wait":
            at = len(out)
            while at and (out[at - 1].kind == "glue"):
                at -= 1
            if (
                at
                and out[at - 1].kind == "q"
                and out[at - 1].value == "time"
                and not is_chinese(out[at - 1].text)
            ):
                out.insert(at - 1, atom)
                continue
        out.append(atom)
    return out


def _headings(atoms: Sequence[Atom]) -> list[Atom]:
    """The original heading is something to face."""
    out: list[Atom] = []
    for atom in atoms:
        if atom.kind == "flag" and atom.value == "original_heading":
            out.append(Atom("verb", "face", atom.text))
        out.append(atom)
    return out


def _relative_speeds(atoms: Sequence[Atom]) -> list[Atom]:
    """`half of your maximum speed`, `60 percent of top speed`, 最大速度的一半: one percentage."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        j = next_real(atoms, i + 1)
        fraction = atom.kind == "q" and atom.value in ("number", "percent") and 0 < atom.number <= 1
        if fraction and is_kind(atoms, j, "pace", "max"):
            out.append(quantity("percent", atom.number, f"{atom.text} {atoms[j].text}"))
            i = j + 1
        elif (
            is_kind(atoms, i, "pace", "max")
            and is_kind(atoms, j, "q")
            and (atoms[j].value == "percent" or (atoms[j].value == "number" and 0 < atoms[j].number < 1))
        ):
            out.append(quantity("percent", atoms[j].number, f"{atom.text} {atoms[j].text}"))
            i = j + 1
        elif is_kind(atoms, i, "q", "times") and is_kind(atoms, j, "pace", "default"):
            out.append(quantity("fold", atom.number, atom.text))
            i = j + 1
        elif is_kind(atoms, i, "pace", "default") and is_kind(atoms, j, "pace", "half"):
            out.append(quantity("fold", 0.5, f"{atom.text} {atoms[j].text}"))
            i = j + 1
        elif fraction and atom.number < 1 and is_kind(atoms, j, "pace", "default"):
            out.append(quantity("fold", atom.number, f"{atom.text} {atoms[j].text}"))
            i = j + 1
        elif (
            is_kind(atoms, i, "pace", "default")
            and is_kind(atoms, j, "q")
            and atoms[j].value in ("number", "percent", "speed")
            and atoms[j].text in _HALVES
        ):
            out.append(quantity("fold", 0.5, f"{atom.text} {atoms[j].text}"))
            i = j + 1
        else:
            out.append(atom)
            i += 1
    return out


def _fractions_of(atoms: Sequence[Atom]) -> list[Atom]:
    """`quarter of a metre`, `half of a metre`, `3/4 of a turn`: a fraction of a quantity."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        j = i + 1
        while j < len(atoms) and atoms[j].kind == "glue" and atoms[j].text in ("of", "the", "a"):
            j += 1
        fraction = atom.kind == "q" and atom.value == "number" and 0 < atom.number < 1
        if (
            (fraction or is_kind(atoms, i, "q", "percent")) and any(a.text == "of" for a in atoms[i + 1 : j])
            and is_kind(atoms, j, "q") and atoms[j].value in ("length", "time", "turns", "angle")
        ):  # fmt: skip
            out.append(
                quantity(atoms[j].value, atom.number * atoms[j].number, f"{atom.text} of {atoms[j].text}")
            )
            i = j + 1
        else:
            out.append(atom)
            i += 1
    return out
