"""A fence around DDS in LOCALHOST range: the kernel drops what other machines send to this domain's sockets.

A short time to live keeps our multicasts here, but Cyclone answers whoever else is heard, and then both talk.
ROS's own LOCALHOST leaves multicast out instead, and then never meets who speaks by multicast alone. Linux lets
any process put a packet filter on its own sockets (socket(7), SO_ATTACH_FILTER).
"""

from __future__ import annotations

import ctypes
import os
import socket
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path

_SO_ATTACH_FILTER = 26
# Classic BPF (linux/filter.h): opcodes, and where in a packet IPv4 keeps its source.
_LOAD, _AND, _JUMP_IF_EQUAL, _RETURN = 0x20, 0x54, 0x15, 0x06
_SOURCE = 0xFFF0_0000 + 12
_WHOLE = 0x0004_0000


def fence_in(domain_id: int, addresses: Sequence[str]) -> int:
    """Let the sockets of this process and domain hear this machine alone; how many there are.

    Args:
        addresses: this machine's IPv4 addresses; the loopback's are always let through.

    Raises:
        OSError: this system has no packet filters.
    """
    program = _only_from(addresses)
    sockets = list(_sockets(domain_id))
    for found in sockets:
        with found:
            _attach(found, program)
    return len(sockets)


def _sockets(domain_id: int) -> Iterator[socket.socket]:
    """Duplicates of the sockets on a domain's ports (OMG DDSI-RTPS 2.5, 9.6.2)."""
    first_port = 7400 + 250 * domain_id
    for entry in Path("/proc/self/fd").iterdir():
        try:
            if not os.readlink(entry).startswith("socket:"):
                continue
            found = socket.socket(fileno=os.dup(int(entry.name)))
        except OSError:
            continue  # closed meanwhile
        datagrams = found.family == socket.AF_INET and found.type == socket.SOCK_DGRAM
        if datagrams and first_port <= found.getsockname()[1] < first_port + 250:
            yield found
        else:
            found.close()


def _only_from(addresses: Sequence[str]) -> list[bytes]:
    known = [int.from_bytes(socket.inet_aton(address), "big") for address in addresses]
    accept = len(known) + 4  # the last instruction
    program = [_instruction(_LOAD, value=_SOURCE)]
    for index, address in enumerate(known, start=1):
        program.append(_instruction(_JUMP_IF_EQUAL, accept - index - 1, 0, address))
    program.append(_instruction(_AND, value=0xFF00_0000))
    program.append(_instruction(_JUMP_IF_EQUAL, 1, 0, 0x7F00_0000))
    program.append(_instruction(_RETURN))
    program.append(_instruction(_RETURN, value=_WHOLE))
    return program


def _instruction(opcode: int, if_true: int = 0, if_false: int = 0, value: int = 0) -> bytes:
    return struct.pack("HBBI", opcode, if_true, if_false, value)


def _attach(target: socket.socket, program: list[bytes]) -> None:
    code = ctypes.create_string_buffer(b"".join(program))
    target.setsockopt(
        socket.SOL_SOCKET, _SO_ATTACH_FILTER, struct.pack("HL", len(program), ctypes.addressof(code))
    )
