"""`chatrobot stop`: stop whatever this user runs on this machine. Imports next to nothing: it must be out in 60 ms."""

from __future__ import annotations

import contextlib
import socket
import sys
import time
from pathlib import Path

from chatrobot.wire.runtime_dir import runtime_dirs, stop_socket_paths

ANSWER_S = 1.0
"""Motion answers as soon as its zero is out; one that has not after this long is frozen."""

_ANSWERS = {
    b"moving": "Stopped. It was moving; zero velocities continue until odometry shows it standing.",
    b"waiting": "It was standing. Queued instructions are dropped, and zero velocities were sent.",
    b"standing": "It was already standing. Zero velocities were sent all the same.",
    b"unseen": "Stop sent. There is no odometry, so I cannot confirm that the robot stopped.",
}
"""What Motion found, by odometry, when the zero was out."""
_ELSEWHERE = (
    "If one runs: stop it as the user, and in the container, that started it, with the same XDG_RUNTIME_DIR "
    "(docs/troubleshooting.md, Who stops whom)"
)


def run(_: object = None) -> int:
    """Return 0 where everything that was found has stopped; 1 where nothing was found, or something does not answer."""
    # To connect is to be heard: all of them stop before the first answer is waited for.
    callers = [(path, caller) for path in stop_socket_paths() if (caller := _call(path)) is not None]
    if not callers:
        print(
            f"nothing was stopped: no running robot is found in {_looked_in()}\n{_ELSEWHERE}", file=sys.stderr
        )
        return 1
    deadline_s = time.monotonic() + ANSWER_S
    return max(_report(path, caller, deadline_s) for path, caller in callers)


def _looked_in() -> str:
    return ", ".join(str(path) for path in runtime_dirs())


def _call(path: Path) -> socket.socket | None:
    """Connect to the Motion behind `path`; None where it has left."""
    caller = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    caller.settimeout(ANSWER_S)
    try:
        caller.connect(str(path))
    except (ConnectionRefusedError, FileNotFoundError):
        caller.close()
        with contextlib.suppress(FileNotFoundError):
            path.unlink()  # left behind by one that was killed
        return None
    except OSError:
        pass  # its queue of callers is full: it does not answer, and that is what will be said
    return caller


def _report(path: Path, caller: socket.socket, deadline_s: float) -> int:
    """Say what became of one robot."""
    process = f"robot of process {path.stem.partition('-')[2]}"
    try:
        with caller:
            caller.settimeout(max(0.001, deadline_s - time.monotonic()))
            answer = caller.recv(64)
    except OSError:
        answer = b""
    if answer in _ANSWERS:
        print(f"{process}: {_ANSWERS[answer]}")
        return 0
    if not path.exists():
        return 0  # it was just leaving, and leaves only when the robot stands
    print(
        f"{process}: no answer within {ANSWER_S:g} s; its guard halts the robot if it froze", file=sys.stderr
    )
    return 1
