"""rclpy.timer"""

from __future__ import annotations

import threading
from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy._rclpy_pybind11 import DESTROYED, InvalidHandle, RCLError
from chatrobot.programs.names.rclpy.exceptions import ROSInterruptException


class Timer:
    """Ticks after every whole period, the first time after one; late ticks don't shift the later ones."""

    def __init__(
        self,
        callback: Any,
        callback_group: Any,
        timer_period_ns: int,
        clock: Any,
        *,
        context: Any = None,
        autostart: bool = True,
        wake: Any = None,
    ) -> None:
        if timer_period_ns < 0:
            raise RCLError("failed to create timer: timer period must be non-negative")
        self.callback = callback
        self.callback_group = callback_group
        self._period_ns = int(timer_period_ns)
        self._clock = clock
        self._wake = wake or (lambda: None)
        self._is_canceled = not autostart
        self._is_destroyed = False
        self._last_ns = get_link().now_ns()
        self._next_ns = self._last_ns + self._period_ns

    @property
    def clock(self) -> Any:
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        self._check()
        return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        self._check()
        self._period_ns = int(value)

    @property
    def due_ns(self) -> int | None:
        """When it ticks next; None where it does not."""
        return None if self._is_canceled or self._is_destroyed else self._next_ns

    def is_ready(self) -> bool:
        self._check()
        return not self._is_canceled and get_link().look() >= self._next_ns

    def take(self) -> None:
        """A tick is being called."""
        now_ns = get_link().now_ns()
        self._last_ns = now_ns
        self._next_ns += self._period_ns
        if self._next_ns < now_ns:
            behind_ns = now_ns - self._next_ns
            missed = 1 + (behind_ns - 1) // self._period_ns if self._period_ns else 0
            self._next_ns = self._next_ns + missed * self._period_ns if self._period_ns else now_ns

    def is_canceled(self) -> bool:
        self._check()
        return self._is_canceled

    def cancel(self) -> None:
        self._check()
        self._is_canceled = True

    def reset(self) -> None:
        self._check()
        self._is_canceled = False
        self._next_ns = get_link().now_ns() + self._period_ns
        self._wake()

    def time_since_last_call(self) -> int:
        return get_link().look() - self._last_ns

    def time_until_next_call(self) -> int | None:
        return None if self._is_canceled else self._next_ns - get_link().look()

    def destroy(self) -> None:
        self._is_destroyed = True

    @property
    def is_destroyed(self) -> bool:
        return self._is_destroyed

    def _check(self) -> None:
        if self._is_destroyed:
            raise InvalidHandle(DESTROYED)

    def __enter__(self) -> Timer:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


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
