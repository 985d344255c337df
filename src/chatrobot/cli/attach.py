"""How `chatrobot mcp` finds a web console of this user, and passes its standard input and output on to it."""

from __future__ import annotations

import argparse
import contextlib
import os
import socket
import sys
import threading

from chatrobot.wire.runtime_dir import agent_socket_paths

STDIN, STDOUT = 0, 1
READ_BYTES = 65_536
CONNECT_S = 2.0
END_S = 2.0
_NOTHING_CHOSEN = {
    "on": "auto", "world": "", "sim": "", "model": "", "http": False, "open_loop": False, "yes": False,
    "approve": False, "max_distance": None, "max_time": None, "record": None,
}  # fmt: skip
"""With anything else a person has chosen a robot of their own, or how it is to be driven."""


def attachable(args: argparse.Namespace) -> socket.socket | None:
    """Connect to the web console of this user that was started last; None where none runs, or a robot was chosen."""
    if args.names_robot or any(getattr(args, name) != value for name, value in _NOTHING_CHOSEN.items()):
        return None
    for path in agent_socket_paths():
        host = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        host.settimeout(CONNECT_S)
        try:
            host.connect(str(path))
        except ConnectionRefusedError:
            path.unlink(missing_ok=True)  # left behind by one that was killed
        except OSError:
            pass  # it does not answer
        else:
            host.settimeout(None)
            return host
        host.close()
    return None


def pass_on(host: socket.socket) -> int:
    """Pass on until the client has left, or the host; the host stops what this client's calls move. Return 0, or 1."""
    has_left = threading.Event()
    threading.Thread(target=_send, args=(host, has_left), name="to-host", daemon=True).start()
    answered = threading.Thread(target=_receive, args=(host,), name="from-host", daemon=True)
    answered.start()
    while answered.is_alive():
        if has_left.is_set():
            answered.join(END_S)
            return 0
        answered.join(0.1)
    if has_left.is_set():
        return 0
    print("chatrobot: the web console has ended, and with it the robot of this agent", file=sys.stderr)
    return 1


def _send(host: socket.socket, has_left: threading.Event) -> None:
    with contextlib.suppress(OSError):
        while data := os.read(STDIN, READ_BYTES):
            host.sendall(data)
    has_left.set()
    with contextlib.suppress(OSError):
        host.shutdown(socket.SHUT_WR)


def _receive(host: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while data := host.recv(READ_BYTES):
            view = memoryview(data)
            while view:
                view = view[os.write(STDOUT, view) :]
