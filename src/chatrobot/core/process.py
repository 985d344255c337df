"""Processes of this machine: which one speaks and whether it runs, and how the kernel is to treat our own.

Where there is no /proc, or a process is on another machine or in another container, nobody can tell whether it is
stopped (SIGSTOP, Ctrl-Z, a debugger) or gone.
"""

from __future__ import annotations

import contextlib
import os
import platform
import struct
import time
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


GUARD = (-900, 0)
"""What the guard would like (only root may), and what anybody may go back to."""

MOTION = 200
"""It goes before the rest: the guard then halts the robot. Anybody may raise a score, so this works without root."""

_SCORE_FILE = "/proc/self/oom_score_adj"


def prefer(*scores: int) -> int | None:
    """Set the first of `scores` that the kernel lets us have; which, or None. Higher goes first (proc(5))."""
    for score in scores:
        with contextlib.suppress(OSError):
            with open(_SCORE_FILE, "w", encoding="ascii") as file:
                file.write(str(score))
            return score
    return None


_AUTOGROUP_FILE = "/proc/self/autogroup"


_REFUSED_S, _TRIES = 0.02, 10
"""The kernel takes a niceness for a session ten times a second in all, and refuses more, but for root's."""


def give_way(niceness: int) -> None:
    """Have others go first, by at least so much niceness, in turns as long as anybody's: in this session, and this
    session among others, which sched(7) ranks by themselves."""
    wake_as_others_do()
    niceness = max(niceness, os.getpriority(os.PRIO_PROCESS, 0))
    os.setpriority(os.PRIO_PROCESS, 0, niceness)
    for _ in range(_TRIES):
        try:
            with open(_AUTOGROUP_FILE, "w", encoding="ascii") as file:
                file.write(str(niceness))
        except BlockingIOError:
            time.sleep(_REFUSED_S)
        except OSError:
            return  # sessions are not ranked here: the niceness of the process counts
        else:
            return


_CALL = {"x86_64": 314, "aarch64": 274, "riscv64": 274, "armv7l": 380}
_SHORT_NS = 300_000
"""The kernel's own is 1.4 ms on two cores, in effect the 4 ms between two of its ticks. A tick of the control loop
fits into this one; the shortest that may be had, 0.1 ms, has it interrupted half-way."""
_KERNELS_OWN_NS = 0


def wake_promptly() -> None:
    """The calling thread, and whatever it starts from now on, is woken before what runs in long turns.

    One that a person has given real-time or batch scheduling keeps that.
    """
    if os.sched_getscheduler(0) == os.SCHED_OTHER:
        _take_turns_of(_SHORT_NS)


def wake_as_others_do() -> None:
    """Be scheduled like any other process, whatever was inherited: short turns, or a person's real-time priority."""
    _take_turns_of(_KERNELS_OWN_NS)


def _take_turns_of(slice_ns: int) -> None:
    """For the calling thread. Where the machine has no such call it waits its turn like everybody."""
    import ctypes  # not every process that asks who speaks wants it

    call = _CALL.get(platform.machine())
    if call is None:
        return
    no_flags, no_priority, no_deadline, no_period = 0, 0, 0, 0
    niceness = os.getpriority(os.PRIO_PROCESS, 0)
    policy = os.SCHED_OTHER
    size = 48  # struct sched_attr in its first version
    attributes = struct.pack(
        "=IIQiIQQQ", size, policy, no_flags, niceness, no_priority, slice_ns, no_deadline, no_period
    )
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).syscall(call, 0, attributes, 0)
