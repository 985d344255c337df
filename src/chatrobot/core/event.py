"""The base of all events, written as JSON and read again. `chatrobot.core.events` has the events."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.core.reason import Reason


@dataclass(frozen=True)
class Proposal:
    """`plan_text` runs if the very next text is a yes; `say` is the question, in the language of the person."""

    plan_text: str
    say: str


_TYPES: dict[str, type[Event]] = {}
"""The events by their names."""


@dataclass(frozen=True)
class Event:
    """Base of all events. `turn` counts the instructions of a session from 1; 0 belongs to none."""

    turn: int
    name: ClassVar[str] = ""
    unmeasured: ClassVar[tuple[str, ...]] = ()
    """The fields that nobody knows where `measured` is false: null in JSON."""

    def __init_subclass__(cls, *, name: str, unmeasured: tuple[str, ...] = ()) -> None:
        cls.name, cls.unmeasured = name, unmeasured
        _TYPES[name] = cls

    def to_json(self) -> dict[str, Any]:
        """Make the object of one `--json` line; `event_from_json` reads it."""
        unknown = () if getattr(self, "measured", True) else self.unmeasured
        values = {
            name: None if name in unknown else _plain(getattr(self, name))
            for name in _annotations(type(self))
        }
        return {"event": self.name, **values}


_ANNOTATIONS: dict[type[Event], dict[str, str]] = {}


def _annotations(kind: type[Event]) -> Mapping[str, str]:
    """The fields of an event in their order, and what they hold; looked up once."""
    if kind not in _ANNOTATIONS:
        _ANNOTATIONS[kind] = {f.name: str(f.type) for f in dataclasses.fields(kind)}
    return _ANNOTATIONS[kind]


def _plain(value: Any) -> Any:
    """JSON's own types: a Pose and a Twist become objects with their units in the keys."""
    if isinstance(value, float):
        return round(value, 6)
    if isinstance(value, (Pose, Twist)):
        return {key: round(number, 6) for key, number in zip(value._fields, value)}
    if isinstance(value, Proposal):
        return dataclasses.asdict(value)
    if isinstance(value, (Reason, Event)):
        return value.to_json()
    if isinstance(value, (tuple, list)):
        return [_plain(item) for item in value]
    return value


def strict_json(data: Any, *, is_compact: bool = False) -> str:
    """Write JSON that everybody reads: NaN and infinity, which a robot may report, become null."""
    separators = (",", ":") if is_compact else None
    try:
        return json.dumps(data, ensure_ascii=False, allow_nan=False, separators=separators)
    except ValueError:
        return json.dumps(finite(data), ensure_ascii=False, separators=separators)


def finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def event_from_json(data: Mapping[str, Any]) -> Event:
    """The event that `to_json` made `data` of.

    Raises:
        ValueError: no event of ours has that name or those fields.
    """
    kind = _TYPES.get(str(data.get("event")))
    if kind is None:
        raise ValueError(f"no such event: {data.get('event')!r}")
    values = {key: value for key, value in data.items() if key != "event"}
    annotations = _annotations(kind)
    try:
        readers = {key: _READERS.get(annotations[key], lambda found: found) for key in values}
        return kind(**{key: readers[key](value) for key, value in values.items()})
    except (KeyError, TypeError) as error:
        raise ValueError(f"not a {kind.name} event: {error}") from error


def _optional(read: Callable[[Any], Any]) -> Callable[[Any], Any]:
    return lambda value: None if value is None else read(value)


_READERS: Mapping[str, Any] = {
    "Pose": lambda value: ORIGIN if value is None else Pose(**value),
    "Pose | None": _optional(lambda value: Pose(**value)),
    "float": lambda value: 0.0 if value is None else value,
    "Twist": lambda value: Twist(**value),
    "Reason": Reason.from_json,
    "Reason | None": _optional(Reason.from_json),
    "Proposal | None": _optional(lambda value: Proposal(str(value["plan_text"]), str(value["say"]))),
    "tuple[int, ...]": tuple,
    "tuple[float | None, ...]": tuple,
    "tuple[str, ...]": tuple,
    "tuple[FindingSeen, ...]": lambda value: tuple(event_from_json(item) for item in value),
    "tuple[tuple[float, float], ...]": lambda value: tuple(tuple(item) for item in value),
    "tuple[tuple[float, float, float], ...]": lambda value: tuple(tuple(item) for item in value),
}
