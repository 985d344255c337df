"""A node's log: sentences with a severity, in ROS's log where the node is one of ROS, else on standard error."""

from __future__ import annotations

import contextlib
import queue
import sys
import threading
from collections.abc import Callable
from typing import Literal

Severity = Literal["info", "warn", "error"]
Write = Callable[[Severity, str], None]
"""What puts one line into a log."""

FLUSH_S = 1.0


def on_stderr(_severity: Severity, text: str) -> None:
    """Write to this terminal: a `Write`."""
    with contextlib.suppress(OSError):
        print(text, file=sys.stderr, flush=True)


class Log:
    """Writes from a thread of its own: a terminal that is held up (Ctrl-S) or a pipe that nobody reads delays nothing.

    May be called from any thread.
    """

    def __init__(self, write: Write) -> None:
        self._write = write
        self._lines: queue.SimpleQueue[tuple[Severity, str] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="log", daemon=True)
        self._thread.start()

    def __call__(self, severity: Severity, text: str) -> None:
        self._lines.put((severity, text))

    def close(self) -> None:
        """Write what waits, for a moment."""
        self._lines.put(None)
        self._thread.join(FLUSH_S)

    def _run(self) -> None:
        while (line := self._lines.get()) is not None:
            self._write(*line)
