"""Reads the data files of a language. A third language is a third folder under `data/`."""

from __future__ import annotations

import contextlib
import itertools
import marshal
import os
import re
import sys
import zlib
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

DATA = Path(__file__).parent / "data"
LANGUAGES = ("en", "zh")
"""The languages whose words the reader knows. Any other is put into the English ones first, see `gloss.py`."""
REPLY_LANGUAGES = (*LANGUAGES, "de")
"""The languages that people are answered in."""

Compiled = TypeVar("Compiled")
_CHECK_BYTES = 4
_BRACES = re.compile(r"\{([^{}]*)\}")
_NEVER = re.compile("(?!)")
_PART = re.compile(r"(?<!\?P)<(\w+)>")


@cache
def load_table(language: str, name: str) -> dict[str, Any]:
    """One TOML file of a language, as it stands; an empty table where that language has none.

    A language that is put into English words to be read has the English table where it has none of its own.
    """
    path = DATA / language / f"{name}.toml"
    if not path.exists():
        return {} if language in LANGUAGES else load_table(LANGUAGES[0], name)
    return tomllib.loads(path.read_text(encoding="utf-8"))


@cache
def relation_words(name: str) -> frozenset[str]:
    """The words of one list of `relations.toml` in all languages: how a motion lies to something else."""
    tables = (load_table(code, "relations") for code in REPLY_LANGUAGES)
    return frozenset(word for table in tables for word in table.get(name, ()))


def expand(pattern: str) -> list[str]:
    """`turn{,s} left` → `turn left`, `turns left`."""
    parts = _BRACES.split(pattern)
    if len(parts) == 1:
        return [pattern]
    choices = [part.split(",") if i % 2 else [part] for i, part in enumerate(parts)]
    return [" ".join("".join(chosen).split()) for chosen in itertools.product(*choices)]


def in_full(pattern: str, parts: Mapping[str, str]) -> str:
    """A pattern with what each `<name>` in it stands for, which may name others."""
    found = _PART.search(pattern)
    if found is None:
        return pattern
    stands_for = parts[found[1]]
    grouped = stands_for if stands_for.startswith("(") else f"(?:{stands_for})"
    return in_full(pattern.replace(found[0], grouped), parts)


@cache
def forms(language: str, table: str, name: str) -> tuple[re.Pattern[str], ...]:
    """The patterns that a table lists under a name, with its `[parts]` put in; none where that language has none."""
    found = load_table(language, table)
    listed = found.get(name, ())
    listed = [listed] if isinstance(listed, str) else listed
    return tuple(re.compile(in_full(pattern, found.get("parts", {}))) for pattern in listed)


def form(language: str, table: str, name: str) -> re.Pattern[str]:
    """The one pattern under that name; one that never matches where that language has none."""
    return next(iter(forms(language, table, name)), _NEVER)


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
        kept = file.read_bytes()
        if zlib.crc32(kept[_CHECK_BYTES:]) == int.from_bytes(kept[:_CHECK_BYTES], "big"):
            found: Compiled = marshal.loads(kept[_CHECK_BYTES:])
            return found
    made = build()
    with contextlib.suppress(OSError):
        _leave(file, made)
        for old in folder.glob(f"{name}-*.bin"):
            if old != file:
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
