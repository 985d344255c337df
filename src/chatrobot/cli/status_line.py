"""What passes, such as how far a motion is: the last line of the terminal that errors go to, and nowhere else."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Iterator

_CLEAR = "\r\x1b[K"


class StatusLine:
    """Shown where a person may look: a pipe, a file and a terminal without a cursor get nothing of it."""

    def __init__(self) -> None:
        self._is_shown = False

    def show(self, text: str) -> None:
        """Say it in place of what was said there."""
        if sys.stderr.isatty() and os.environ.get("TERM", "dumb") != "dumb":
            self._is_shown = True
            _write(
                f"{_CLEAR}{text[: shutil.get_terminal_size().columns - 1]}"
            )  # a longer line could not be cleared

    def clear(self) -> None:
        """Leave the line to what stays."""
        if self._is_shown:
            self._is_shown = False
            _write(_CLEAR)


@contextlib.contextmanager
def status_line() -> Iterator[StatusLine]:
    """Give a line that is cleared at the end."""
    line = StatusLine()
    try:
        yield line
    finally:
        line.clear()


def _write(text: str) -> None:
    with contextlib.suppress(OSError):  # the terminal has gone
        print(text, end="", file=sys.stderr, flush=True)
