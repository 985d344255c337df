"""Weights that were fitted to what people say: a byte for each slot of a hashed feature."""

from __future__ import annotations

import zlib
from functools import lru_cache

from chatrobot.language.data_files import DATA

SLOTS = 1 << 18
"""So many weights has a file, but for those that tell another number."""
SCALE = 24.0
"""A weight of one is this much in a byte."""


def slot_of(name: str, slots: int = SLOTS) -> int:
    """Where the weight of a feature is kept, among so many. `slots` is a power of two."""
    return zlib.crc32(name.encode()) & (slots - 1)


def bucket(value: float, width: float = 1.0) -> int:
    """A number as one of eleven classes, each as wide as told."""
    return round(max(-5.0, min(5.0, value / width)))


@lru_cache(maxsize=4)
def weights(name: str) -> memoryview:
    """The weights of `data/<name>.bin`, in parts of `SCALE`."""
    return memoryview(zlib.decompress((DATA / f"{name}.bin").read_bytes())).cast("b")
