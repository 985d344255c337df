"""A forked child of the warm server: gives up all it has, shuts the doors behind itself, and runs the program."""

from __future__ import annotations

import atexit
import contextlib
import gc
import importlib
import mmap
import os
import resource
import signal
import socket
import sys
import threading
import traceback
from dataclasses import dataclass
from typing import Any, NoReturn

from chatrobot.sandbox import attempts
from chatrobot.sandbox.libc import PR_SET_DUMPABLE, PR_SET_PDEATHSIG, prctl
from chatrobot.sandbox.limits import SandboxLimits
from chatrobot.sandbox.seccomp import Filter
from chatrobot.sandbox.syscalls import Machine
from chatrobot.sandbox.walls import restrict_with_landlock

CHANNEL = 3
"""The one descriptor that leads out; 0 is empty, 1 and 2 are the log."""
CRASHED = 70
"""Exit code of a child that could not be shut in: it has run nothing."""


@dataclass(frozen=True)
class Doors:
    """Facts and filters that the warm server prepared once for all its children."""

    machine: Machine
    filter: Filter
    has_landlock: bool
    empty_fd: int
    base_bytes: int
    other_tasks: int
    server_pid: int


@dataclass(frozen=True)
class Order:
    """One launch."""

    entry: str
    payload: bytes
    limits: SandboxLimits
    channel_fd: int
    log_fd: int
    page: mmap.mmap


def run(order: Order, doors: Doors) -> NoReturn:
    """Never returns, whatever happens."""
    code = CRASHED
    try:
        _take_descriptors(order.channel_fd, order.log_fd, doors.empty_fd)
        function = _entry(order.entry)
        _leave_the_server(doors)
        _limit(order.limits, doors)
        _shut(order, doors)
        code = _call(function, order)
    except BaseException:  # noqa: BLE001 - nothing may unwind into the server's code
        traceback.print_exc()
    finally:
        os._exit(code)


def _take_descriptors(channel_fd: int, log_fd: int, empty_fd: int) -> None:
    """0 empty, 1 and 2 the log, 3 the channel, and no other one."""
    high = 64
    kept = [os.dup2(each, high + place) for place, each in enumerate((empty_fd, log_fd, log_fd, channel_fd))]
    for wanted, each in enumerate(kept):
        os.dup2(each, wanted, inheritable=False)
    os.closerange(CHANNEL + 1, os.sysconf("SC_OPEN_MAX"))
    for name, number in (("stdout", 1), ("stderr", 2)):
        stream = open(number, "w", buffering=1, encoding="utf-8", errors="backslashreplace", closefd=False)  # noqa: SIM115
        setattr(sys, name, stream)
        setattr(sys, f"__{name}__", stream)


def _entry(entry: str) -> Any:
    module, _, function = entry.partition(":")
    return getattr(importlib.import_module(module), function)


def _leave_the_server(doors: Doors) -> None:
    os.setpgid(0, 0)  # in the server's session: in one of its own the niceness of that would not count
    signal.set_wakeup_fd(-1)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != doors.server_pid:
        os._exit(CRASHED)


def _limit(limits: SandboxLimits, doors: Doors) -> None:
    most = {
        resource.RLIMIT_AS: doors.base_bytes + limits.memory_bytes,
        resource.RLIMIT_FSIZE: limits.file_bytes,
        resource.RLIMIT_NOFILE: limits.descriptors,
        resource.RLIMIT_NPROC: doors.other_tasks + limits.threads,
        resource.RLIMIT_CORE: 0,
        resource.RLIMIT_MEMLOCK: 0,
        resource.RLIMIT_MSGQUEUE: 0,
        resource.RLIMIT_NICE: 0,
        resource.RLIMIT_RTPRIO: 0,
    }
    for what, value in most.items():
        _, hard = resource.getrlimit(what)
        allowed = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(what, (allowed, allowed))
    # First a signal that Python may outlive, a second later one that nothing outlives.
    resource.setrlimit(resource.RLIMIT_CPU, (limits.cpu_s, limits.cpu_s + 1))


def _shut(order: Order, doors: Doors) -> None:
    """The doors, one after the other; behind the last one nothing can be opened any more."""
    prctl(PR_SET_DUMPABLE, 0)
    if doors.has_landlock:
        restrict_with_landlock(doors.machine)
        os.closerange(CHANNEL + 1, 16)
    attempts.watch(order.page)
    gc.enable()
    doors.filter.install(os.getpid())


def _call(function: Any, order: Order) -> int:
    """Like the end of a Python process: threads are waited for, exit functions run, output is flushed."""
    code = 0
    try:
        function(socket.socket(fileno=CHANNEL), order.payload)
        getattr(threading, "_shutdown")()  # noqa: B009 - private, and nothing else waits as Python itself does
    except SystemExit as leaving:
        code = _exit_code(leaving)
    except BaseException as error:  # noqa: BLE001 - whatever a program raises ends it
        if isinstance(error, MemoryError):
            attempts.note(order.page, "memory")
        traceback.print_exc()
        code = 1
    getattr(atexit, "_run_exitfuncs")()  # noqa: B009
    with contextlib.suppress(OSError, ValueError):
        sys.stdout.flush()
        sys.stderr.flush()
    return code


def _exit_code(leaving: SystemExit) -> int:
    if leaving.code is None or isinstance(leaving.code, int):
        return (leaving.code or 0) & 0xFF
    print(leaving.code, file=sys.stderr)
    return 1
