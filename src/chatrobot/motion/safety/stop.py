"""Stops: out at once from whatever thread, and booked afterwards by the control thread."""

from __future__ import annotations

import contextlib
import os
import socket
from collections.abc import Callable

from chatrobot.core.clock import Clock
from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.motion.governed_robot import Transport
from chatrobot.motion.safety.stop_confirmation import StopConfirmation
from chatrobot.wire.runtime_dir import stop_socket_path

PAUSED = "paused_by"
"""The code of a stop that keeps what was under way."""


class Stops:
    """`halt` may be called from any thread at any moment; the rest belongs to the control thread.

    Booking means that what ran and what waited is told its end, and that the robot is seen standing.
    """

    def __init__(
        self, epoch: StopEpoch, transport: Transport, stop_confirmation: StopConfirmation, clock: Clock
    ) -> None:
        self._epoch = epoch
        self._transport = transport
        self._stop_confirmation = stop_confirmation
        self._clock = clock
        self._booked = epoch.value
        self._asked = self._booked_ask = object()
        self._cleared = self._booked_clear = object()
        self.last_reason = self._clear_reason = Reason("cause_unknown")
        """Of the last stop, be it asked for or the end of a motion that failed."""

    def halt(self, why: Reason) -> None:
        """Stop now: the zero is out before this returns. It takes no lock and waits for nothing."""
        self._ask(why)
        self._transport.halt()

    def void(self, why: Reason) -> None:
        """What has been minted is worth nothing from now on; the zero goes out with the next tick.

        For a signal handler: it may have interrupted what sends in this very thread.
        """
        self._ask(why)
        self._epoch.stop()

    def _ask(self, why: Reason) -> None:
        self.last_reason = why
        if why.code != PAUSED:
            self._clear_reason = why
            self._cleared = object()
        self._asked = object()

    @property
    def count(self) -> int:
        """Changes with every stop: what was asked before it does not count any more."""
        return self._epoch.value

    @property
    def is_unbooked(self) -> bool:
        return self._booked != self._epoch.value

    def book(self) -> Reason | None:
        """Why the robot was stopped since the last time, None where it was not; from now on zeros are sent.

        Of a pause and a stop that came together the stop counts.
        """
        if not self.is_unbooked:
            return None
        self._booked_ask = self._asked
        self._booked = self._epoch.value
        cleared, self._booked_clear = self._cleared is not self._booked_clear, self._cleared
        self._stop_confirmation.begin(self._clock.now_s())
        return self._clear_reason if cleared else self.last_reason

    def halt_and_book(self, why: Reason) -> None:
        """The stop at the end of a motion that failed or was broken off: what waits is not touched by it.

        One that came from elsewhere in the same moment is left to be booked, and does clear what waits.
        """
        self._transport.halt()
        count = (
            self._epoch.value
        )  # two at the same instant may share one value: the count alone does not tell
        if self._asked is self._booked_ask:
            self._booked, self.last_reason = count, why
        self._stop_confirmation.begin(self._clock.now_s())


def serve_stop(stop: Callable[[], str]) -> None:
    """For ever: who calls on this process's socket stops the robot, and is answered when the zero is out.

    Args:
        stop: stops, and returns in a word what was found.
    """
    path = stop_socket_path(os.getpid())
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        with contextlib.suppress(FileNotFoundError):
            path.unlink()
        listener.bind(str(path))
        listener.listen(4)
        while True:
            caller, _ = listener.accept()
            with caller:
                found = stop()
                with contextlib.suppress(OSError):
                    caller.send(found.encode())


def remove_stop_socket() -> None:
    """Nobody serves it any more."""
    with contextlib.suppress(OSError):
        stop_socket_path(os.getpid()).unlink()
