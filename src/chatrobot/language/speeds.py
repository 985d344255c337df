"""Speeds and rates said as an amount and a time: `10 cm a second`, `90 degrees every two seconds`, 每秒十厘米."""

from __future__ import annotations

from chatrobot.language.numbers import is_chinese, is_kind
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.units import unit_at


def with_speeds(atoms: list[Atom]) -> list[Atom]:
    """Length per time and angle per time, in either order: `10 cm a second`, 每秒十厘米."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        if atom.kind == "q" and atom.value in ("length", "angle", "turns"):
            end, time_s = _per_time(atoms, i + 1)
            if time_s:
                kind = "speed" if atom.value == "length" else "rate"
                text = " ".join(a.text for a in atoms[i:end])
                out.append(quantity(kind, atom.number / time_s, text))
                i = end
                continue
        end, time_s = _each_time(atoms, i)
        if time_s and is_kind(atoms, end, "q") and atoms[end].value in ("length", "angle", "turns"):
            kind = "speed" if atoms[end].value == "length" else "rate"
            text = "".join(a.text for a in atoms[i : end + 1])
            verbs = [a for a in atoms[i:end] if a.kind in ("verb", "dir", "rot")]
            role = "" if atom.kind in ("per", "flag") else atoms[end].value
            out.extend([*verbs, quantity(kind, atoms[end].number / time_s, text, role)])
            i = end + 1
            continue
        out.append(atom)
        i += 1
    return out


def _per_time(atoms: list[Atom], i: int) -> tuple[int, float]:
    """The index after `per second`, `/s`, `a second`, `each second`, and the time.

    (i, 0) if it is not there.
    """
    if not (
        is_kind(atoms, i, "per")
        or is_kind(atoms, i, "num", "article")
        or is_kind(atoms, i, "flag", "each")
        or (is_kind(atoms, i, "q", "time") and atoms[i].text.startswith(("a ", "an ", "every ", "each ")))
    ):
        return i, 0.0
    if atoms[i].kind == "q":
        return i + 1, atoms[i].number
    if is_kind(atoms, i + 1, "q", "time"):
        return i + 2, atoms[i + 1].number
    unit = unit_at(atoms, i + 1)
    return (i + 2, unit[1]) if unit and unit[0] == "time" else (i, 0.0)


def _each_time(atoms: list[Atom], i: int) -> tuple[int, float]:
    """每秒 [转] or 一秒 [转], `every second`, before a quantity."""
    end, time_s = i, 0.0
    if is_kind(atoms, i, "per") or is_kind(atoms, i, "flag", "each"):
        unit = unit_at(atoms, i + 1)
        if unit and unit[0] == "time":
            end, time_s = i + 2, unit[1]
        elif is_kind(atoms, i, "per") and is_kind(atoms, i + 1, "q", "time"):
            end, time_s = i + 2, atoms[i + 1].number
    elif is_kind(atoms, i, "q", "time") and is_chinese(atoms[i].text) and atoms[i].number == 1.0:
        end, time_s = i + 1, atoms[i].number
    while time_s and end < len(atoms) and atoms[end].kind in ("glue", "verb", "dir", "rot"):
        end += 1
    return end, time_s
