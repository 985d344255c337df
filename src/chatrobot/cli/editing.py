"""A plan or a program in the person's own editor, and what becomes of what they made of it."""

from __future__ import annotations

import os
import shlex
import subprocess
import tempfile
from pathlib import Path

from chatrobot.core.errors import UsageError
from chatrobot.core.events import Event, Finished, Notice, ProgramWritten, Started
from chatrobot.dialogue.session import Session

_OTHERWISE = "vi"


def edited_text(text: str, suffix: str) -> str:
    """Return `text` as the person leaves it.

    Raises:
        UsageError: there is no such editor, it failed, or what it left is no text.
    """
    command = _command()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"program{suffix}"
        path.write_text(text, encoding="utf-8")
        try:
            code = subprocess.run([*command, str(path)], check=False).returncode
            edited = path.read_text(encoding="utf-8")
        except FileNotFoundError as error:
            raise _unusable("cannot be started: there is no such command", command) from error
        except OSError as error:
            raise _unusable(f"cannot be used: {error.strerror}", command) from error
        except UnicodeDecodeError as error:
            raise _unusable("left a file that is not UTF-8 text", command) from error
    if code != 0:
        raise _unusable(f"ended with exit code {code}, so nothing was changed", command)
    return edited


def _command() -> list[str]:
    named = os.environ.get("VISUAL") or os.environ.get("EDITOR") or _OTHERWISE
    try:
        return shlex.split(named) or [_OTHERWISE]
    except ValueError as error:
        raise _unusable(f"cannot be read: {error}", [named]) from error


def _unusable(problem: str, command: list[str]) -> UsageError:
    return UsageError(
        f"the editor {command[0]!r} {problem}", allowed="VISUAL, or else EDITOR, names the one to use"
    )


UNREADABLE = "edit_unreadable"
"""The code of the notice that what was edited is asked about as it was before."""


class Edited:
    """One edit at a time: `begin` it, then `say` what came of it; `hear` every event."""

    def __init__(self) -> None:
        self._before = self._typed = self._unreadable = ""
        self._program: ProgramWritten | None = None
        self._turn = 0

    def begin(self, plan_text: str, program: ProgramWritten | None) -> str:
        """Return the text to be edited: the plan, the program, or what was made of it before and could not be read."""
        self._program = program
        self._before = program.source if program is not None else plan_text
        text, self._unreadable = self._unreadable or self._before, ""
        return text

    @property
    def is_program(self) -> bool:
        """A program is edited, and no plan."""
        return self._program is not None

    def say(self, session: Session, text: str) -> int:
        """Have it read, rehearsed and asked about; the number of its turn."""
        self._typed = text
        if self._program is not None:
            self._turn = session.say_source(self._program.program, text)
        else:
            self._turn = session.say_edited_plan(text, self._before)
        return self._turn

    def hear(self, event: Event) -> None:
        """Take an event in."""
        if isinstance(event, Notice) and event.reason.code == UNREADABLE:
            self._unreadable = self._typed
        elif isinstance(event, (Started, Finished)) and event.turn == self._turn:
            self._unreadable = ""
