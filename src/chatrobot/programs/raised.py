"""Why a program broke off, as a reason."""

from __future__ import annotations

from collections.abc import Mapping

from chatrobot.core.reason import Reason
from chatrobot.programs.events import Raised

LONGEST_ERROR = 300


def raised_reason(end: Raised) -> Reason:
    """`error` is the exception and what it says, `line` the program's own, 0 where it has none to show."""
    error = f"{end.type_name}: {end.message}" if end.message else end.type_name
    values: Mapping[str, str | int] = {"error": error[:LONGEST_ERROR], "line": end.line}
    if end.type_name in ("ModuleNotFoundError", "ImportError"):
        return Reason("program_import", values)
    if end.type_name in ("SyntaxError", "IndentationError", "TabError"):
        return Reason("program_syntax", {"problem": end.message[:LONGEST_ERROR], "line": end.line})
    if end.type_name == "PermissionError":
        return Reason("program_forbidden", values)
    return Reason("program_raised", values)
