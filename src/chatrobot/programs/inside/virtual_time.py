"""Puts virtual time in the place of real time: in `time`, `datetime`, `threading`, `queue`, `select` and `asyncio`.

Called once, in the sandbox, before the program is compiled: its own imports (`from time import sleep`) then find what
stands here.
"""

from __future__ import annotations

import _thread
import concurrent.futures.thread
import datetime
import queue
import sched
import select
import threading
import time
import timeit
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any, cast

from chatrobot.programs.inside.scheduler import Scheduler, Task

UPTIME_NS = 1_000_000_000_000
"""What the monotonic clocks say at the start."""


def install(scheduler: Scheduler, start_ns: int) -> None:
    """Have this process live on virtual time, which begins at the wall clock's `start_ns`."""
    VirtualLock.scheduler = scheduler
    _install_clocks(scheduler, start_ns)
    _install_dates(scheduler, start_ns)
    _install_locks(scheduler)
    _install_queues(scheduler)
    _install_threads(scheduler)
    _install_select(scheduler)


def _install_clocks(scheduler: Scheduler, start_ns: int) -> None:
    look = scheduler.look

    def time_ns() -> int:
        return start_ns + look()

    def monotonic_ns() -> int:
        return UPTIME_NS + look()

    def seconds(clock_ns: Callable[[], int]) -> Callable[[], float]:
        return lambda: clock_ns() * 1e-9

    def sleep(secs: float, /) -> None:
        if secs < 0:
            raise ValueError("sleep length must be non-negative")
        scheduler.sleep_until(scheduler.now_ns + int(secs * 1e9))

    now = dict.fromkeys(("monotonic", "perf_counter", "process_time", "thread_time"), monotonic_ns)
    for name, clock_ns in {**now, "time": time_ns}.items():
        setattr(time, f"{name}_ns", clock_ns)
        setattr(time, name, seconds(clock_ns))
    replacements: dict[str, Callable[..., Any]] = {
        **_calendar(lambda: time_ns() * 1e-9),
        "sleep": sleep,
        "clock_gettime_ns": lambda clock: time_ns() if clock == time.CLOCK_REALTIME else monotonic_ns(),
    }
    replacements["clock_gettime"] = lambda clock: replacements["clock_gettime_ns"](clock) * 1e-9
    for name, function in replacements.items():
        setattr(time, name, function)
    timeit.default_timer = time.perf_counter
    for module, name in ((threading, "_time"), (queue, "time"), (sched, "_time")):
        setattr(module, name, time.monotonic)
    cast(Any, sched.scheduler.__init__).__defaults__ = (time.monotonic, time.sleep)


def _calendar(now_s: Callable[[], float]) -> dict[str, Callable[..., Any]]:
    """The functions of the calendar, whose missing argument means now."""

    def of(real: Callable[..., Any]) -> Callable[..., Any]:
        return lambda secs=None: real(now_s() if secs is None else secs)

    real_strftime, real_asctime, localtime = time.strftime, time.asctime, of(time.localtime)
    return {
        "localtime": localtime,
        "gmtime": of(time.gmtime),
        "ctime": of(time.ctime),
        "strftime": lambda form, t=None: real_strftime(form, localtime() if t is None else t),
        "asctime": lambda t=None: real_asctime(localtime() if t is None else t),
    }


def _install_dates(scheduler: Scheduler, start_ns: int) -> None:
    class VirtualDatetime(datetime.datetime):
        @classmethod
        def now(cls, tz: datetime.tzinfo | None = None) -> VirtualDatetime:
            return cls.fromtimestamp((start_ns + scheduler.look()) * 1e-9, tz)

        @classmethod
        def today(cls) -> VirtualDatetime:
            return cls.now()

        @classmethod
        def utcnow(cls) -> VirtualDatetime:
            return cls.now(datetime.timezone.utc).replace(tzinfo=None)

    class VirtualDate(datetime.date):
        @classmethod
        def today(cls) -> VirtualDate:
            return cls.fromtimestamp((start_ns + scheduler.look()) * 1e-9)

    for kind, name in ((VirtualDatetime, "datetime"), (VirtualDate, "date")):
        kind.__name__ = kind.__qualname__ = name
        kind.__module__ = "datetime"
        setattr(datetime, name, kind)


def _install_locks(scheduler: Scheduler) -> None:
    module = cast(Any, threading)
    module._allocate_lock = module.Lock = _thread.allocate_lock = VirtualLock  # type: ignore[assignment]
    module.RLock = module._PyRLock
    # Made at import, by the real lock.
    cast(Any, concurrent.futures.thread)._global_shutdown_lock = VirtualLock()

    def is_set(event: Any) -> bool:
        scheduler.look(weight=GLANCE)
        return bool(event._flag)

    cast(Any, threading.Event).is_set = is_set


def _install_queues(scheduler: Scheduler) -> None:
    def looking(real: Callable[..., Any]) -> Callable[..., Any]:
        def look_at(*args: Any, **kwargs: Any) -> Any:
            scheduler.look(weight=GLANCE)
            return real(*args, **kwargs)

        return look_at

    module = cast(Any, queue)
    module.SimpleQueue = module._PySimpleQueue
    for kind in (queue.Queue, module.SimpleQueue):
        for name in ("empty", "full", "qsize", "get_nowait"):
            if hasattr(kind, name):
                setattr(kind, name, looking(getattr(kind, name)))


def _install_threads(scheduler: Scheduler) -> None:
    def start(real: Callable[..., Any], function: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        task = scheduler.add()
        thread = getattr(function, "__self__", None)
        if isinstance(thread, threading.Thread):
            thread._virtual_task = task  # type: ignore[attr-defined]

        def begin(*inner: Any, **named: Any) -> None:
            task.baton.acquire()
            try:
                function(*inner, **named)
            finally:
                scheduler.leave(task)

        return real(begin, *args, **kwargs)

    def join(thread: Any, timeout: float | None = None) -> None:
        task = getattr(thread, "_virtual_task", None)
        if task is None:
            raise RuntimeError("cannot join thread before it is started")
        if task is scheduler.current:
            raise RuntimeError("cannot join current thread")
        scheduler.join(task, None if timeout is None else scheduler.now_ns + int(timeout * 1e9))

    def is_alive(thread: Any) -> bool:
        scheduler.look(weight=GLANCE)
        task = getattr(thread, "_virtual_task", None)
        return thread is threading.main_thread() if task is None else not task.finished

    for module in (threading, _thread):
        for name in ("start_new_thread", "start_joinable_thread"):
            for each in (name, f"_{name}"):
                if hasattr(module, each):
                    setattr(module, each, partial(start, getattr(module, each)))
    cast(Any, threading.Thread).join = join
    cast(Any, threading.Thread).is_alive = is_alive


def _install_select(scheduler: Scheduler) -> None:
    """In the sandbox there is nothing to read from: a select is a wait."""

    def wait(
        _r: Any, _w: Any, _x: Any, timeout: float | None = None
    ) -> tuple[list[Any], list[Any], list[Any]]:
        if timeout is None:
            scheduler.block(None)
        else:
            scheduler.sleep_until(scheduler.now_ns + int(timeout * 1e9))
        return [], [], []

    cast(Any, select).select = wait


GLANCE = 0.1
"""A look at a lock counts less towards a flood than one at the clock: locks are looked at by the library too."""


class VirtualLock:
    """Behaves like `threading.Lock()`. A release hands the lock to who has waited longest.

    `scheduler` belongs to the class: the process has one.
    """

    scheduler: Scheduler

    def __init__(self) -> None:
        self._locked = False
        self._waiters: deque[Task] = deque()

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Take the lock, or wait for it at most `timeout` seconds."""
        if not blocking and timeout != -1:
            raise ValueError("can't specify a timeout for a non-blocking call")
        if timeout < 0 and timeout != -1:
            raise ValueError("timeout value must be a non-negative number")
        if timeout > threading.TIMEOUT_MAX:
            raise OverflowError("timeout value is too large")
        if not self._locked:
            self._locked = True
            return True
        scheduler = self.scheduler
        if not blocking or timeout == 0:
            scheduler.look(weight=GLANCE)
            return False
        task = scheduler.current
        self._waiters.append(task)
        woken = scheduler.block(None if timeout < 0 else scheduler.now_ns + int(timeout * 1e9))
        if not woken and task in self._waiters:
            self._waiters.remove(task)
        return woken

    def release(self) -> None:
        """Give it back, or hand it on."""
        if not self._locked:
            raise RuntimeError("release unlocked lock")
        while self._waiters:
            task = self._waiters.popleft()
            if task.waits:  # else its time ran out just now
                self.scheduler.wake(task)
                return
        self._locked = False

    def locked(self) -> bool:
        """Tell whether somebody has it."""
        self.scheduler.look(weight=GLANCE)
        return self._locked

    def _at_fork_reinit(self) -> None:
        self._locked = False
        self._waiters.clear()

    __enter__ = acquire

    def __exit__(self, *_: object) -> None:
        self.release()
