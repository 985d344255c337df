"""What a page may say: JSON objects with a `do`, each field checked before anything is done with it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from typing import Any

from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.plan.primitives.drive import MAX_PLACE_CHARS
from chatrobot.programs.check import MAX_SOURCE_CHARS

MOST_BYTES = 64 * 1024
"""Of one message, either way in."""
MOST_TEXT_CHARS = 4000
MOST_PLAN_CHARS = 60_000
FURTHEST_M = 1000.0
"""A point on the floor further away than this is none."""
FASTEST = 100.0
"""A stick further out than this, m/s or rad/s, is broken; the governor caps what is below."""

_Check = Callable[[object], bool]


class MalformedError(ValueError):
    """A message is none of ours; its text says why, for whoever wrote the page."""


def is_text(most_chars: int) -> _Check:
    """Return the check of a text that is no longer than that."""
    return lambda value: isinstance(value, str) and len(value) <= most_chars


def _number(most: float) -> _Check:
    def is_number(value: object) -> bool:
        is_one = isinstance(value, (int, float)) and not isinstance(value, bool)
        return is_one and math.isfinite(value) and abs(value) <= most  # type: ignore[arg-type]

    return is_number


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


def _is_count(value: object) -> bool:
    return type(value) is int and value >= 0


def _is_name_of_place(value: object) -> bool:
    return isinstance(value, str) and value.isprintable() and len(value) <= MAX_PLACE_CHARS


def _or_none(check: _Check) -> _Check:
    return lambda value: value is None or check(value)


_TEXT, _PLAN, _NAME = is_text(MOST_TEXT_CHARS), is_text(MOST_PLAN_CHARS), is_text(80)
_POINT, _SPEED = _number(FURTHEST_M), _number(FASTEST)
Fields = Mapping[str, Mapping[str, _Check]]
FIELDS: Fields = {
    "say": {"text": _TEXT},
    "say_plan": {"plan_text": _PLAN},
    "approve": {"turn": _is_count, "yes": _is_flag},
    "edit": {"plan_text": _PLAN, "turn": _is_count},
    "go": {
        "x_m": _POINT,
        "y_m": _POINT,
        "yaw_rad?": _or_none(_number(100.0)),
        "ask?": _is_flag,
        "place?": _is_name_of_place,
        "text?": _TEXT,
    },
    "obstacle": {"name": _NAME, "x_m?": _POINT, "y_m?": _POINT, "radius_m?": _number(5.0)},
    "pause": {},
    "resume": {},
    "stop": {},
    "emergency_stop": {},
    "release": {},
    "steer": {"vx_mps": _SPEED, "vy_mps": _SPEED, "wz_radps": _SPEED},
    "beat": {"held?": _is_flag},
    "take": {},
    "give": {},
    "programs": {},
    "program": {"name": _NAME},
    "run_program": {"name": _NAME},
    "edit_program": {"name": _NAME, "source": is_text(MAX_SOURCE_CHARS)},
    "language": {"code": lambda value: value in REPLY_LANGUAGES},
    "history": {},
    "look": {},
}
"""All that may be said, with a check for every field; one with a question mark may be left out."""


def read_message(text: str, fields: Fields = FIELDS) -> dict[str, Any]:
    """Read one message of a page that may say what `fields` has.

    Raises:
        MalformedError: it is none: what it says is not done, not even in part.
    """
    try:
        said: Any = json.loads(text)
    except (ValueError, RecursionError):
        raise MalformedError("not JSON") from None
    data: dict[str, Any] = said if isinstance(said, dict) else {}
    do = data.get("do")
    if not isinstance(do, str) or do not in fields:
        raise MalformedError("not an object with a known 'do'")
    known = {name.rstrip("?"): check for name, check in fields[do].items()}
    for name in fields[do]:
        if not name.endswith("?") and name not in data:
            raise MalformedError(f"{do}: {name} is missing")
    for name in data.keys() - {"do"}:
        if name not in known:
            raise MalformedError(f"{do}: no field {name[:40]!r} is known")
        if not known[name](data[name]):
            raise MalformedError(f"{do}: {name} is not what it may be")
    return data
