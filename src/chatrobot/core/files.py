"""Files that are written whole or not at all: a full disk or a kill leaves what was there before."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path


def write_whole(path: Path, text: str) -> None:
    """Put `text` in place of that file, or make it, and its folder; a link stays one.

    Raises:
        OSError: it cannot be written; it names the file.
    """
    target = path.resolve()
    target.parent.mkdir(parents=True, exist_ok=True)
    beside = target.with_name(f".{target.name}.new")
    try:
        beside.write_text(text, encoding="utf-8")
        os.replace(beside, target)
    except OSError as error:
        with contextlib.suppress(OSError):
            beside.unlink()
        raise _named(error, path) from error


def write_new(path: Path, text: str) -> None:
    """Make that file, which is not there yet.

    Raises:
        FileExistsError: it is.
        OSError: it cannot be written; it names the file.
    """
    try:
        file = path.open("x", encoding="utf-8")
        try:
            with file:
                file.write(text)
        except (OSError, ValueError):  # a full disk, or what is no text
            path.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise _named(error, path) from error


def _named(error: OSError, path: Path) -> OSError:
    """A write to a full disk names no file, and one beside it another."""
    return OSError(error.errno, error.strerror, str(path))
