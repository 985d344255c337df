"""rclpy.executors"""

from __future__ import annotations

import inspect
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.context import get_default_context
from chatrobot.programs.names.task import Task


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


Call = Callable[[], Any]
Kind = Callable[[Any], Call]
"""Takes what waits at an entity and gives the call that works it off."""


def find_batch(executor: Any, nodes: Iterable[Any], now_ns: int) -> tuple[Iterator[Task], int | None]:
    """What is ready now, as rclpy works it off: all of it before anything that becomes ready meanwhile.

    Returns:
        Tasks, made when they are asked for, and when the next timer ticks.
    """
    batch: list[tuple[Any, Kind]] = []
    next_ns: int | None = None
    for node in tuple(nodes):
        for entity, kind in _entities(node):
            if not entity.callback_group.can_execute(entity):
                continue
            if _is_ready(entity, now_ns):
                batch.append((entity, kind))
            elif kind is _timer_call and entity.handle.due_ns is not None:
                due_ns = entity.handle.due_ns
                next_ns = due_ns if next_ns is None else min(next_ns, due_ns)
    return _tasks(executor, batch, now_ns), next_ns


def _entities(node: Any) -> Iterator[tuple[Any, Kind]]:
    for entities, kind in (
        (node.timers, _timer_call),
        (node.subscriptions, _message_call),
        (node.guards, _guard_call),
        (node.clients, _response_call),
        (node.services, _request_call),
    ):
        for entity in entities:
            yield entity, kind


def _is_ready(entity: Any, now_ns: int) -> bool:
    handle = entity.handle
    if hasattr(handle, "due_ns"):
        return handle.due_ns is not None and bool(handle.due_ns <= now_ns)
    return handle.is_waiting and not handle.is_destroyed


def _tasks(executor: Any, batch: Iterable[tuple[Any, Kind]], now_ns: int) -> Iterator[Task]:
    for entity, kind in batch:
        if _is_ready(entity, now_ns) and entity.callback_group.can_execute(entity):
            yield _task(executor, entity, kind(entity))


def _task(executor: Any, entity: Any, call: Call) -> Task:
    group = entity.callback_group
    group.beginning_execution(entity)
    task = Task(call, executor=executor)

    def at_end() -> None:
        group.ending_execution(entity)
        executor.wake()

    task._at_end = at_end
    return task


def _timer_call(timer: Any) -> Call:
    timer.handle.take()
    return lambda: timer.callback() if timer.callback is not None else None


def _message_call(subscription: Any) -> Call:
    arguments = subscription._take()
    return lambda: subscription.callback(*arguments)


def _guard_call(guard: Any) -> Call:
    guard.handle.is_waiting = False
    return lambda: guard.callback()


def _response_call(client: Any) -> Call:
    future, response = client.handle.queue.popleft()
    return lambda: future.set_result(response)


def _request_call(service: Any) -> Call:
    request, answer = service.handle.queue.popleft()

    async def respond() -> None:
        response = service.callback(request, service.srv_type.Response())
        if inspect.isawaitable(response):
            response = await response
        service.send_response(response, answer)

    return respond
