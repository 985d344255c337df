"""Standard output as a stream that may break: a robot must not run on because a pipe did."""

from __future__ import annotations

import os
import select

STDOUT = 1


class Output:
    """Standard output, each piece at once. It never raises: a robot must not run on because a pipe broke."""

    def __init__(self) -> None:
        self._broken = False
        self._poll = select.poll()
        self._poll.register(STDOUT, 0)

    def write(self, text: str) -> None:
        if self._broken:
            return
        data = memoryview(text.encode("utf-8", errors="replace"))
        try:
            while data:
                data = data[os.write(STDOUT, data) :]
        except OSError:
            self._broken = True

    @property
    def is_broken(self) -> bool:
        """A reader that has left shows before anything more is written to it."""
        if not self._broken:
            self._broken = any(state & (select.POLLERR | select.POLLNVAL) for _, state in self._poll.poll(0))
        return self._broken

    @property
    def is_terminal(self) -> bool:
        return os.isatty(STDOUT)
