"""Tables made of the data files, kept in the user's cache folder: to make them takes seconds, to read them little."""

from __future__ import annotations

import contextlib
import marshal
import os
import sys
import zlib
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, overload

from chatrobot.language.data_files import DATA

Compiled = TypeVar("Compiled")
Value = TypeVar("Value")
Other = TypeVar("Other")
Key = tuple[str, ...]
Kept = dict[str, bytes]
_CHECK_BYTES = 4
_STATES_KEPT = 4
"""Two checkouts whose starts take turns do not take each other's tables away."""


class PhraseTable(Mapping[Key, Value]):
    """What each phrase stands for, as `by_first` keeps it: what begins with a word is read once a phrase with it comes.

    A sentence looks up some of a hundred thousand phrases; to read all takes longer than to understand it.
    """

    def __init__(self, kept: Kept) -> None:
        self._kept = kept
        self._read: dict[str, dict[Key, Value]] = {}

    def __getitem__(self, key: Key) -> Value:
        return self._beginning_with(key[0] if key else "")[key]

    @overload
    def get(self, key: Key, /) -> Value | None: ...
    @overload
    def get(self, key: Key, /, default: Value | Other) -> Value | Other: ...
    def get(self, key: Key, /, default: Any = None) -> Any:
        """Return what the phrase stands for, or `default`."""
        return self._beginning_with(key[0] if key else "").get(key, default)

    def __contains__(self, key: object) -> bool:
        return isinstance(key, tuple) and self.get(key, self) is not self

    def __iter__(self) -> Iterator[Key]:
        for first in self._kept:
            yield from self._beginning_with(first)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def _beginning_with(self, first: str) -> dict[Key, Value]:
        if first not in self._read and first in self._kept:
            self._read[first] = marshal.loads(self._kept[first])
        return self._read.get(first, {})


def by_first(table: Mapping[Key, Any]) -> Kept:
    """Return a table as `compiled` can keep it for a `PhraseTable`: what begins with each word, by that word."""
    found: dict[str, dict[Key, Any]] = {}
    for key, value in table.items():
        found.setdefault(key[0], {})[key] = value
    return {first: marshal.dumps(phrases) for first, phrases in found.items()}


def compiled(name: str, build: Callable[[], Compiled]) -> Compiled:
    """Return what `build` makes of the data files: from the user's cache folder, where a start before has left it.

    What is left there is of the very same files of this package, or is built anew, as where it is broken or the folder
    cannot be written. `build` returns what `marshal` takes.
    """
    from platformdirs import user_cache_path

    try:
        folder = user_cache_path("chatrobot")
    except RuntimeError:  # there is no home folder
        return build()
    file = folder / f"{name}-{_fingerprint():08x}.bin"
    with contextlib.suppress(OSError, ValueError, EOFError, TypeError):
        kept = memoryview(file.read_bytes())
        if zlib.crc32(kept[_CHECK_BYTES:]) == int.from_bytes(kept[:_CHECK_BYTES], "big"):
            found: Compiled = marshal.loads(kept[_CHECK_BYTES:])
            return found
    made = build()
    with contextlib.suppress(OSError):
        _leave(file, made)
        for old in sorted(folder.glob(f"{name}-*.bin"), key=lambda one: one.stat().st_mtime_ns)[
            :-_STATES_KEPT
        ]:
            old.unlink()
    return made


def _leave(file: Path, made: Any) -> None:
    written = marshal.dumps(made)
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    beside = file.with_suffix(f".{os.getpid()}")
    beside.write_bytes(zlib.crc32(written).to_bytes(_CHECK_BYTES, "big") + written)
    beside.replace(file)


@cache
def _fingerprint() -> int:
    """A number for the state of every file of the language, and the Python that reads them."""
    files = sorted([*DATA.rglob("*.toml"), *Path(__file__).parent.glob("*.py")])
    states = [(str(file), (state := file.stat()).st_size, state.st_mtime_ns) for file in files]
    return zlib.crc32(repr((sys.version, states)).encode())
