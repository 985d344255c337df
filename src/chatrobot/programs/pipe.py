"""The pipe between a sandboxed program and its host, as both ends use it: settings at its start, then frames.

A frame is a length and a list in JSON. Nothing that comes out of the sandbox is trusted: a frame is bounded, and
whatever is not a list that begins with a word is a `PipeError`.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from chatrobot.core.errors import ChatRobotError
from chatrobot.core.wiring import Wiring

LATEST_S = 1e6
"""No program lives longer: eleven days."""

Mode = Literal["virtual", "live"]


@dataclass(frozen=True)
class ProgramSettings:
    """All that goes into the sandbox besides the code that is there anyway.

    `topics` maps what the robot has (cmd_vel, odom, scan, imu, battery, bumper) to resolved ROS names (`/cmd_vel`).
    `remaps` maps names as ROS's remapping does (`/turtle1/cmd_vel` to `/cmd_vel`); `args` are its command-line
    arguments, which go before them where they remap.
    `start_ns` is the wall clock at the program's start on virtual time, `horizon_s` where virtual time ends.
    """

    source: str
    name: str = "program"
    mode: Mode = "virtual"
    topics: Mapping[str, str] = field(default_factory=dict)
    odom_type: str = "Odometry"
    remaps: Mapping[str, str] = field(default_factory=dict)
    args: tuple[str, ...] = ()
    start_ns: int = 1_800_000_000_000_000_000
    horizon_s: float = math.inf

    def to_bytes(self) -> bytes:
        """Return them as the sandbox gets them."""
        return json.dumps(asdict(self)).encode()

    @classmethod
    def from_bytes(cls, data: bytes) -> ProgramSettings:
        """Read what `to_bytes` made."""
        values = json.loads(data)
        return cls(**{**values, "args": tuple(values["args"])})


def robot_topics(wiring: Wiring) -> dict[str, str]:
    """Return the topics of one robot by what they are, resolved."""
    topics = {"cmd_vel": wiring.cmd_vel_topic, **wiring.sensor_topics}
    return {name: f"/{topic.lstrip('/')}" for name, topic in topics.items()}


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
        largest_bytes: who announces a longer frame breaks the protocol.
    """

    def __init__(self, largest_bytes: int) -> None:
        self._largest_bytes = largest_bytes
        self._buffer = bytearray()

    def feed(self, data: bytes) -> Iterator[list[Any]]:
        """Yield the frames that are whole with `data`. Raises PipeError."""
        self._buffer += data
        begin = 0
        try:
            while len(self._buffer) - begin >= _LENGTH.size:
                (length,) = _LENGTH.unpack_from(self._buffer, begin)
                if length > self._largest_bytes:
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
