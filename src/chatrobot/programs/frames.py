"""Frames on the pipe between a sandboxed program and its host: a length, and a list in JSON. Both sides use this.

Nothing that comes out of the sandbox is trusted: a frame is bounded, and whatever is not a list that begins
with a word is a `PipeError`.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from typing import Any

from chatrobot.core.errors import ChatRobotError

LARGEST_FROM_PROGRAM = 64 * 1024
LARGEST_FROM_HOST = 1024 * 1024
_LENGTH = struct.Struct("!I")


class PipeError(ChatRobotError):
    """The other side does not speak the protocol."""


def encode(word: str, *values: Any) -> bytes:
    """Return one frame."""
    body = json.dumps([word, *values], separators=(",", ":")).encode()
    return _LENGTH.pack(len(body)) + body


class FrameReader:
    """Takes bytes as they come and gives whole frames.

    Args:
        largest: bytes; who announces a longer frame breaks the protocol.
    """

    def __init__(self, largest: int) -> None:
        self._largest = largest
        self._buffer = bytearray()

    def feed(self, data: bytes) -> Iterator[list[Any]]:
        """Yield the frames that are whole with `data`. Raises PipeError."""
        self._buffer += data
        begin = 0
        try:
            while len(self._buffer) - begin >= _LENGTH.size:
                (length,) = _LENGTH.unpack_from(self._buffer, begin)
                if length > self._largest:
                    raise PipeError(f"a frame of {length} bytes")
                end = begin + _LENGTH.size + length
                if len(self._buffer) < end:
                    break
                body = bytes(self._buffer[begin + _LENGTH.size : end])
                begin = end
                yield _decoded(body)
        finally:
            del self._buffer[:begin]


def _decoded(body: bytes) -> list[Any]:
    try:
        frame = json.loads(body)
    except (ValueError, RecursionError) as error:
        raise PipeError("a frame that is no JSON") from error
    if not isinstance(frame, list) or not frame or not isinstance(frame[0], str):
        raise PipeError("a frame without a word")
    return frame
