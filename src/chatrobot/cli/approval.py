"""A plan or a program that waits for a person's yes, and what they make of it in an editor."""

from __future__ import annotations

import os
import shlex
import subprocess
import tempfile
from pathlib import Path

from chatrobot.cli.console.motion_view import MotionView
from chatrobot.core.errors import UsageError
from chatrobot.core.events import Event, Finished, Interpreted, Notice, ProgramWritten, Result, Started
from chatrobot.dialogue.question import Question
from chatrobot.dialogue.session import Session
from chatrobot.language.consent import read_consent, wants_to_edit

UNREADABLE = "edit_unreadable"
"""The code of the notice that what was edited is asked about as it was before."""


class Approval(Question):
    """A question that may be answered with an edit, too; one at a time. `hear` every event."""

    def __init__(self) -> None:
        super().__init__()
        self.motion_view = MotionView()
        self._muted: set[int] = set()
        self._before = self._typed = self._unreadable = ""
        self._program: ProgramWritten | None = None
        self._edited_turn = 0

    def hear(self, event: Event) -> bool:
        """Take an event in; return whether it is a question."""
        self.motion_view.hear(event)
        if isinstance(event, Notice) and event.reason.code == UNREADABLE:
            self._unreadable = self._typed
        elif isinstance(event, (Started, Finished)) and event.turn == self._edited_turn:
            self._unreadable = ""
        return super().hear(event)

    def take(self, session: Session, text: str) -> str:
        """Take `text` as the answer: anything but a yes is none. Return what is to be edited, "" for nothing.

        That is the plan, the program, or what was made of it before and could not be read.

        Raises:
            LinkError: Motion is gone.
        """
        turn, to_edit = self.turn, ""
        if turn is not None and wants_to_edit(text):
            self._muted.add(turn)
            self._program = self.motion_view.program
            self._before = self.motion_view.plan_text if self._program is None else self._program.source
            to_edit, self._unreadable = self._unreadable or self._before, ""
        self.answer(session, read_consent(text) is True)
        return to_edit

    @property
    def edits_program(self) -> bool:
        """A program is edited, and no plan."""
        return self._program is not None

    def say_edited(self, session: Session, text: str) -> int:
        """Have what was made of it read, rehearsed and asked about; the number of its turn."""
        self._typed = text
        if self._program is not None:
            self._edited_turn = session.say_source(self._program.program, text)
        else:
            self._edited_turn = session.say_edited_plan(text, self._before)
        return self._edited_turn

    def mute_stop(self, event: Event) -> None:
        """Note that what comes of a stop is told otherwise, unless its reply says what it left undone."""
        if isinstance(event, Interpreted) and (event.by, event.reply) == ("reflex", ""):
            self._muted.add(event.turn)

    def is_muted(self, event: Event) -> bool:
        """Tell whether `event` only says what is told otherwise, or that a plan was not done which is being edited.

        What a plan drove before it was edited is told.
        """
        return event.turn in self._muted and not (isinstance(event, Result) and event.has_moved)


def is_answer(text: str) -> bool:
    """Tell whether `text` says yes, no or edit."""
    return read_consent(text) is not None or wants_to_edit(text)


_OTHERWISE = "vi"
"""The editor where the person has named none."""


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
            edited = path.read_text(encoding="utf-8-sig")
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
