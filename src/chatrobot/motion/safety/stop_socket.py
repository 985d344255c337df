"""Where `chatrobot stop` reaches Motion: a socket of its own, past everything else that Motion hears."""

from __future__ import annotations

import contextlib
import os
import socket
from collections.abc import Callable

from chatrobot.wire.runtime_dir import stop_socket_path


def serve_stop(stop: Callable[[], str]) -> None:
    """For ever: who calls on this process's socket stops the robot, and is answered when the zero is out.

    Args:
        stop: stops, and returns in a word what was found.
    """
    path = stop_socket_path(os.getpid())
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        with contextlib.suppress(FileNotFoundError):
            path.unlink()
        listener.bind(str(path))
        listener.listen(4)
        while True:
            caller, _ = listener.accept()
            with caller:
                found = stop()
                with contextlib.suppress(OSError):
                    caller.send(found.encode())


def remove_stop_socket() -> None:
    """Nobody serves it any more."""
    with contextlib.suppress(OSError):
        stop_socket_path(os.getpid()).unlink()
