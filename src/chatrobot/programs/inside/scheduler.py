"""Virtual time for a program with threads: one thread runs at a time, and time passes only when all of them wait.

The hand-over is deterministic: who is ready first runs first, and runs until it waits. A look at the clock costs a
little time, so that busy loops get on; many looks in a row without a wait are a flood and cost more each.
"""

from __future__ import annotations

import _thread
from collections import deque
from heapq import heappop, heappush
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from chatrobot.programs.inside.link import VirtualLink

LOOK_NS = 1_000
FLOOD_LOOK_NS = 2_000_000
FLOOD_AFTER_LOOKS = 200.0
"""A loop that only looks at the clock advances by 1 us a look at first, and by 2 ms a look once it is a flood."""

_allocate_lock = _thread.allocate_lock
"""The real one, whatever is put in its place later."""


class Task:
    """One thread of the program. `joiners` wait for its end."""

    __slots__ = ("baton", "finished", "joiners", "looks", "ticket", "waits", "woken")

    def __init__(self) -> None:
        self.baton = _allocate_lock()
        self.baton.acquire()
        self.waits = self.woken = self.finished = False
        self.ticket = 0
        self.looks = 0.0
        self.joiners: list[Task] = []


class Scheduler:
    """See the module. All times in nanoseconds since the program's start."""

    def __init__(self, outside: VirtualLink, horizon_ns: int) -> None:
        self.now_ns = 0
        self.current = Task()
        self._outside = outside
        self._horizon_ns = horizon_ns
        self._ready: deque[Task] = deque()
        self._sleepers: list[tuple[int, int, Task, int]] = []
        self._sequence = 0

    # --- for the clock ---

    def look(self, cost_ns: int = LOOK_NS, weight: float = 1.0) -> int:
        """Return the time, a little later than at the last look."""
        task = self.current
        task.looks += weight
        self.now_ns += cost_ns if task.looks < FLOOD_AFTER_LOOKS else FLOOD_LOOK_NS
        if self.now_ns >= min(self._outside.due_ns, self._horizon_ns) or self._is_someone_due():
            self._let_others_run()
        return self.now_ns

    def sleep_until(self, deadline_ns: int) -> None:
        """Have the running thread sleep."""
        if deadline_ns <= self.now_ns:
            self.look()
            self._yield()
        else:
            self.block(deadline_ns)

    # --- for locks ---

    def block(self, deadline_ns: int | None) -> bool:
        """Have the running thread wait. True if `wake` woke it, False if the deadline came first."""
        task = self.current
        task.waits, task.woken, task.looks = True, False, 0.0
        task.ticket += 1
        if deadline_ns is not None:
            self._sequence += 1
            heappush(self._sleepers, (deadline_ns, self._sequence, task, task.ticket))
        self._hand_over(task)
        return task.woken

    def wake(self, task: Task) -> None:
        """End the wait of a thread."""
        if task.waits:
            task.waits, task.woken = False, True
            self._ready.append(task)

    # --- for threads ---

    def add(self) -> Task:
        """Return a new thread's task: it runs when its turn comes; its thread first acquires the baton."""
        task = Task()
        self._ready.append(task)
        return task

    def leave(self, task: Task) -> None:
        """End the running thread's task; the next one runs."""
        task.finished = True
        for joiner in task.joiners:
            self.wake(joiner)
        following = self.current = self._next()
        following.baton.release()

    def join(self, task: Task, deadline_ns: int | None) -> None:
        """Have the running thread wait for the end of another."""
        while not task.finished:
            task.joiners.append(self.current)
            if not self.block(deadline_ns):
                return

    # --- inner ---

    def _hand_over(self, task: Task) -> None:
        following = self._next()
        self.current = following
        if following is not task:
            following.baton.release()
            task.baton.acquire()

    def _yield(self) -> None:
        if self._ready:
            task = self.current
            self._ready.append(task)
            self._hand_over(task)

    def _next(self) -> Task:
        while not self._ready:
            self._pass_time()
        return self._ready.popleft()

    def _pass_time(self) -> None:
        while self._sleepers and not self._is_waiting(*self._sleepers[0][2:]):
            heappop(self._sleepers)
        stuck = not self._sleepers
        until_ns = self._horizon_ns if stuck else min(self._sleepers[0][0], self._horizon_ns)
        self._advance(until_ns, stuck)

    def _advance(self, until_ns: int, stuck: bool = False) -> None:
        self.now_ns = max(self.now_ns, self._outside.advance(self.now_ns, until_ns))
        if self.now_ns >= self._horizon_ns:
            self._outside.finish(self._horizon_ns, stuck)
        while self._sleepers and self._sleepers[0][0] <= self.now_ns:
            _, _, task, ticket = heappop(self._sleepers)
            if self._is_waiting(task, ticket):
                task.waits = False
                self._ready.append(task)

    def _let_others_run(self) -> None:
        self._advance(self.now_ns)
        self._yield()

    def _is_someone_due(self) -> bool:
        return bool(self._sleepers) and self._sleepers[0][0] <= self.now_ns

    @staticmethod
    def _is_waiting(task: Task, ticket_number: int) -> bool:
        return task.waits and task.ticket == ticket_number
