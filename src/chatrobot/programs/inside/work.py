"""Finds what an executor has to do among the entities of its nodes."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from chatrobot.programs.names.rclpy.task import Task

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
    future, response = client.handle.responses.popleft()
    return lambda: future.set_result(response)


def _request_call(service: Any) -> Call:
    request, answer = service.handle.queue.popleft()

    async def respond() -> None:
        response = service.callback(request, service.srv_type.Response())
        if inspect.isawaitable(response):
            response = await response
        service.send_response(response, answer)

    return respond
