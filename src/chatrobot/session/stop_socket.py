"""Where `chatrobot stop` reaches Motion: a socket of its own, past everything else that Motion hears."""

from __future__ import annotations

import contextlib
import os
import socket
from collections.abc import Callable

from chatrobot.wire.runtime_dir import stop_socket_path


def serve_stop(halt: Callable[[], None], is_busy: Callable[[], bool]) -> None:
    """For ever: any packet on this process's socket stops, and is answered when the zero is out."""
    path = stop_socket_path(os.getpid())
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        with contextlib.suppress(FileNotFoundError):
            path.unlink()
        listener.bind(str(path))
        listener.listen(4)
        while True:
            caller, _ = listener.accept()
            with caller:
                halt()
                with contextlib.suppress(OSError):
                    caller.send(b"moving" if is_busy() else b"standing")


def remove_stop_socket() -> None:
    """Nobody serves it any more."""
    with contextlib.suppress(OSError):
        stop_socket_path(os.getpid()).unlink()
