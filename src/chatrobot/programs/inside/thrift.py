"""What a program prints is worth reading only up to a point: a flood is cut, and says so."""

from __future__ import annotations

from collections.abc import Iterator

BURST_BYTES = 64 * 1024
BYTES_PER_S = 8 * 1024


class Thrift:
    """A budget of text that refills with time."""

    def __init__(self) -> None:
        self._left = float(BURST_BYTES)
        self._counted_ns = 0
        self._dropped = 0

    def passes(self, text: str, now_ns: int) -> Iterator[str]:
        """`text` where the budget allows it, after a word on what it did not allow before."""
        self._left += max(0, now_ns - self._counted_ns) * 1e-9 * BYTES_PER_S
        self._left = min(self._left, float(BURST_BYTES))
        self._counted_ns = now_ns
        if len(text) > self._left:
            self._dropped += 1
            return
        self._left -= len(text)
        if self._dropped:
            yield f"[{self._dropped} lines dropped]"
            self._dropped = 0
        yield text
