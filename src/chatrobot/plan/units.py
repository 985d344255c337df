"""The units plan text understands, and the shortest text for a number that reads back as exactly that number."""

from __future__ import annotations

import math
from collections.abc import Callable

Convert = Callable[[float], float]


def _same(value: float) -> float:
    return value


def _divided(divisor: float) -> Convert:
    """Division, not multiplication: 35 cm is 35/100, the double nearest to 0.35."""
    return lambda value: value / divisor


def _times(factor: float) -> Convert:
    return lambda value: value * factor


def _spellings(**groups: Convert) -> dict[str, Convert]:
    """Keys are spellings joined by two underscores."""
    return {word: convert for words, convert in groups.items() for word in words.split("__")}


LENGTHS: dict[str, Convert] = _spellings(
    m__metre__metres__meter__meters=_same,
    cm__centimetre__centimetres__centimeter__centimeters=_divided(100.0),
    mm__millimetre__millimetres__millimeter__millimeters=_divided(1000.0),
    km__kilometre__kilometres__kilometer__kilometers=_times(1000.0),
    ft__foot__feet=_times(0.3048),
)
TIMES: dict[str, Convert] = _spellings(
    s__sec__secs__second__seconds=_same,
    ms__millisecond__milliseconds=_divided(1000.0),
    min__mins__minute__minutes=_times(60.0),
)
ANGLES: dict[str, Convert] = {
    "°": math.radians,
    **_spellings(
        deg__degree__degrees=math.radians,
        rad__radian__radians=_same,
        rev__turn__turns__revolution__revolutions=_times(2.0 * math.pi),
    ),
}
SPEEDS: dict[str, Convert] = {"m/s": _same, "mps": _same, "cm/s": _divided(100.0), "km/h": _divided(3.6)}
RATES: dict[str, Convert] = {
    "rad/s": _same,
    "radps": _same,
    "deg/s": math.radians,
    "°/s": math.radians,
    "rpm": _times(math.pi / 30.0),
}


def number_text(value: float) -> str:
    """The shortest decimal that reads back as `value`; whole numbers without a point."""
    if value == int(value) and abs(value) < 1e15:
        return str(int(value))
    return repr(float(value))


def _degrees_text(angle_rad: float) -> str | None:
    """The shortest decimal of degrees that reads back as exactly `angle_rad`, if there is one."""
    degrees = math.degrees(angle_rad)
    if abs(degrees) > 1e15:
        return None
    for digits in (3, 6, 9, 12, 15, 16, 17):
        text = number_text(float(f"{degrees:.{digits}g}"))
        if math.radians(float(text)) == angle_rad:
            return text
    return None


def angle_text(angle_rad: float, *, suffix: str = "", prefer_degrees: bool = True) -> str:
    """Degrees or radians (`suffix` "/s" for rates), whichever reads back exactly and is shorter to read."""
    in_radians, in_degrees = number_text(angle_rad), _degrees_text(angle_rad)
    if in_degrees is None:
        return f"{in_radians} rad{suffix}"
    shorter = len(in_degrees) - len(in_radians)
    use_degrees = prefer_degrees if shorter == 0 else shorter < 0
    return f"{in_degrees} deg{suffix}" if use_degrees else f"{in_radians} rad{suffix}"
