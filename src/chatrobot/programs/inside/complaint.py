"""An exception as its author should see it: the program's own lines, and not how we run them."""

from __future__ import annotations

import linecache
import sys
import traceback

LONGEST_TEXT = 8 * 1024


def preload() -> None:
    """Have all imported that a traceback needs when it is shown: in the sandbox it is too late."""
    try:
        sum([1, "2"])  # type: ignore[list-item]
    except TypeError:
        traceback.format_exc()


def complaint(error: BaseException) -> tuple[str, str, str, int]:
    """(type, message, traceback, the program's line or 0). Opens no file for the lines of others."""
    told = traceback.TracebackException.from_exception(error, lookup_lines=False)
    line = _line(told)
    _keep_own_frames(told)
    kind = type(error)
    name = (
        kind.__qualname__
        if kind.__module__ in ("builtins", "__main__")
        else f"{kind.__module__}.{kind.__qualname__}"
    )
    return name[:200], _text(error)[:LONGEST_TEXT], "".join(told.format())[-LONGEST_TEXT:], line


def _text(error: BaseException) -> str:
    try:
        return str(error)
    except Exception:  # noqa: BLE001 - its class is the program's, and may do anything
        return ""


def _is_own(file_name: str) -> bool:
    """The program's source is where `linecache` was given it."""
    return file_name in linecache.cache and file_name == getattr(sys.modules["__main__"], "__file__", None)


def _line(told: traceback.TracebackException) -> int:
    lines = [frame.lineno or 0 for frame in told.stack if _is_own(frame.filename)]
    if lines:
        return lines[-1]
    return int(getattr(told, "lineno", None) or 0)


def _keep_own_frames(told: traceback.TracebackException | None) -> None:
    depth = 0
    while told is not None and depth < 10:
        told.stack[:] = [frame for frame in told.stack if _is_own(frame.filename)]
        told = told.__cause__ or told.__context__
        depth += 1
