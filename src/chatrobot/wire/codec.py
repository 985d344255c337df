"""Messages as bytes for the local wire: `topic NUL type NUL body`.

The body is a JSON array, which a debugger can read and anybody can write; bytes are base64 in it, as rosbridge has
them, too. What comes hundreds of times a second holds nothing but numbers, and as text they take ten times as long: of
such a message the body is the numbers themselves, and `#` stands before its type.
"""

from __future__ import annotations

import base64
import json
import struct
from array import array
from collections.abc import Callable
from functools import lru_cache
from typing import Any, get_type_hints

from chatrobot.wire.messages import MESSAGE_TYPES, LaserScan, Message


def encode(topic: str, message: Message) -> bytes:
    """The bytes of one message."""
    kind = type(message)
    layout = _LAYOUTS.get(kind)
    if layout is not None:
        return _head(topic, f"#{kind.__name__}") + layout.pack(*message)
    if isinstance(message, LaserScan):
        numbers = array("d", message.ranges_m)
        return _head(topic, "#LaserScan") + _SCAN.pack(*message[:-1]) + numbers.tobytes()
    return _head(topic, kind.__name__) + _ENCODER.encode(message).encode()


@lru_cache(maxsize=1000)
def _head(topic: str, type_name: str) -> bytes:
    return f"{topic}\0{type_name}\0".encode()


def as_base64(value: object) -> str:
    """Return what `json` does not know: bytes."""
    if isinstance(value, bytes):
        return base64.b64encode(value).decode()
    raise TypeError(f"no message holds a {type(value).__name__}")


_ENCODER = json.JSONEncoder(separators=(",", ":"), default=as_base64)
_DECODER = json.JSONDecoder()
"""Made once: `json.dumps` and `json.loads` would make or look for one with every message."""


def topic_of(packet: bytes) -> str:
    """The topic of an encoded message, without decoding the rest."""
    return packet.partition(b"\0")[0].decode(errors="replace")


def decode(packet: bytes) -> Message | None:
    """The message in `packet`; None where it is not one of ours (a wire never dies of a bad packet).

    What comes out has the types its fields are declared with: who receives a velocity need not ask whether it is
    a number.
    """
    _, _, rest = packet.partition(b"\0")
    type_name, _, body = rest.partition(b"\0")
    known = _KINDS.get(type_name)
    if known is None:
        return None
    kind, read = known
    try:
        return kind(*read(body))
    except (struct.error, ValueError, TypeError, OverflowError, RecursionError):
        return None


def _read_scan(body: bytes) -> tuple[Any, ...]:
    ranges_m = array("d", body[_SCAN.size :])
    return (*_SCAN.unpack_from(body), ranges_m.tolist())


def _json_reader(kind: type[Message]) -> Callable[[bytes], list[Any]]:
    readers = [_READERS[hint] for hint in _HINTS[kind]]

    def read(body: bytes) -> list[Any]:
        fields: Any = _DECODER.decode(body.decode())
        if type(fields) is not list or len(fields) != len(readers):
            raise ValueError("not the fields of that message")
        return [read_field(value) for read_field, value in zip(readers, fields)]

    return read


def _number(value: Any) -> float:
    if type(value) is float:
        return value
    if type(value) is int:
        return float(value)
    raise TypeError("not a number")


def _whole(value: Any) -> int:
    if type(value) is not int:
        raise TypeError("not a whole number")
    return value


def _bytes(value: Any) -> bytes:
    return base64.b64decode(_text(value), validate=True)


def _numbers(value: Any) -> list[float]:
    if type(value) is not list:
        raise TypeError("not a list")
    return value if set(map(type, value)) <= {float} else [_number(item) for item in value]


def _text(value: Any) -> str:
    if type(value) is not str:
        raise TypeError("not text")
    return value


def _flag(value: Any) -> bool:
    if type(value) is not bool:
        raise TypeError("neither true nor false")
    return value


_HINTS = {kind: list(get_type_hints(kind).values()) for kind in MESSAGE_TYPES}
_LAYOUTS: dict[type, struct.Struct] = {
    kind: struct.Struct(f"={len(hints)}d") for kind, hints in _HINTS.items() if set(hints) == {float}
}
_SCAN = struct.Struct(f"={len(_HINTS[LaserScan]) - 1}d")
_READERS: dict[Any, Callable[[Any], Any]] = {
    float: _number, list[float]: _numbers, str: _text, bool: _flag, int: _whole, bytes: _bytes,
}  # fmt: skip
_KINDS: dict[bytes, tuple[Callable[..., Message], Callable[[bytes], Any]]] = {
    **{kind.__name__.encode(): (kind, _json_reader(kind)) for kind in MESSAGE_TYPES},
    **{f"#{kind.__name__}".encode(): (kind, layout.unpack) for kind, layout in _LAYOUTS.items()},
    b"#LaserScan": (LaserScan, _read_scan),
}
