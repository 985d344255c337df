"""rclpy.executors"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.inside.work import find_batch
from chatrobot.programs.names.rclpy.task import Task
from chatrobot.programs.names.rclpy.utilities import get_default_context


class TimeoutException(Exception):
    """Nothing to do came in time."""


class ShutdownException(Exception):
    """The executor was shut down."""


class ExternalShutdownException(Exception):
    """rclpy was shut down while the executor waited."""


class ConditionReachedException(Exception):
    """What the wait was for has come."""


class Executor:
    """Calls callbacks: one at a time, in the order rclpy has (timers, messages, guards, clients, services)."""

    def __init__(self, *, context: Any = None) -> None:
        self._context = get_default_context() if context is None else context
        if (
            not self._context._was_initialized
        ):  # in rclpy it has no handle then, and this is what comes of that
            raise TypeError("'NoneType' object does not support the context manager protocol")
        self._nodes: list[Any] = []
        self._tasks: deque[Task] = deque()
        self._batch: Iterator[Task] = iter(())
        self._wakeup = threading.Event()
        self._is_shutdown = False
        self._context.on_shutdown(self._wakeup.set)

    @property
    def context(self) -> Any:
        return self._context

    def add_node(self, node: Any) -> bool:
        if node in self._nodes:
            return False
        self._nodes.append(node)
        node.executor = self
        self.wake()
        return True

    def remove_node(self, node: Any) -> None:
        if node in self._nodes:
            self._nodes.remove(node)

    def get_nodes(self) -> list[Any]:
        return list(self._nodes)

    def can_execute(self, entity: Any) -> bool:
        return bool(entity.callback_group.can_execute(entity))

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task:
        task = Task(callback, args, kwargs, executor=self)
        self._resume(task)
        return task

    def _resume(self, task: Task) -> None:
        """`task` is to be run, or to be run on."""
        self._tasks.append(task)
        self.wake()

    def wake(self) -> None:
        self._wakeup.set()

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        self._is_shutdown = True
        self.wake()
        for node in self.get_nodes():
            self.remove_node(node)
        return True

    def spin(self) -> None:
        while self._context.ok() and not self._is_shutdown:
            self.spin_once()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run what is ready first; wait for it at most `timeout_sec`, None for ever."""
        self._spin_once(timeout_sec, _never)

    def spin_until_future_complete(self, future: Any, timeout_sec: float | None = None) -> None:
        future.add_done_callback(lambda _: self.wake())
        until_ns = (
            None if timeout_sec is None or timeout_sec < 0 else get_link().look() + int(timeout_sec * 1e9)
        )
        while self._context.ok() and not future.done() and not self._is_shutdown:
            left_s = None if until_ns is None else max(0.0, (until_ns - get_link().now_ns()) * 1e-9)
            self._spin_once(left_s, future.done)
            if until_ns is not None and get_link().now_ns() >= until_ns:
                return

    def spin_once_until_future_complete(self, future: Any, timeout_sec: float | None = None) -> None:
        future.add_done_callback(lambda _: self.wake())
        self._spin_once(timeout_sec, future.done)

    def _spin_once(self, timeout_sec: float | None, is_reached: Callable[[], bool]) -> None:
        try:
            task = self._wait(timeout_sec, is_reached)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        self._execute(task)

    def _execute(self, task: Task) -> None:
        raise NotImplementedError

    def _wait(self, timeout_sec: float | None, is_reached: Callable[[], bool]) -> Task:
        link = get_link()
        until_ns = None if timeout_sec is None or timeout_sec < 0 else link.now_ns() + int(timeout_sec * 1e9)
        while True:
            self._wakeup.clear()
            task, due_ns = self._find()
            if task is not None:
                return task
            if self._is_shutdown:
                raise ShutdownException
            if not self._context._is_valid:
                raise ExternalShutdownException
            if is_reached():
                raise ConditionReachedException
            now_ns = link.look()
            if until_ns is not None and now_ns >= until_ns:
                raise TimeoutException
            ends_ns = [moment for moment in (due_ns, until_ns) if moment is not None]
            if not ends_ns or min(ends_ns) > now_ns:
                with link.waiting():
                    self._wakeup.wait((min(ends_ns) - now_ns) * 1e-9 if ends_ns else None)

    def _find(self) -> tuple[Task | None, int | None]:
        """A task to run now, or when the next timer ticks."""
        task = next(self._batch, None)
        if task is not None:
            return task, None
        if self._tasks:
            return self._tasks.popleft(), None
        self._batch, due_ns = find_batch(self, self._nodes, get_link().now_ns())
        return next(self._batch, None), due_ns

    def __enter__(self) -> Executor:
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()


def _never() -> bool:
    return False


class SingleThreadedExecutor(Executor):
    """Callbacks run on the thread that spins; what they raise leaves through it."""

    def _execute(self, task: Task) -> None:
        task()
        error = task.exception()
        if error is not None:
            raise error


class MultiThreadedExecutor(Executor):
    """Callbacks run on a pool of threads.

    As in rclpy, what they raise leaves through the thread that spins, but only once there is more to do, and a
    shutdown of rclpy ends the spinning without an exception.
    """

    def __init__(self, num_threads: int | None = None, *, context: Any = None) -> None:
        super().__init__(context=context)
        self._pool = ThreadPoolExecutor(num_threads or 4)
        self._running: list[Task] = []

    def _execute(self, task: Task) -> None:
        if task not in self._running:
            self._running.append(task)
        self._pool.submit(task)
        for task in [task for task in self._running if task._done]:
            self._running.remove(task)
            error = task.exception()
            if error is not None:
                raise error

    def _spin_once(self, timeout_sec: float | None, is_reached: Callable[[], bool]) -> None:
        with suppress(ExternalShutdownException):
            super()._spin_once(timeout_sec, is_reached)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        self._pool.shutdown(wait=False)
        return super().shutdown(timeout_sec)
