"""Messages as bytes for the local wire: `topic NUL type NUL JSON array`.

JSON keeps it readable in a debugger and costs about as much as a hand-made binary format would in Python.
"""

from __future__ import annotations

import json
from typing import Any

from chatrobot.wire.messages import MESSAGE_TYPES, Message

_TYPES: dict[bytes, type] = {kind.__name__.encode(): kind for kind in MESSAGE_TYPES}


def encode(topic: str, message: Message) -> bytes:
    """The bytes of one message."""
    body = json.dumps(message, separators=(",", ":"))
    return f"{topic}\0{type(message).__name__}\0{body}".encode()


def topic_of(packet: bytes) -> str:
    """The topic of an encoded message, without decoding the rest."""
    return packet.partition(b"\0")[0].decode(errors="replace")


def decode(packet: bytes) -> Message | None:
    """The message in `packet`; None where it is not one of ours (a wire never dies of a bad packet)."""
    _, _, rest = packet.partition(b"\0")
    type_name, _, body = rest.partition(b"\0")
    kind = _TYPES.get(type_name)
    if kind is None:
        return None
    try:
        fields: Any = json.loads(body)
        return kind(*fields)  # type: ignore[no-any-return]
    except (ValueError, TypeError):
        return None
