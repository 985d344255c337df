"""Numbers as a person reads them: millimetres and tenths of a degree, no "-0.00", no float noise."""

from __future__ import annotations

LENGTH_PLACES, ANGLE_PLACES = 3, 1
_NOISE = 1e-6
"""What is smaller is rounding of floats, and nothing that anybody has asked for."""


def fixed(value: float, places: int) -> str:
    """`value` with exactly so many decimals; what is rounded to nothing has no sign."""
    text = f"{value:.{places}f}"
    return text.lstrip("-") if not float(text) else text


def number(value: float, places: int = LENGTH_PLACES) -> str:
    """`value` with at most so many decimals. One that is smaller, and no noise, keeps its first digit."""
    text = fixed(value, places)
    if not float(text) and abs(value) >= _NOISE:
        return fixed(value, -_exponent(value))
    return text.rstrip("0").rstrip(".") if "." in text else text


def _exponent(value: float) -> int:
    """Of ten, where the first digit of `value` stands."""
    return int(f"{value:e}".partition("e")[2])
