"""The tutorial's form of a velocity: a line such as `linear.x = 1,linear.y = 0,…,angular.z = 0`, for one second.

It counts only where a line consists wholly of its assignments, never inside prose.
"""

from __future__ import annotations

import math
import re

from chatrobot.plan.primitives.twist import RawTwist

DURATION_S = 1.0
"""How long a line moves the robot."""

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
_ASSIGNMENT = rf"(linear|angular)\s*\.\s*([xyz])\s*=\s*({NUMBER}|[-+]?(?:inf|nan)\w*)"
_FIND = re.compile(_ASSIGNMENT)
_LINE = re.compile(rf"\s*[\"'“]?\s*{_ASSIGNMENT}(?:\s*[,，;]\s*{_ASSIGNMENT})*\s*[.,;，]?\s*[\"'”]?\s*")


class ImpossibleTwistError(ValueError):
    """A velocity that cannot be. `code`: `bad_number` (not finite) or `not_planar`."""

    def __init__(self, code: str) -> None:
        super().__init__(code)
        self.code = code


def read_tutorial_line(line: str) -> RawTwist | None:
    """The velocity that `line` assigns, None where it is anything else.

    Raises:
        ImpossibleTwistError: it is of that form, and no planar robot can do it.
    """
    line = line.lower()
    if "\n" in line.strip() or not _LINE.fullmatch(line):
        return None
    found = {f"{group}.{axis}": _number(value) for group, axis, value in _FIND.findall(line)}
    return twist_from(found, DURATION_S)


def twist_from(values: dict[str, float], duration_s: float) -> RawTwist:
    """The raw velocity of assignments by name (`linear.x`, m/s; `angular.z`, rad/s); what is missing is zero.

    Raises:
        ImpossibleTwistError: see there.
    """
    if not all(math.isfinite(value) for value in values.values()):
        raise ImpossibleTwistError("bad_number")
    if any(values.get(name) for name in ("linear.z", "angular.x", "angular.y")):
        raise ImpossibleTwistError("not_planar")
    return RawTwist(
        values.get("linear.x", 0.0), values.get("linear.y", 0.0), values.get("angular.z", 0.0), duration_s
    )


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan  # `infinitely` and the like
