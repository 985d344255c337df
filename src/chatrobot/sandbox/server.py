"""The warm server: imports everything once, then forks a child for each program.

Runs as a process of its own (`chatrobot.sandbox.warm_server` starts it) with one thread. It trusts its host and nobody
else: of what a child says it reads nothing but a page of notes and what the kernel tells about its end.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import mmap
import os
import resource
import select
import signal
import socket
import sys
import threading
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from chatrobot.core.process import give_way, wake_as_others_do
from chatrobot.sandbox import attempts, child
from chatrobot.sandbox.layers import build_walls, can_make_namespaces
from chatrobot.sandbox.libc import PR_SET_PDEATHSIG, pidfd_open, prctl
from chatrobot.sandbox.limits import Layers, SandboxLimits, receive_message, send_message

_NAMES = """
abc argparse array ast asyncio asyncio.taskgroups atexit base64 binascii bisect builtins calendar cmath codecs
collections collections.abc colorsys concurrent.futures concurrent.futures.process concurrent.futures.thread
configparser contextlib contextvars copy copyreg csv ctypes ctypes.util dataclasses datetime decimal difflib dis enum
errno faulthandler fcntl fnmatch fractions functools gc getopt getpass gettext glob gzip hashlib heapq hmac html
http.client importlib importlib.util inspect io ipaddress itertools json keyword linecache locale logging
logging.config logging.handlers marshal math mmap multiprocessing multiprocessing.pool multiprocessing.queues
multiprocessing.shared_memory multiprocessing.synchronize numbers opcode operator os pathlib pickle pickletools pkgutil
platform pprint queue random re reprlib resource sched secrets select selectors shlex shutil signal socket
socketserver stat statistics string struct subprocess sys sysconfig tempfile textwrap threading time timeit token
tokenize traceback tracemalloc types typing unicodedata urllib.error urllib.parse urllib.request uuid warnings weakref
zlib zoneinfo _strptime
encodings.ascii encodings.cp1252 encodings.gbk encodings.hex_codec encodings.idna encodings.latin_1
encodings.raw_unicode_escape encodings.unicode_escape encodings.utf_16 encodings.utf_32 encodings.utf_8_sig
numpy numpy.fft numpy.linalg numpy.random
"""

PRELOADED = tuple(_NAMES.split())
"""Imported before a program runs, as far as this Python has them: in the sandbox no file can be opened, so nothing is
loaded later. Those that reach out (`socket`, `subprocess`) are here, too: using them is what fails."""


THREAD_STACK_BYTES = 1 << 20
MOST_DESCRIPTORS = 256
NICENESS = 5
"""Whoever governs the robot goes first; all programs of this server are one session, and share what one would get."""
FIRST_WHEN_MEMORY_RUNS_OUT = "900"


@dataclass
class _Running:
    """A child that has not been reaped yet."""

    report: socket.socket
    page: mmap.mmap
    limits: SandboxLimits
    began_s: float
    was_too_long: bool = False

    def left_s(self, now_s: float) -> float | None:
        return None if self.limits.wall_s is None else self.began_s + self.limits.wall_s - now_s


class Server:
    """The loop of the warm server. `serve` ends with the host."""

    def __init__(self, host: socket.socket, doors: child.Doors, host_pidfd: int | None) -> None:
        self._host = host
        self._doors = doors
        self._host_pidfd = host_pidfd
        self._running: dict[int, _Running] = {}
        self._woken, wake = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        signal.set_wakeup_fd(wake, warn_on_full_buffer=False)

    def serve(self) -> None:
        """Launch, reap and end children until the host is gone."""
        while True:
            ready = self._wait()
            if self._host_pidfd in ready:
                return
            if self._woken in ready:
                with contextlib.suppress(BlockingIOError):
                    os.read(self._woken, 4096)
            self._reap()
            for pid, running in list(self._running.items()):
                if running.report.fileno() in ready:
                    self._hear(pid, running)
            self._end_those_that_last_too_long()
            if self._host.fileno() in ready:
                try:
                    said, payload, descriptors = receive_message(self._host)
                except (EOFError, OSError):
                    return
                self._launch(said, payload, descriptors)

    def _wait(self) -> set[int | None]:
        waiting = select.poll()
        for descriptor in (self._host.fileno(), self._woken, self._host_pidfd):
            if descriptor is not None:
                waiting.register(descriptor, select.POLLIN)
        for running in self._running.values():
            waiting.register(running.report, select.POLLIN)
        now_s = time.monotonic()
        left_s = [left for each in self._running.values() if (left := each.left_s(now_s)) is not None]
        timeout_ms = max(0.0, min(left_s)) * 1000 + 1 if left_s else None
        return {descriptor for descriptor, _ in waiting.poll(timeout_ms)}

    def _launch(self, said: dict[str, Any], payload: bytes, descriptors: list[int]) -> None:
        channel, log, report_fd = descriptors
        report = socket.socket(fileno=report_fd)
        limits = SandboxLimits(**said["limits"])
        order = child.Order(said["entry"], payload, limits, channel, log, attempts.new_page())
        try:
            pid = os.fork()
        except OSError as error:
            _tell(report, {"event": "failed", "problem": str(error)})
            report.close()
        else:
            if pid == 0:
                self._forget_all(report)
                child.run(order, self._doors)
            self._running[pid] = _Running(report, order.page, limits, time.monotonic())
            self._tell_started(report, pid)
        os.close(channel)
        os.close(log)

    def _forget_all(self, report: socket.socket) -> None:
        """In the child: let go of its neighbours, and of objects that would later close a number of its own."""
        for running in self._running.values():
            running.page.close()
        for each in (self._host, report, *(running.report for running in self._running.values())):
            each.detach()
        self._running.clear()

    def _tell_started(self, report: socket.socket, pid: int) -> None:
        try:
            pidfd = pidfd_open(pid)
        except OSError:
            _tell(report, {"event": "started", "pid": pid})
            return
        _tell(report, {"event": "started", "pid": pid}, (pidfd,))
        os.close(pidfd)

    def _hear(self, pid: int, running: _Running) -> None:
        """A word or the end of the host's interest: either way the child has to go."""
        with contextlib.suppress(OSError):
            running.report.recv(16)
        os.kill(pid, signal.SIGKILL)

    def _end_those_that_last_too_long(self) -> None:
        now_s = time.monotonic()
        for pid, running in self._running.items():
            left_s = running.left_s(now_s)
            if left_s is not None and left_s <= 0 and not running.was_too_long:
                running.was_too_long = True
                os.kill(pid, signal.SIGKILL)

    def _reap(self) -> None:
        while True:
            try:
                pid, status, usage = os.wait4(-1, os.WNOHANG)
            except ChildProcessError:
                return
            if pid == 0:
                return
            running = self._running.pop(pid, None)
            if running is not None:
                _tell(running.report, _ended(running, status, usage))
                running.report.close()
                running.page.close()


def _ended(running: _Running, status: int, usage: resource.struct_rusage) -> dict[str, Any]:
    code = os.waitstatus_to_exitcode(status)
    return {
        "event": "ended",
        "exit_code": code if code >= 0 else None,
        "signal": -code if code < 0 else None,
        "cpu_s": usage.ru_utime + usage.ru_stime,
        "was_too_long": running.was_too_long,
        "tried": list(attempts.noted(running.page)),
    }


def _tell(report: socket.socket, said: dict[str, Any], descriptors: tuple[int, ...] = ()) -> None:
    with contextlib.suppress(OSError):
        send_message(report, said, b"", descriptors)


def preload(names: Iterable[str], required: Iterable[str]) -> None:
    """Import what this Python has of `names`, and all that is required.

    Raises:
        ImportError: one that is required.
    """
    for name in names:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    for name in required:
        importlib.import_module(name)


def _lowest_number(descriptor: int) -> int:
    """Move it below MOST_DESCRIPTORS: a host with many open files numbers it above, where no child would close it."""
    lowest = os.dup(descriptor)
    os.close(descriptor)
    return lowest


def main(descriptor: int, host_pidfd: int | None = None) -> None:
    """The whole life of the server. Says on the line what it found, then serves.

    Args:
        descriptor: the line to the host.
        host_pidfd: readable when the host is gone; None where the kernel has no such thing.
    """
    prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    descriptor = _lowest_number(descriptor)
    host_pidfd = None if host_pidfd is None else _lowest_number(host_pidfd)
    # Few numbers to close in each child; and where memory runs out, the sandbox goes first.
    resource.setrlimit(resource.RLIMIT_NOFILE, (MOST_DESCRIPTORS, MOST_DESCRIPTORS))
    wake_as_others_do()  # Motion, which started us, has it otherwise; nobody's program may
    with contextlib.suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text(FIRST_WHEN_MEMORY_RUNS_OUT)
    host = socket.socket(fileno=descriptor)
    setup, _, _ = receive_message(host)
    layers = Layers(**setup["layers"])
    if setup["can_wrap"] and not setup["is_wrapped"] and not (layers.namespaces and can_make_namespaces()):
        send_message(host, {"event": "wrap"})
        return
    sys.path[:0] = setup["path"]
    sys.path.extend(setup["behind"])
    try:
        preload(PRELOADED if setup["has_library"] else (), setup["preload"])
    except Exception as error:  # noqa: BLE001 - whatever a module raises is told to the host
        send_message(host, {"event": "failed", "problem": f"{type(error).__name__}: {error}"})
        return
    # Not before: whoever waits for the first program waits for all that was imported until here. Not after: behind the
    # walls no niceness of a session can be written.
    give_way(NICENESS)
    threading.stack_size(THREAD_STACK_BYTES)
    walls = build_walls(layers, setup["tasks"], is_wrapped=setup["is_wrapped"])
    if walls.doors is None:
        send_message(host, {"event": "refused", "layers": dict(walls.problems)})
        return
    gc.collect()
    gc.freeze()
    gc.disable()
    server = Server(host, walls.doors, host_pidfd)
    send_message(host, {"event": "ready", "layers": dict(walls.problems)})
    server.serve()
