"""The ends of turns, told in the order they came: those after a motion whose robot does not stand yet wait for it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import replace

from chatrobot.core.events import Event, Finished


class OutcomeQueue:
    """Belongs to the control thread. An end is made when it is told, so that it says what was measured by then.

    Args:
        measured: the robot has odometry; without, no end is told as measured, and be it of what never moved.
    """

    def __init__(self, emit: Callable[[Event], None], *, measured: bool) -> None:
        self._emit = emit
        self._measured = measured
        self._untold: deque[Callable[[], Finished]] = deque()

    @property
    def are_told(self) -> bool:
        return not self._untold

    def tell(self, end: Callable[[], Finished]) -> None:
        """Tell it now, or after those that wait."""
        if self._untold:
            self._untold.append(end)
        else:
            self._tell(end)

    def tell_later(self, end: Callable[[], Finished]) -> None:
        """Tell it once the robot stands."""
        self._untold.append(end)

    def tell_all(self) -> None:
        """The robot stands, or nobody sees whether it does."""
        while self._untold:
            self._tell(self._untold.popleft())

    def _tell(self, end: Callable[[], Finished]) -> None:
        finished = end()
        self._emit(finished if self._measured else replace(finished, measured=False))
