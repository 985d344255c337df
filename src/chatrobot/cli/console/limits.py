"""What stands behind `/limit`: amounts of the motion budget, such as `200 m`, `20 min` and `none`."""

from __future__ import annotations

import re
from collections.abc import Mapping

from chatrobot.core.motion_budget import NONE

_DISTANCES: Mapping[str, float] = {"m": 1.0, "km": 1000.0}
_TIMES: Mapping[str, float] = {"s": 1.0, "min": 60.0, "h": 3600.0}
_AMOUNT = re.compile(rf"({NONE}|\d+(?:\.\d+)?|\.\d+)\s*(km|m|min|s|h)?(?![\w.])[\s,]*", re.ASCII)


def read_limits(text: str) -> dict[str, float | str] | None:
    """The payload of a `limit` envelope; None where `text` is no amounts. `none` without a unit lifts both limits."""
    found: dict[str, float | str] = {}
    rest = text.strip().casefold()
    while rest:
        match = _AMOUNT.match(rest)
        if match is None or not _note(match[1], match[2] or "", found):
            return None
        rest = rest[match.end() :]
    return found


def _note(amount: str, unit: str, found: dict[str, float | str]) -> bool:
    """Note one amount; False where it cannot be one, or is the second of its kind."""
    if amount != NONE and (not unit or float(amount) <= 0.0):
        return False
    for name, factors in (("max_distance_m", _DISTANCES), ("max_time_s", _TIMES)):
        if unit and unit not in factors:
            continue
        if name in found:
            return False
        found[name] = NONE if amount == NONE else float(amount) * factors[unit]
    return True
