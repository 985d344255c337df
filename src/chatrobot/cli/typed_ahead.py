"""What a person types while the console is still starting: kept as it was typed, each line with its moment.

Read all at once later, these lines would look like a paste.
"""

from __future__ import annotations

import os
import select
import threading
import time

from chatrobot.cli.lines import MAX_LINE_BYTES, STDIN

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
