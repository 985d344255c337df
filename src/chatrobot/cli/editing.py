"""A plan or a program in the person's own editor."""

from __future__ import annotations

import os
import shlex
import subprocess
import tempfile
from pathlib import Path

from chatrobot.core.errors import UsageError

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
