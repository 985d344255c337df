"""Ctrl-C, Ctrl-Z and their relatives: the robot stops first, whatever this process is doing just now."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import threading
import time
from collections.abc import Callable
from typing import Any

from chatrobot.core.errors import LinkError

QUIT_AT_ONCE = 130
_WATCHED = {
    signal.SIGINT: "Ctrl-C",
    signal.SIGTSTP: "Ctrl-Z",
    signal.SIGHUP: "the terminal was closed",
    signal.SIGTERM: "asked to end",
}


class SignalWatch:
    """Stops the robot from a thread of its own: Python's handlers would wait for whatever the main thread does.

    A signal that was ignored when we started (nohup, a job in the background) stays ignored. A second one of
    those that end us quits at once; Motion takes that for a loss and stops by itself.

    Args:
        stop: called with the reason, from that thread.
        repeats_s: so soon after the first a second one is the same, sent twice, and ends nothing more. Then no Ctrl-C
            is heard after the watch either: it would only break the orderly end.
    """

    def __init__(self, stop: Callable[[str], None], *, repeats_s: float = 0.0) -> None:
        self._stop = stop
        self._repeats_s = repeats_s
        self._leaving_since_s = 0.0
        self.is_leaving = False
        self._before: dict[int, Any] = {}
        self._ours, self._theirs = socket.socketpair()

    def __enter__(self) -> SignalWatch:
        self._theirs.setblocking(False)
        signal.set_wakeup_fd(self._theirs.fileno(), warn_on_full_buffer=False)
        for number in _WATCHED:
            if signal.getsignal(number) is not signal.SIG_IGN:
                self._before[number] = signal.signal(number, _leave_it_to_the_thread)
        threading.Thread(target=self._watch, name="signals", daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        if self.is_leaving and self._repeats_s > 0.0 and signal.SIGINT in self._before:
            self._before[signal.SIGINT] = signal.SIG_IGN
        for number, handler in self._before.items():
            signal.signal(number, handler)
        signal.set_wakeup_fd(-1)
        self._theirs.close()

    def _watch(self) -> None:
        with self._ours:
            while numbers := self._ours.recv(64):
                for number in numbers:
                    if number in _WATCHED:
                        self._on_signal(signal.Signals(number))

    def _on_signal(self, number: signal.Signals) -> None:
        if number != signal.SIGTSTP:
            if self.is_leaving:
                self._hear_again()
                return
            self._leaving_since_s = time.monotonic()
            self.is_leaving = True
        with contextlib.suppress(LinkError):  # Motion is gone: its guard halts, and the main thread will tell
            self._stop(_WATCHED[number])
        if number == signal.SIGTSTP:
            os.kill(os.getpid(), signal.SIGSTOP)

    def _hear_again(self) -> None:
        if time.monotonic() - self._leaving_since_s >= self._repeats_s:
            os._exit(QUIT_AT_ONCE)


def _leave_it_to_the_thread(*_: object) -> None:
    """Only a signal with a handler of Python's is written to the wakeup descriptor."""
