"""What words mean where they stand: leftovers of numbers, relative speeds, closer-to, reasons, negations."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.numbers import is_chinese, is_kind
from chatrobot.language.tokens import Atom, quantity

_HARMLESS = ("filler", "glue", "unknown", "num", "reason", "unit_times", "flag", "question")
_MOTION = ("q", "verb", "dir", "rot", "shape", "pace", "role", "number")


_HALVES = ("一半", "half")


def tidy(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms as the clause reader wants them."""
    settled = [_settled(atoms, i) for i in range(len(atoms))]
    if any(atom.kind == "shape" for atom in settled):
        settled = [_times_sign(settled, i) for i in range(len(settled))]
    else:
        settled = _radii(settled)
    settled = _pauses(settled)
    return _headings(_fractions_of(_relative_speeds(settled)))


def _radii(atoms: Sequence[Atom]) -> list[Atom]:
    """`a 1.5 m radius`, `radius of 1.5 m`, `3 m in diameter`: a quantity of its own beside the length of an arc."""
    out = list(atoms)
    for i, atom in enumerate(atoms):
        if atom.kind != "role" or atom.value not in ("radius", "diameter"):
            continue
        after, before = _next_real(out, i + 1), i - 1
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


def _settled(atoms: Sequence[Atom], i: int) -> Atom:
    """Words of numbers that turned out to be no number."""
    atom = atoms[i]
    if atom.kind == "dir" and atom.text.endswith("straight") and is_kind(atoms, i + 1, "dir"):
        return Atom("glue", "x", atom.text)  # `driving straight back`
    if atom.kind == "num":
        if atom.value == "point" and is_chinese(atom.text):
            return Atom("flag", "bit", atom.text)
        if atom.value == "point":  # `point left`, but not `back to the point`
            ends = i + 1 >= len(atoms) or atoms[i + 1].kind in ("sep", "conn")
            return Atom("unknown" if ends and i else "verb", atom.text if ends and i else "face", atom.text)
        if atom.value == "minus" or atom.value == "parts":
            return Atom("unknown", atom.text, atom.text)
        return Atom("glue", "x", atom.text)
    if atom.text == "以后" and i and atoms[i - 1].kind in ("q", "verb", "shape", "dir"):
        return Atom("conn", "then", atom.text)
    follows = i + 1 < len(atoms) and atoms[i + 1].kind in ("verb", "dir", "rot", "sep", "glue", "conn")
    if atom.text == "后" and follows and i and atoms[i - 1].kind in ("q", "verb", "shape"):
        return Atom("conn", "then", atom.text)
    if (
        atom.kind == "filler"
        and atom.text.split()[-1] in ("stop", "halt")
        and is_kind(atoms, _next_real(atoms, i + 1), "q", "time")
    ):
        return Atom("verb", "wait", atom.text)
    if atom.kind == "unit_length" and atom.text == "inch" and is_kind(atoms, i + 1, "dir"):
        return Atom("verb", "shift", atom.text)
    if atom.kind == "second":
        return Atom("conn", "then", atom.text)
    if atom.kind == "letter" and atom.text == "r" and is_kind(atoms, _next_real(atoms, i + 1), "q", "length"):
        return Atom("role", "radius", atom.text)  # r = 0.5 m
    if atom.kind == "letter":
        beside = is_kind(atoms, i + 1, "q") or (
            is_kind(atoms, i - 1, "q") and not is_kind(atoms, i + 1, "unknown")
        )
        return Atom("dir" if beside else "unknown", atom.value if beside else atom.text, atom.text)
    if atom.kind == "counter":
        if atom.text in ("step", "pace", "steps"):
            return (
                Atom("verb", "go", atom.text)
                if is_kind(atoms, i + 1, "dir")
                else Atom("glue", "x", atom.text)
            )
        return Atom("role", atom.value, atom.text)
    if atom.kind == "unit_times" and atom.text == "回":
        return Atom("verb", "return", atom.text)
    if atom.kind == "per" or (atom.kind == "unit_times" and atom.text in ("time", "次", "下来")):
        return Atom("glue", "x", atom.text)
    if atom.kind == "unit_turn":
        if is_kind(atoms, i + 1, "role"):
            return Atom("glue", "x", atom.text)  # 每个圈半径三十厘米
        return Atom("verb", "turn", atom.text)
    if atom.kind == "unit_percent" and atom.text == "成":
        return Atom("glue", "x", atom.text)
    if atom.kind == "glue" and atom.text == "左右" and not (i and atoms[i - 1].kind == "q"):
        return Atom("unknown", atom.text, atom.text)
    if atom.kind == "unit_angle" and atom.text == "弧":
        return Atom("verb", "curve", atom.text)
    if atom.kind == "unit_angle" and atom.text.lstrip("个") in ("直角", "直角弯", "平角"):
        return quantity("angle", float(atom.value), atom.text)
    return atom


def _next_real(atoms: Sequence[Atom], i: int) -> int:
    while i < len(atoms) and atoms[i].kind == "glue":
        i += 1
    return i


def _relative_speeds(atoms: Sequence[Atom]) -> list[Atom]:
    """`half of your maximum speed`, `60 percent of top speed`, 最大速度的一半: one percentage."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        j = _next_real(atoms, i + 1)
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
        elif is_kind(atoms, i, "pace", "default") and is_kind(atoms, j, "pace", "half_max"):
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
