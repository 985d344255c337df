"""The output of a program: read as it comes, kept up to a limit, never in anybody's way."""

from __future__ import annotations

import os
import threading
import time

_CHUNK_BYTES = 1 << 16
_FLOOD_PAUSE_S = 0.01
"""Once the limit is reached, 64 KB each 10 ms: whoever floods waits, and nobody else."""

_SILENCED = dict.fromkeys(
    [code for code in range(0xA0) if (code < 0x20 or code >= 0x7F) and chr(code) not in "\n\t"]
    # What turns the direction of writing around, so that a line reads otherwise than it is.
    + [*range(0x202A, 0x202F), *range(0x2066, 0x206A)]
)


class LogDrain:
    """Reads a pipe on a thread of its own until its writer is gone.

    Args:
        descriptor: reading end; closed here.
        limit_bytes: most that is kept until somebody takes it.
    """

    def __init__(self, descriptor: int, limit_bytes: int) -> None:
        self._descriptor = descriptor
        self._limit_bytes = limit_bytes
        self._lock = threading.Lock()
        self._kept = bytearray()
        self._dropped_bytes = 0
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        self._thread = threading.Thread(target=self._drain, name="sandbox log", daemon=True)
        self._thread.start()

    def take(self) -> str:
        """What is new. Bytes that are no UTF-8 are replaced; a character that came in half waits for its rest.

        Control characters are left out: this is shown on terminals, which obey them.
        """
        with self._lock:
            whole = _whole_characters(self._kept)
            text = self._kept[:whole].decode("utf-8", "replace")
            del self._kept[:whole]
            dropped, self._dropped_bytes = self._dropped_bytes, 0
        return text.translate(_SILENCED) + (f"\n[… {dropped} bytes more]\n" if dropped else "")

    def finish(self, timeout_s: float) -> None:
        """Wait for the last words of a writer that is gone."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def close(self) -> None:
        """Let go of the pipe; the thread ends when the writer is gone, at once if it never began."""
        if self._thread is None:
            os.close(self._descriptor)

    def _drain(self) -> None:
        while chunk := os.read(self._descriptor, _CHUNK_BYTES):
            with self._lock:
                room = max(0, self._limit_bytes - len(self._kept))
                self._kept += chunk[:room]
                self._dropped_bytes += len(chunk) - min(room, len(chunk))
                is_flood = room < len(chunk)
            if is_flood:
                time.sleep(_FLOOD_PAUSE_S)
        os.close(self._descriptor)


def _whole_characters(data: bytearray) -> int:
    """How many bytes there are before a character that is not whole yet."""
    for back in range(1, min(4, len(data)) + 1):
        byte = data[-back]
        if byte >= 0xC0:
            needed = 2 if byte < 0xE0 else 3 if byte < 0xF0 else 4
            return len(data) - back if needed > back else len(data)
        if byte < 0x80:
            break
    return len(data)
