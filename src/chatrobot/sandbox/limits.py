"""What the host asks of the warm server: the limits of a program, the walls it wants, and the messages between them."""

from __future__ import annotations

import json
import socket
import struct
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class SandboxLimits:
    """Limits of one program. What goes beyond ends it, or is refused inside it, and never harms its neighbours.

    Args:
        memory_bytes: address space beyond what the warm server had; more is a MemoryError inside.
        cpu_s: processor time, whole seconds; then it is killed. The default lasts hours for a program that waits.
        wall_s: time on the clock from launch to the end; None for no limit (a program that drives for an hour).
        threads: threads at once, its first included; more is a RuntimeError inside.
        log_bytes: what is kept of its output; the rest is counted and dropped.
        file_bytes: the largest file. It can open none, so this is a second wall.
        descriptors: open descriptors (pipes and socket pairs of its own).
    """

    memory_bytes: int = 256 << 20
    cpu_s: int = 600
    wall_s: float | None = None
    threads: int = 64
    log_bytes: int = 256 << 10
    file_bytes: int = 0
    descriptors: int = 64


@dataclass(frozen=True)
class Layers:
    """Walls wanted beside the filter, the limits and the clean environment, which are always there.

    Args:
        landlock: the kernel's wall around files, TCP and abstract sockets.
        namespaces: an empty world without files, network and other processes.
        bubblewrap: may make it, where we may not (its own program, which some machines trust more).
    """

    landlock: bool = True
    namespaces: bool = True
    bubblewrap: bool = True


_LENGTHS = struct.Struct("=II")
_MOST_DESCRIPTORS = 4


def send_message(
    line: socket.socket, said: dict[str, Any], raw: bytes = b"", descriptors: tuple[int, ...] = ()
) -> None:
    """Send JSON, raw bytes behind it, and descriptors.

    Raises:
        OSError: the other end is gone.
    """
    text = json.dumps(said).encode()
    head = _LENGTHS.pack(len(text), len(raw))
    if descriptors:
        socket.send_fds(line, [head], list(descriptors))
    else:
        line.sendall(head)
    line.sendall(text + raw)


def receive_message(line: socket.socket) -> tuple[dict[str, Any], bytes, list[int]]:
    """Receive what `send_message` sent.

    Raises:
        EOFError: the other end is gone.
    """
    head, descriptors, _, _ = socket.recv_fds(line, _LENGTHS.size, _MOST_DESCRIPTORS)
    head += _exactly(line, _LENGTHS.size - len(head)) if head else b""
    if not head:
        raise EOFError
    text_bytes, raw_bytes = _LENGTHS.unpack(head)
    return json.loads(_exactly(line, text_bytes)), _exactly(line, raw_bytes), descriptors


def _exactly(line: socket.socket, wanted_bytes: int) -> bytes:
    parts: list[bytes] = []
    while wanted_bytes > 0:
        part = line.recv(min(wanted_bytes, 1 << 20))
        if not part:
            raise EOFError
        parts.append(part)
        wanted_bytes -= len(part)
    return b"".join(parts)
