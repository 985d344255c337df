"""Lines from standard input, read by a thread: a stop word is acted on when it arrives, not when there is time."""

from __future__ import annotations

import os
import re
import select
import sys
import threading
import time
from collections.abc import Callable

from chatrobot.link.envelope import MOST_CHARACTERS

STDIN = 0
MAX_LINE_BYTES = MOST_CHARACTERS
PASTE_S = 0.3
"""Lines that are pasted come at once; a terminal hands them on one by one."""
GOODBYES = frozenset({"quit", "exit", "/quit", "/exit"})
"""Lines that leave, as in other programs. "quit" is a stop word, too: it stops a robot that moves."""
_ITEM = re.compile(r"(?:\(?\d{1,2}[.,:、，．)]|[-*•·])\s*\S")
"""A point of a list: `1, the car needs to …`, `- then turn`."""


def has_keyboard() -> bool:
    """Somebody may type here: a terminal, and we are not in its background."""
    try:
        return sys.stdin.isatty() and os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    except (OSError, ValueError):
        return False


class Joiner:
    """Makes texts of lines: each is one, but a line that ends in a colon and the list that comes with it are one
    together: `…, as follows:`, `1, …`, `2, …`."""

    def __init__(self) -> None:
        self._held: list[str] = []

    @property
    def is_holding(self) -> bool:
        """A heading waits for its list."""
        return bool(self._held)

    def take(self, line: str) -> list[str]:
        """Return the texts that are complete with this line."""
        text = line.strip()
        if not text:
            return []
        if self._held and _ITEM.match(text):
            self._held.append(text)
            return []
        complete = self.let_go()
        if text.endswith((":", "：")):
            self._held.append(text)
        else:
            complete.append(text)
        return complete

    def let_go(self) -> list[str]:
        """Return what was held back for its list, with it."""
        held, self._held = self._held, []
        return ["\n".join(held)] if held else []


def texts_in(lines: str) -> list[str]:
    """Return the texts of several lines that came at once."""
    joiner = Joiner()
    texts = [text for line in lines.splitlines() for text in joiner.take(line)]
    return texts + joiner.let_go()


class LineSplitter:
    """Cuts what is read into lines. One that is too long stays so, for nobody to act on a part of it."""

    def __init__(self) -> None:
        self._rest = b""

    def take(self, chunk: bytes) -> list[str]:
        """Return the lines that are complete with `chunk`."""
        *lines, rest = (self._rest + chunk).split(b"\n")
        self._rest = rest[: MAX_LINE_BYTES + 1]
        return [_as_text(line) for line in lines]

    def end(self) -> str:
        """Return the last line, which has no newline; "" where there is none."""
        rest, self._rest = self._rest, b""
        return _as_text(rest)


def _as_text(line: bytes) -> str:
    text = line[: MAX_LINE_BYTES + 1].decode("utf-8", errors="replace")
    return text.strip().ljust(MAX_LINE_BYTES + 1, "…") if len(line) > MAX_LINE_BYTES else text


class LineReader:
    """Hands every text to `on_line`, in a thread of its own: see `Joiner`. Texts that come at once have one `on_read`
    before them.

    Reads the descriptor itself: a buffered stream would be locked by this thread when the interpreter ends.
    """

    def __init__(self, on_line: Callable[[str], None], on_read: Callable[[], None] = lambda: None) -> None:
        self._on_line = on_line
        self._on_read = on_read
        self._ended = threading.Event()
        self._joiner = Joiner()

    @property
    def has_ended(self) -> bool:
        """The last line has been handed on."""
        return self._ended.is_set()

    def wait(self, timeout_s: float) -> None:
        """Wait until the last line has been handed on, or for so long."""
        self._ended.wait(timeout_s)

    def start(self) -> None:
        """Begin to read."""
        threading.Thread(target=self._read, name="input", daemon=True).start()

    def _read(self) -> None:
        splitter = LineSplitter()
        while True:
            if self._joiner.is_holding and not select.select([STDIN], [], [], PASTE_S)[0]:
                self._say(self._joiner.let_go())
            chunk = read_chunk()
            if not chunk:
                break
            self._on_read()
            for line in splitter.take(chunk):
                self._say(self._joiner.take(line))
        self._say(self._joiner.take(splitter.end()))
        self._say(self._joiner.let_go())
        self._ended.set()

    def _say(self, texts: list[str]) -> None:
        for text in texts:
            self._on_line(text)


def read_chunk() -> bytes:
    """Read what is there; nothing at the end, or where a terminal has gone away."""
    try:
        return os.read(STDIN, MAX_LINE_BYTES)
    except OSError:
        return b""


AT_ONCE_S = 0.05
"""Nobody types a line in less; a terminal hands on what was pasted faster."""


class TypedAhead:
    """Reads the terminal in a thread of its own, from `start` to `stop`."""

    def __init__(self) -> None:
        self.has_ended = False
        """The person has closed the input."""
        self._chunks: list[tuple[float, bytes]] = []
        self._wake_read, self._wake_write = os.pipe()
        self._thread = threading.Thread(target=self._read, name="typed-ahead", daemon=True)

    def start(self) -> None:
        """Begin to read."""
        self._thread.start()

    def stop(self) -> list[str]:
        """Read no more; what was typed: a line each, or several in one where they came at once."""
        if self._thread.is_alive():
            os.write(self._wake_write, b"\0")
            self._thread.join()
        texts: list[bytes] = []
        last_s = float("-inf")
        for at_s, chunk in self._chunks:
            if at_s - last_s < AT_ONCE_S and texts:
                texts[-1] += chunk
            else:
                texts.append(chunk)
            last_s = at_s
        self._chunks.clear()
        return [text.decode("utf-8", "replace").rstrip("\n") for text in texts if text.strip()]

    def _read(self) -> None:
        while not self.has_ended:
            ready, _, _ = select.select([STDIN, self._wake_read], [], [])
            if STDIN not in ready:
                return
            try:
                chunk = os.read(STDIN, MAX_LINE_BYTES)
            except OSError:  # the terminal has gone: whoever reads next sees it
                return
            self.has_ended = not chunk
            self._chunks.append((time.monotonic(), chunk))
