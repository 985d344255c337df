"""rclpy.timer, rclpy.guard_condition"""

from __future__ import annotations

import threading
from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.errors import Destroyable, Entity, RCLError, ROSInterruptException


class TimerHandle(Destroyable):
    """When a timer ticks: after every whole period, the first time after one; late ticks don't shift the later ones."""

    def __init__(self, period_ns: int, *, is_canceled: bool) -> None:
        super().__init__()
        self.period_ns = period_ns
        self.is_canceled = is_canceled
        self.last_ns = get_link().now_ns()
        self.next_ns = self.last_ns + period_ns
        self.wake: Any = lambda: None

    @property
    def due_ns(self) -> int | None:
        """When it ticks next; None where it does not."""
        return None if self.is_canceled or self.is_destroyed else self.next_ns

    def take(self) -> None:
        """A tick is being called."""
        now_ns = get_link().now_ns()
        self.last_ns = now_ns
        self.next_ns += self.period_ns
        if self.next_ns < now_ns:
            behind_ns = now_ns - self.next_ns
            missed = 1 + (behind_ns - 1) // self.period_ns if self.period_ns else 0
            self.next_ns = self.next_ns + missed * self.period_ns if self.period_ns else now_ns


class Timer(Entity):
    """Calls back once a period."""

    def __init__(
        self,
        callback: Any,
        callback_group: Any,
        timer_period_ns: int,
        clock: Any,
        *,
        context: Any = None,
        autostart: bool = True,
    ) -> None:
        if context is not None and not context._is_valid:
            raise RCLError(
                "failed to create timer: the given context is not valid, either rcl_init() was not called or "
                "rcl_shutdown() was called."
            )
        if timer_period_ns < 0:
            raise RCLError("failed to create timer: timer period must be non-negative")
        self._context = context
        self._clock = clock
        self.__timer = TimerHandle(int(timer_period_ns), is_canceled=not autostart)
        super().__init__(self.__timer)
        self.callback = callback
        self.callback_group = callback_group

    @property
    def clock(self) -> Any:
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        with self.handle:
            return self.__timer.period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        with self.handle:
            self.__timer.period_ns = int(value)

    def is_ready(self) -> bool:
        with self.handle:
            return not self.__timer.is_canceled and get_link().look() >= self.__timer.next_ns

    def is_canceled(self) -> bool:
        with self.handle:
            return self.__timer.is_canceled

    def cancel(self) -> None:
        with self.handle:
            self.__timer.is_canceled = True

    def reset(self) -> None:
        with self.handle:
            self.__timer.is_canceled = False
            self.__timer.next_ns = get_link().now_ns() + self.__timer.period_ns
            self.__timer.wake()

    def time_since_last_call(self) -> int:
        with self.handle:
            return get_link().look() - self.__timer.last_ns

    def time_until_next_call(self) -> int | None:
        with self.handle:
            return None if self.__timer.is_canceled else self.__timer.next_ns - get_link().look()


class Rate:
    """Sleeps until its timer ticks: somebody else has to spin meanwhile."""

    def __init__(self, timer: Timer, *, context: Any) -> None:
        self._timer = timer
        self._event = threading.Event()
        self._sleepers = 0
        self._is_shut_down = self._is_destroyed = False
        timer.callback = self._event.set
        context.on_shutdown(self._on_shutdown)

    def _on_shutdown(self) -> None:
        self._is_shut_down = True
        self.destroy()

    def destroy(self) -> None:
        self._is_destroyed = True
        self._event.set()

    def sleep(self) -> None:
        if self._is_shut_down:
            raise ROSInterruptException()
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")
        self._sleepers += 1
        try:
            self._event.wait()
        finally:
            self._sleepers -= 1
            if self._sleepers == 0:
                self._event.clear()
        if self._is_shut_down:
            raise ROSInterruptException()


class GuardHandle(Destroyable):
    """Whether it was triggered."""

    def __init__(self) -> None:
        super().__init__()
        self.is_waiting = False
        self.wake: Any = lambda: None


class GuardCondition(Entity):
    """Has an executor call something, from any thread."""

    def __init__(self, callback: Any, callback_group: Any, context: Any = None) -> None:
        self._context = context
        self.__gc = GuardHandle()
        super().__init__(self.__gc)
        self.callback = callback
        self.callback_group = callback_group

    def trigger(self) -> None:
        with self.handle:
            self.__gc.is_waiting = True
            self.__gc.wake()
