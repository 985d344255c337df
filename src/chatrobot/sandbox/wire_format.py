"""What the host and the warm server say to each other: a length, JSON, then raw bytes; descriptors ride along."""

from __future__ import annotations

import json
import socket
import struct
from typing import Any

_LENGTHS = struct.Struct("=II")
_MOST_DESCRIPTORS = 4


def send(
    line: socket.socket, said: dict[str, Any], raw: bytes = b"", descriptors: tuple[int, ...] = ()
) -> None:
    """Raises: OSError: the other end is gone."""
    text = json.dumps(said).encode()
    head = _LENGTHS.pack(len(text), len(raw))
    if descriptors:
        socket.send_fds(line, [head], list(descriptors))
    else:
        line.sendall(head)
    line.sendall(text + raw)


def receive(line: socket.socket) -> tuple[dict[str, Any], bytes, list[int]]:
    """Raises: EOFError: the other end is gone."""
    head, descriptors, _, _ = socket.recv_fds(line, _LENGTHS.size, _MOST_DESCRIPTORS)
    head += _exactly(line, _LENGTHS.size - len(head)) if head else b""
    if not head:
        raise EOFError
    text_bytes, raw_bytes = _LENGTHS.unpack(head)
    return json.loads(_exactly(line, text_bytes)), _exactly(line, raw_bytes), descriptors


def _exactly(line: socket.socket, wanted: int) -> bytes:
    parts: list[bytes] = []
    while wanted > 0:
        part = line.recv(min(wanted, 1 << 20))
        if not part:
            raise EOFError
        parts.append(part)
        wanted -= len(part)
    return b"".join(parts)
