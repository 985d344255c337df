"""rclpy.task, rclpy.callback_groups"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Generator
from typing import Any

from chatrobot.programs.inside.link import get_link


class Future:
    """A result that comes later. `add_done_callback` calls at once where it is there."""

    def __init__(self, *, executor: Any = None) -> None:
        self._done = self._cancelled = False
        self._result: Any = None
        self._exception: BaseException | None = None
        self._callbacks: list[Callable[[Any], Any]] = []
        self._executor = executor

    def __await__(self) -> Generator[Any, None, Any]:
        while not self._done:
            yield self
        return self.result()

    def cancel(self) -> None:
        if not self._done:
            self._cancelled = True
            self._call_back()

    def cancelled(self) -> bool:
        return self._cancelled

    def done(self) -> bool:
        get_link().look()
        return self._done

    def result(self) -> Any:
        if self._exception is not None:
            raise self._exception
        return self._result

    def exception(self) -> BaseException | None:
        return self._exception

    def set_result(self, result: Any) -> None:
        self._result = result
        self._finish()

    def set_exception(self, exception: BaseException) -> None:
        self._exception = exception
        self._finish()

    def add_done_callback(self, callback: Callable[[Any], Any]) -> None:
        if self._done:
            callback(self)
        else:
            self._callbacks.append(callback)

    def _finish(self) -> None:
        self._done = True
        self._call_back()

    def _call_back(self) -> None:
        callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            callback(self)


class Task(Future):
    """A function or coroutine that an executor runs; a coroutine goes on when what it awaits is done."""

    def __init__(
        self, handler: Any, args: Any = None, kwargs: dict[str, Any] | None = None, executor: Any = None
    ) -> None:
        super().__init__(executor=executor)
        self._handler = handler
        self._args = args or ()
        self._kwargs = kwargs or {}
        self.__is_executing = False
        self._at_end: Callable[[], None] | None = None
        """Called once, when it is over."""

    def executing(self) -> bool:
        """It runs, or waits for what it awaits."""
        return self.__is_executing and not self._done

    def __call__(self) -> None:
        """Run it to its end, or to the next thing it awaits."""
        if self._done:
            return
        self.__is_executing = True
        try:
            if not inspect.iscoroutine(self._handler):
                result = self._handler(*self._args, **self._kwargs)
                if not inspect.iscoroutine(result):
                    self._end(result)
                    return
                self._handler = result
            awaited = self._handler.send(None)
        except StopIteration as end:
            self._end(end.value)
        except BaseException as error:  # noqa: BLE001 - it leaves through whoever spins
            self._exception = error
            self._end(None)
        else:
            self._await(awaited)

    def _await(self, awaited: Any) -> None:
        if isinstance(awaited, Future):
            awaited.add_done_callback(lambda _: self._go_on())
        else:
            self._go_on()

    def _go_on(self) -> None:
        if self._executor is not None:
            self._executor._resume(self)

    def _end(self, result: Any) -> None:
        if self._at_end is not None:
            self._at_end()
        self._result = result
        self._finish()


class CallbackGroup:
    """Says which callbacks may run beside which. Entities that no executor may run now wait."""

    def __init__(self) -> None:
        self.entities: set[int] = set()

    def add_entity(self, entity: Any) -> None:
        self.entities.add(id(entity))

    def has_entity(self, entity: Any) -> bool:
        return id(entity) in self.entities

    def can_execute(self, entity: Any) -> bool:
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """Any number at a time."""

    def can_execute(self, entity: Any) -> bool:
        return True

    def beginning_execution(self, entity: Any) -> bool:
        return True

    def ending_execution(self, entity: Any) -> None:
        pass


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One at a time."""

    def __init__(self) -> None:
        super().__init__()
        self._active: Any = None

    def can_execute(self, entity: Any) -> bool:
        return self._active is None

    def beginning_execution(self, entity: Any) -> bool:
        if self._active is not None:
            return False
        self._active = entity
        return True

    def ending_execution(self, entity: Any) -> None:
        if self._active is entity:
            self._active = None
