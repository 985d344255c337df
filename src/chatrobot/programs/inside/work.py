"""Finds what an executor has to do next among the entities of its nodes."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from chatrobot.programs.names.rclpy.task import Task

Due = tuple[Any, Callable[[], Any]]
"""An entity with something to do, and what makes the call of it."""


def find_work(executor: Any, nodes: Iterable[Any], now_ns: int) -> tuple[Task | None, int | None]:
    """The first thing to do as a task, or None and when the next timer ticks."""
    next_ns: int | None = None
    for node in tuple(nodes):
        for timer in node.timers:
            due_ns = timer.due_ns
            if due_ns is None or not timer.callback_group.can_execute(timer):
                continue
            if due_ns <= now_ns:
                timer.take()
                return _task(executor, timer, _timer_call(timer)), None
            next_ns = due_ns if next_ns is None else min(next_ns, due_ns)
        for entity, call in _waiting(node):
            if entity.callback_group.can_execute(entity):
                return _task(executor, entity, call()), None
    return None, next_ns


def _waiting(node: Any) -> Iterator[Due]:
    for entities, call in (
        (node.subscriptions, _message_call),
        (node.guards, _guard_call),
        (node.clients, _response_call),
        (node.services, _request_call),
    ):
        for entity in entities:
            if entity.is_waiting:
                yield entity, lambda entity=entity, call=call: call(entity)  # type: ignore[misc]


def _task(executor: Any, entity: Any, call: Callable[[], Any]) -> Task:
    group = entity.callback_group
    group.beginning_execution(entity)
    task = Task(call, executor=executor)

    def at_end() -> None:
        group.ending_execution(entity)
        executor.wake()

    task.at_end = at_end
    return task


def _timer_call(timer: Any) -> Callable[[], Any]:
    return lambda: timer.callback() if timer.callback is not None else None


def _message_call(subscription: Any) -> Callable[[], Any]:
    arguments = subscription.take()
    return lambda: subscription.callback(*arguments)


def _guard_call(guard: Any) -> Callable[[], Any]:
    guard.take()
    return lambda: guard.callback()


def _response_call(client: Any) -> Callable[[], Any]:
    future, response = client.take()
    return lambda: future.set_result(response)


def _request_call(service: Any) -> Callable[[], Any]:
    request, answer = service.take()

    async def respond() -> None:
        response = service.callback(request, service.srv_type.Response())
        if inspect.isawaitable(response):
            response = await response
        service.send_response(response, answer)

    return respond
