"""Processes of ours: how every one of them is started."""

from __future__ import annotations

import socket
import subprocess
import sys
from collections.abc import Sequence


def spawn(module: str, *arguments: str, pass_fds: Sequence[int] = ()) -> subprocess.Popen[bytes]:
    """Start `python -m MODULE ARGUMENTS` in a session of its own, so that no signal of a terminal reaches it.

    Spawned, never forked: a forked child would hold descriptors of ours, and nobody would see them end.
    """
    return subprocess.Popen(
        [sys.executable, "-m", module, *arguments],
        pass_fds=pass_fds,
        start_new_session=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )


def spawn_with_line(
    module: str, *arguments: str, kind: socket.SocketKind
) -> tuple[subprocess.Popen[bytes], socket.socket]:
    """The same with a line to talk over: our end of a socket pair. The child is told its own by `--fd`."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, kind)
    with theirs:
        number = theirs.fileno()
        return spawn(module, *arguments, "--fd", str(number), pass_fds=(number,)), ours
