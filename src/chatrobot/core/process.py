"""Which process of this machine speaks, and whether it is stopped just now (SIGSTOP, Ctrl-Z, a debugger) or gone.

Where there is no /proc, or the process is on another machine or in another container, nobody can tell.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

_STOPPED = "TtZXx"
"""States of proc_pid_stat(5): stopped by a signal or by a debugger, or dead."""
_PROC = Path("/proc")


def own_identity() -> str:
    """This process among all of this machine since its boot; empty where the system does not tell."""
    try:
        pid = os.getpid()
        return f"{_machine()} {pid} {_stat(pid)[1]}"
    except (OSError, ValueError, IndexError):
        return ""


def watch_process(identity: str) -> Callable[[], bool] | None:
    """Tells whether the process of that identity is stopped or gone; None where it cannot be observed from here."""
    machine, _, process = identity.rpartition(" ")[0].rpartition(" ")
    started = identity.rpartition(" ")[2]
    try:
        if not machine or machine != _machine() or _stat(int(process))[1] != started:
            return None
    except (OSError, ValueError, IndexError):
        return None
    pid = int(process)

    def is_stopped() -> bool:
        try:
            state, began = _stat(pid)
        except (OSError, ValueError, IndexError):
            return True
        return state in _STOPPED or began != started

    return is_stopped


def is_machine_busy() -> bool:
    """More threads want a processor just now than there are processors."""
    try:
        running = int((_PROC / "loadavg").read_text().split()[3].partition("/")[0])
    except (OSError, ValueError, IndexError):
        return False
    return running > (os.cpu_count() or 1)


def _machine() -> str:
    """This boot of this machine, and the namespace in which process ids count."""
    boot_id = (_PROC / "sys/kernel/random/boot_id").read_text().strip()
    return f"{boot_id} {os.readlink(_PROC / 'self/ns/pid')}"


def _stat(pid: int) -> tuple[str, str]:
    """State and start time of a process. Its name stands in brackets before them and may hold anything."""
    fields = (_PROC / str(pid) / "stat").read_text(errors="replace").rpartition(")")[2].split()
    return fields[0], fields[19]
