"""Messages as bytes for the local wire: `topic NUL type NUL JSON array`.

JSON keeps it readable in a debugger and costs about as much as a hand-made binary format would in Python. Bytes are
base64 in it, as rosbridge has them, too.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from typing import Any, get_type_hints

from chatrobot.wire.messages import MESSAGE_TYPES, Message


def encode(topic: str, message: Message) -> bytes:
    """The bytes of one message."""
    return f"{topic}\0{type(message).__name__}\0{_ENCODER.encode(message)}".encode()


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
    kind, readers = known
    try:
        fields: Any = _DECODER.decode(body.decode())
        if type(fields) is not list or len(fields) != len(readers):
            return None
        return kind(*[read(value) for read, value in zip(readers, fields)])
    except (ValueError, TypeError, OverflowError, RecursionError):
        return None


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


_READERS: dict[Any, Callable[[Any], Any]] = {
    float: _number, list[float]: _numbers, str: _text, bool: _flag, int: _whole, bytes: _bytes,
}  # fmt: skip
_KINDS: dict[bytes, tuple[Callable[..., Message], list[Callable[[Any], Any]]]] = {
    kind.__name__.encode(): (kind, [_READERS[hint] for hint in get_type_hints(kind).values()])
    for kind in MESSAGE_TYPES
}
