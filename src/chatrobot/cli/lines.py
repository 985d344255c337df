"""Lines from standard input, read by a thread: a stop word is acted on when it arrives, not when there is time."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable

STDIN = 0
MAX_LINE_BYTES = 65_536


class LineReader:
    """Hands every line that is not blank to `on_line`, in a thread of its own.

    Reads the descriptor itself: a buffered stream
    would be locked by this thread when the interpreter ends.
    """

    def __init__(self, on_line: Callable[[str], None]) -> None:
        self._on_line = on_line
        self._ended = threading.Event()

    @property
    def has_ended(self) -> bool:
        """The last line has been handed on."""
        return self._ended.is_set()

    def wait(self, timeout_s: float) -> None:
        """Until the last line has been handed on, or for so long."""
        self._ended.wait(timeout_s)

    def start(self) -> None:
        threading.Thread(target=self._read, name="input", daemon=True).start()

    def _read(self) -> None:
        rest = b""
        while chunk := _read_chunk():
            *lines, rest = (rest + chunk).split(b"\n")
            for line in lines:
                self._hand_on(line)
            if len(rest) > MAX_LINE_BYTES:
                self._hand_on(rest)
                rest = b""
        self._hand_on(rest)
        self._ended.set()

    def _hand_on(self, line: bytes) -> None:
        text = line.decode("utf-8", errors="replace").strip()
        if text:
            self._on_line(text)


def _read_chunk() -> bytes:
    """What is there; nothing at the end, or where a terminal has gone away."""
    try:
        return os.read(STDIN, MAX_LINE_BYTES)
    except OSError:
        return b""
