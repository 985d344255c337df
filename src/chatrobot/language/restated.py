"""三尺，也就是一米: an amount that is said again in other words. It is one amount, and both must agree.

`Left! Move left 50 cm`: a way that is said again with its motion. `We'll go 1 m, ok? Forward 1 m`: a motion that is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.frames import GO, Frame
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear

_SAME = ("length", "angle", "time")
_SPEEDS = frozenset({"speed", "rate"})
_BEHIND_AMOUNT = frozenset({"dir", "rot", "glue", "filler"})
_SENSES = frozenset({"left", "right"})
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
        again, said = _next_amount(atoms, i)
        told = _told(out, atoms, i, again, said) if again is not None else None
        if told is None or again is None:
            out.append(atoms[i])
            i += 1
            continue
        if not math.isclose(told.number, atoms[again].number, rel_tol=_TOLERANCE):
            raise Unclear("contradiction", f"{told.text} {atoms[again].text}")
        i = again + 1
        if _only_explains(out):
            del out[-2:]
    return out


def without_told_before(frames: Sequence[Frame]) -> list[Frame]:
    """The frames without what another sentence says again: `Left! Move left 50 cm`, `go 1 m, please do that now`."""
    said = [*frames[1:], None]
    kept = [frame for frame, after in zip(frames, said) if after is None or not _says_again(frame, after)]
    return [
        frame
        for before, frame in zip([None, *kept], kept)
        if before is None
        or not (_points_at(before, frame) or _is_its_sense(before, frame) or _is_its_end(before, frame))
    ]


def _says_again(frame: Frame, after: Frame) -> bool:
    lone, way = _is_lone(frame), frame.direction or frame.rot
    same = way in (after.direction, after.rot) and bool(after.verb) and after.has_extent
    return (lone and after.joined == "strong" and same) or _tells_way(frame, after)


def _is_its_sense(before: Frame, frame: Frame) -> bool:
    """`Turn right 90. Clockwise!`: which way round the motion before is, and no motion of its own.

    Raises:
        Unclear: where it is the other way round.
    """
    if not (
        frame.rot and _is_lone(frame) and (before.has_extent or "number" in before.q)
    ) or frame.joined not in ("weak", "strong"):
        return False
    way = before.rot or before.direction
    if way in _SENSES and way != frame.rot:
        raise Unclear("contradiction", f"{before.text}, {frame.text}")
    return way == frame.rot


def _is_its_end(before: Frame, frame: Frame) -> bool:
    """`Turn 180 so you face backwards`, 掉头，面朝后面: how it stands after the half turn before, and no more."""
    said = next((before.q[name].number for name in ("angle", "turns", "number") if name in before.q), 0.0)
    half = any(math.isclose(said, each) for each in (math.pi, 180.0)) and "length" not in before.q
    is_half = half if said else before.turning
    looks_back = frame == Frame(
        verb="face", direction="back", texts=frame.texts, joined=frame.joined, opens=frame.opens
    )
    return looks_back and is_half and frame.joined != "then"


def _is_lone(frame: Frame) -> bool:
    """Whether it tells a way and nothing else."""
    return bool(frame.direction or frame.rot) and frame == Frame(
        direction=frame.direction, rot=frame.rot, texts=frame.texts, joined=frame.joined, opens=frame.opens
    )


def _tells_way(frame: Frame, after: Frame) -> bool:
    """`We'll go a metre twenty ok? forward a metre twenty`: so far, and then the way of it."""
    amount, again = frame.q.get("length"), after.q.get("length")
    if amount is None or again is None or not math.isclose(amount.number, again.number):
        return False
    size = {"length": amount}
    plain = frame == Frame(verb=frame.verb, q=size, texts=frame.texts, joined=frame.joined, opens=frame.opens)
    ahead = after == Frame(
        direction="forward", q={"length": again}, texts=after.texts, joined=after.joined, opens=after.opens
    )
    return plain and ahead and frame.verb in GO and after.joined not in ("and", "then")


def _points_at(before: Frame, frame: Frame) -> bool:
    """`You were going to go forward a metre, so please do that now`: what was told is to be done, and once."""
    points = frame == Frame(flags={"again"}, texts=frame.texts, joined=frame.joined, opens=frame.opens)
    if (
        points and "same_amount" in before.flags and "times" not in before.q
    ):  # `same distance, faster, once more`
        return frame.joined == "weak"
    said = frame.texts in (["that"], ["it"], ["this"], ["do that"], ["do it"], ["do this"])
    return points and said and frame.joined in ("weak", "strong") and before.moves and before.has_extent


def _only_explains(out: Sequence[Atom]) -> bool:
    """往前走三尺，三尺就是一米: the amount was said before, and this clause only says what it comes to."""
    if len(out) < 3 or out[-2].kind != "sep":
        return False
    *before, _, told = out
    return any((a.kind, a.text, a.number) == ("q", told.text, told.number) for a in before)


def _last_amount(out: Sequence[Atom]) -> Atom | None:
    """The last amount, where nothing but its way may stand behind it."""
    at = next((at for at in range(len(out) - 1, -1, -1) if out[at].kind not in _BEHIND_AMOUNT), -1)
    return out[at] if at >= 0 and out[at].kind == "q" and _dimension(out[at]) in _SAME else None


def _next_amount(atoms: Sequence[Atom], i: int) -> tuple[int | None, bool]:
    """Where an amount begins behind marks and light words from `i` on, and whether these say that it is one again."""
    end, said = i, False
    while end < len(atoms) and (atoms[end].kind in ("glue", "filler") or _is_apart(atoms[end])):
        said = said or atoms[end].text in _words()
        end += 1
    return (end if end < len(atoms) and atoms[end].kind == "q" else None), said


def _told(out: Sequence[Atom], atoms: Sequence[Atom], i: int, again: int, said: bool) -> Atom | None:
    """The amount that is told once more at `again`: the last one, or the last speed, wherever that was told."""
    dimension = _dimension(atoms[again])
    if said and dimension in _SPEEDS:
        return next((atom for atom in reversed(out) if atom.kind == "q" and atom.value == dimension), None)
    covered = _covered(out, dimension)
    if covered is not None and (said or _is_another_unit(covered, atoms, i, again)):
        return covered
    told = _last_amount(out)
    if told is None or _dimension(told) != dimension:
        return None
    apart = any(atom.value == "strong" for atom in atoms[i:again] if atom.kind == "sep")
    is_next = out[-1] is told and not apart
    return told if said or (is_next and _is_another_unit(told, atoms, i, again)) else None


def _covered(out: Sequence[Atom], dimension: str) -> Atom | None:
    """`10 s at 0.3 m/s, that makes 3 m`: what the motion before comes to, by its speed and its time."""
    begin = next((i + 1 for i in range(len(out) - 1, -1, -1) if out[i].kind in ("sep", "conn")), 0)
    told = {atom.value: atom for atom in out[begin:] if atom.kind == "q"}
    pace = {"length": "speed", "angle": "rate"}.get(dimension, "")
    if not told.keys() >= {"time", pace} or told.keys() & {"length", "angle", "turns"}:
        return None
    text = f"{told[pace].text} {told['time'].text}"
    return quantity(dimension, told[pace].number * told["time"].number, text)


def _is_another_unit(before: Atom, atoms: Sequence[Atom], i: int, end: int) -> bool:
    """走半米，五十公分: as much in another unit, and nothing more."""
    alone = end + 1 == len(atoms) or atoms[end + 1].kind == "sep"
    alike = before.role != atoms[end].role and math.isclose(before.number, atoms[end].number)
    return (
        alone and alike and end > i and all(_is_light(atom) or atom.kind == "filler" for atom in atoms[i:end])
    )


def _is_apart(atom: Atom) -> bool:
    return atom.kind == "sep" and atom.value in ("weak", "strong", "paren")


def _is_light(atom: Atom) -> bool:
    return atom.kind == "sep" and atom.value in ("weak", "paren")


def _dimension(atom: Atom) -> str:
    return "angle" if atom.value == "turns" else atom.value
