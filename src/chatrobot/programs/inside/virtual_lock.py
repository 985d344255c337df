"""The one lock that all of threading, queue and concurrent.futures are built on, on virtual time."""

from __future__ import annotations

import threading
from collections import deque

from chatrobot.programs.inside.scheduler import Scheduler, Task

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
        if not self._locked:
            raise RuntimeError("release unlocked lock")
        while self._waiters:
            task = self._waiters.popleft()
            if task.waits:  # else its time ran out just now
                self.scheduler.wake(task)
                return
        self._locked = False

    def locked(self) -> bool:
        self.scheduler.look(weight=GLANCE)
        return self._locked

    def _at_fork_reinit(self) -> None:
        self._locked = False
        self._waiters.clear()

    __enter__ = acquire

    def __exit__(self, *_: object) -> None:
        self.release()
