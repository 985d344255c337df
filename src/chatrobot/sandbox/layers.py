"""Which walls stand on this machine. Each is built for trial in a process of its own before it is relied on."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from chatrobot.sandbox.child import Doors
from chatrobot.sandbox.libc import PR_SET_PDEATHSIG, prctl, system_call
from chatrobot.sandbox.limits import Layers
from chatrobot.sandbox.seccomp import Filter
from chatrobot.sandbox.syscalls import Machine, this_machine
from chatrobot.sandbox.walls import (
    drop_root,
    empty_the_root,
    enter_namespaces,
    has_own_user,
    restrict_with_landlock,
)

NOT_WANTED = "not wanted"
OWN_TASKS = 4
SPARE_TASKS = 256
"""Room for what else the user starts, where the user is not our own."""


@dataclass(frozen=True)
class Walls:
    """The result: for each layer why it does not stand, or "" where it does. No doors, no programs."""

    problems: Mapping[str, str]
    doors: Doors | None


def build_walls(wanted: Layers, tasks: int, *, is_wrapped: bool) -> Walls:
    """Called once in the warm server, with all imports done and one thread; it may return in a forked process.

    What stands is used; what does not is left out and named.

    Args:
        wanted: what to try.
        tasks: how many tasks the user has who started us.
        is_wrapped: bubblewrap is around this process already.
    """
    machine = this_machine()
    if machine is None:
        return Walls({"seccomp": "no filter is written for this kind of machine"}, None)
    program = Filter(machine)
    problems = {"seccomp": _trial(lambda: _try_filter(machine, program))}
    if problems["seccomp"]:
        return Walls(problems, None)
    base_bytes, empty = _own_bytes(), os.open("/dev/null", os.O_RDWR | os.O_CLOEXEC)
    problems["landlock"] = _trial(lambda: _try_landlock(machine)) if wanted.landlock else NOT_WANTED
    is_unprivileged = is_wrapped or drop_root()
    problems["own user"] = "" if is_unprivileged else "root here has no other user to become"
    prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    problems["namespaces"] = "bubblewrap makes them" if is_wrapped else NOT_WANTED
    problems["bubblewrap"] = "" if is_wrapped else "not needed" if wanted.bubblewrap else NOT_WANTED
    if wanted.namespaces and not is_wrapped:
        problems["namespaces"] = _trial(lambda: _try_namespaces(machine))
        if problems["namespaces"]:
            problems["bubblewrap"] = "not installed, or it does not work here"
    # The kernel counts all tasks of a user together.
    other_tasks = OWN_TASKS if has_own_user() else tasks + SPARE_TASKS
    if not problems["namespaces"]:
        enter_namespaces(machine)
        _go_on_as_first_process()
        empty_the_root(machine)
    doors = Doors(machine, program, not problems["landlock"], empty, base_bytes, other_tasks, os.getpid())
    return Walls(problems, doors)


def can_make_namespaces() -> bool:
    """Tell whether this machine lets us; found out in a process that ends with the trial."""
    machine = this_machine()
    return machine is not None and not _trial(lambda: _drop_and_try_namespaces(machine))


def _drop_and_try_namespaces(machine: Machine) -> None:
    drop_root()
    _try_namespaces(machine)


def _trial(build: Callable[[], None]) -> str:
    """Build it in a forked process. Returns the problem, or "" where it stands."""
    reading, writing = os.pipe()
    pid = os.fork()
    if pid == 0:
        problem = "it did not hold"
        try:
            build()
            problem = ""
        except OSError as error:
            problem = str(error)
        finally:
            os.write(writing, (problem or "stands").encode())
            os._exit(0)
    os.close(writing)
    said = os.read(reading, 4096).decode()
    os.close(reading)
    os.waitpid(pid, 0)
    return "" if said == "stands" else said or "it did not hold"


def _try_filter(machine: Machine, program: Filter) -> None:
    """An ordinary attempt is refused, and an attack dies."""
    pid = os.fork()
    if pid == 0:
        try:
            program.install(os.getpid())
            os.write(1, b"")
            _expect_refusal()
            system_call(machine.numbers["keyctl"], 0, 0)
        finally:
            os._exit(0)
    _, status = os.waitpid(pid, 0)
    if os.waitstatus_to_exitcode(status) != -signal.SIGSYS:
        raise OSError("seccomp filters are switched off here")


def _expect_refusal() -> None:
    try:
        os.open("/", os.O_RDONLY)
    except PermissionError:
        return
    os._exit(0)


def _try_landlock(machine: Machine) -> None:
    restrict_with_landlock(machine)
    try:
        os.listdir("/")
    except PermissionError:
        return
    raise OSError("Landlock is there and stops nothing")


def _try_namespaces(machine: Machine) -> None:
    enter_namespaces(machine)
    pid = os.fork()
    if pid == 0:
        code = 1
        try:
            empty_the_root(machine)
            code = 0 if os.listdir("/") == [] else 2
        except OSError as error:
            code = 10 + (error.errno or 0)
        finally:
            os._exit(code)
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    if code > 10:
        raise OSError(code - 10, os.strerror(code - 10))
    if code:
        raise OSError("the files of the machine stayed visible")


def _go_on_as_first_process() -> None:
    """Fork; the caller goes on in the new process, and the old one waits for its end, which it shares."""

    pid = os.fork()
    if pid == 0:
        prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        return

    os.closerange(3, os.sysconf("SC_OPEN_MAX"))
    os.waitpid(pid, 0)
    os._exit(0)


def _own_bytes() -> int:
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    return pages * os.sysconf("SC_PAGE_SIZE")
