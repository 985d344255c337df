"""Nothing may be left over in a frame: what is not acted on was not understood."""

from __future__ import annotations

import math

from chatrobot.language.frames import PLACE_HEADING, Frame
from chatrobot.language.unclear import Unclear

_MAX_EXTENT = {"length": 1000.0, "angle": 200.0 * math.pi, "turns": 200.0 * math.pi, "time": 3600.0}
"""The longest of a kind that is meant seriously, in SI units."""

_SLOTS = {
    "still": {"time"},
    "turn": {"angle", "turns", "time", "rate", "percent", "fold", "faster", "times"},
    "drive": {"length", "time", "speed", "percent", "fold", "faster", "times"},
    "heading": {"length", "time", "speed", "percent", "fold", "faster", "times", "angle"},
}

_REFERRING = frozenset({
    "halfway", "other_way", "short_of", "from_now_on", "same_way", "to_start", "original_heading",
    "left_right", "right_left", "at_point", "from_heading", PLACE_HEADING,
})  # fmt: skip
"""What points at another motion: none of it says what this one is."""

_COUNTED = {"tile", "step"}
"""What is counted: as a word without its count it says nothing."""

OUTLINES = {"short", "apart", "circumference", "ends", "straights", "diagonal", "area"}
"""Measures that only a drawn shape has."""


def check_extents(frame: Frame) -> None:
    """Every amount is one that can be done, and has a unit.

    Raises:
        Unclear: for one that is not.
    """
    for name, amount in frame.q.items():
        value = amount.number
        if name in _MAX_EXTENT and (not math.isfinite(value) or not 0.0 < value <= _MAX_EXTENT[name]):
            raise Unclear("bad_number", amount.text)
    if "number" in frame.q:
        raise Unclear("no_unit", frame.q["number"].text)


def check_all_used(frame: Frame, kind: str) -> None:
    """The frame says nothing beyond what a motion of this `kind` (a key of `_SLOTS`) acts on.

    Raises:
        Unclear: where it does.
    """
    left_over = [q for name, q in frame.q.items() if name not in _SLOTS[kind]]
    if left_over:
        raise Unclear("unclear_motion", f"{frame.text}")
    if "each" in frame.flags and "time" in frame.q and kind != "still" and len(frame.q) > 1:
        raise Unclear("unclear_motion", frame.text)
    if _COUNTED & set(frame.roles):
        raise Unclear("unclear_motion", frame.text)  # `a few of those units`: how many, of what?
    if _REFERRING & frame.flags or (kind in ("drive", "heading") and (frame.rot or frame.direction2)):
        raise Unclear("unclear_motion", frame.text)
