"""Plans that were saved: the file that `/save-plan` wrote, or anybody's plan text (docs/plan-language.md)."""

from __future__ import annotations

from pathlib import Path

from chatrobot.core.errors import PlanTextError, UsageError
from chatrobot.plan.text import parse_plan

MOST_BYTES = 65_536
"""A longer file was most likely meant for something else; a plan is over after half an hour at the latest."""


def read_plan_file(name: str) -> str:
    """The text of the plan in that file.

    Raises:
        UsageError: there is no such file, or a line of it cannot be read; which, and what is allowed there.
    """
    path = Path(name).expanduser()
    try:
        with path.open("rb") as file:
            content = file.read(MOST_BYTES + 1)
        text = content.decode("utf-8-sig")
    except OSError as error:
        raise UsageError(error.strerror or "cannot be read", where=str(path)) from error
    except UnicodeDecodeError as error:
        raise UsageError("this is no text", where=str(path), allowed="plan text, one step a line") from error
    if len(content) > MOST_BYTES:
        raise UsageError(
            "this is too long for a plan", where=str(path), allowed=f"at most {MOST_BYTES} bytes"
        )
    try:
        parse_plan(text)
    except PlanTextError as error:
        raise UsageError(str(error), where=str(path)) from error
    return text
