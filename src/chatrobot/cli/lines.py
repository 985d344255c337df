"""Lines from standard input, read by a thread: a stop word is acted on when it arrives, not when there is time."""

from __future__ import annotations

import os
import re
import select
import threading
from collections.abc import Callable

STDIN = 0
MAX_LINE_BYTES = 65_536
PASTE_S = 0.3
"""Lines that are pasted come at once; a terminal hands them on one by one."""
_ITEM = re.compile(r"(?:\(?\d{1,2}[.,:、，．)]|[-*•·])\s*\S")
"""A point of a list: `1, the car needs to …`, `- then turn`."""


class LineReader:
    """Hands every line that is not blank to `on_line`, in a thread of its own.

    A line that ends in a colon and the list that comes with it are one text: `…, as follows:`, `1, …`, `2, …`.
    Reads the descriptor itself: a buffered stream would be locked by this thread when the interpreter ends.
    """

    def __init__(self, on_line: Callable[[str], None]) -> None:
        self._on_line = on_line
        self._ended = threading.Event()
        self._held: list[str] = []

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
        while True:
            if self._held and not select.select([STDIN], [], [], PASTE_S)[0]:
                self._let_go()
            chunk = _read_chunk()
            if not chunk:
                break
            *lines, rest = (rest + chunk).split(b"\n")
            for line in lines:
                self._hand_on(line)
            if len(rest) > MAX_LINE_BYTES:
                self._hand_on(rest)
                rest = b""
        self._hand_on(rest)
        self._let_go()
        self._ended.set()

    def _hand_on(self, line: bytes) -> None:
        text = line.decode("utf-8", errors="replace").strip()
        if not text:
            return
        if self._held and _ITEM.match(text):
            self._held.append(text)
            return
        self._let_go()
        if text.endswith((":", "：")):
            self._held.append(text)
        else:
            self._on_line(text)

    def _let_go(self) -> None:
        """What was held back for its list goes on, with it."""
        held, self._held = self._held, []
        if held:
            self._on_line("\n".join(held))


def _read_chunk() -> bytes:
    """What is there; nothing at the end, or where a terminal has gone away."""
    try:
        return os.read(STDIN, MAX_LINE_BYTES)
    except OSError:
        return b""
