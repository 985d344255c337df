"""三尺，也就是一米: an amount that is said again in other words. It is one amount, and both must agree.

`Left! Move left 50 cm`: a way that is said again with its motion.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.frames import Frame
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_SAME = ("length", "angle", "time")
_TOLERANCE = 0.03
"""三尺 is a metre to three parts in a hundred, whatever a foot is held to be."""


@cache
def _words() -> frozenset[str]:
    tables = [load_table(language, "asides").get("clues", {}) for language in LANGUAGES]
    return frozenset(word for table in tables for word in table.get("restated", ()))


def without_restated(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms without the second telling of an amount.

    Raises:
        Unclear: where the two do not agree.
    """
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        again = _again(out, atoms, i)
        if again is None:
            out.append(atoms[i])
            i += 1
            continue
        if not math.isclose(out[-1].number, atoms[again].number, rel_tol=_TOLERANCE):
            raise Unclear("contradiction", f"{out[-1].text} {atoms[again].text}")
        i = again + 1
        if _only_explains(out):
            del out[-2:]
    return out


def without_lone_way(frames: Sequence[Frame]) -> list[Frame]:
    """`Left! Move left 50 cm`: the frames without a way that the sentence after it says again."""
    said = [*frames[1:], None]
    return [frame for frame, after in zip(frames, said) if after is None or not _says_again(frame, after)]


def _says_again(frame: Frame, after: Frame) -> bool:
    way = frame.direction or frame.rot
    lone = bool(way) and frame == Frame(
        direction=frame.direction, rot=frame.rot, texts=frame.texts, joined=frame.joined, opens=frame.opens
    )
    same = way in (after.direction, after.rot) and bool(after.verb) and after.has_extent
    return lone and after.joined == "strong" and same


def _only_explains(out: Sequence[Atom]) -> bool:
    """往前走三尺，三尺就是一米: the amount was said before, and this clause only says what it comes to."""
    if len(out) < 3 or out[-2].kind != "sep":
        return False
    *before, _, told = out
    return any((a.kind, a.text, a.number) == ("q", told.text, told.number) for a in before)


def _again(out: Sequence[Atom], atoms: Sequence[Atom], i: int) -> int | None:
    """Where, from `i` on, the last amount of `out` is told once more."""
    if not out or out[-1].kind != "q" or _dimension(out[-1]) not in _SAME:
        return None
    end, said = i, False
    while end < len(atoms) and (atoms[end].kind in ("glue", "filler") or _is_light(atoms[end])):
        said = said or atoms[end].text in _words()
        end += 1
    told = end < len(atoms) and atoms[end].kind == "q" and _dimension(atoms[end]) == _dimension(out[-1])
    return end if told and (said or _is_another_unit(out[-1], atoms, i, end)) else None


def _is_another_unit(before: Atom, atoms: Sequence[Atom], i: int, end: int) -> bool:
    """走半米，五十公分: as much in another unit, and nothing more."""
    alone = end + 1 == len(atoms) or atoms[end + 1].kind == "sep"
    alike = before.role != atoms[end].role and math.isclose(before.number, atoms[end].number)
    return (
        alone and alike and end > i and all(_is_light(atom) or atom.kind == "filler" for atom in atoms[i:end])
    )


def _is_light(atom: Atom) -> bool:
    return atom.kind == "sep" and atom.value in ("weak", "paren")


def _dimension(atom: Atom) -> str:
    return "angle" if atom.value == "turns" else atom.value
