"""A text in the person's own editor."""

from __future__ import annotations

import os
import shlex
import subprocess
import tempfile
from pathlib import Path

from chatrobot.core.errors import UsageError

_OTHERWISE = "vi"


def edited_text(text: str, suffix: str) -> str:
    """`text` as the person leaves it; unchanged where the editor fails.

    Raises:
        UsageError: there is no such editor.
    """
    command = shlex.split(os.environ.get("VISUAL") or os.environ.get("EDITOR") or _OTHERWISE)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"program{suffix}"
        path.write_text(text, encoding="utf-8")
        try:
            done = subprocess.run([*command, str(path)], check=False)
        except OSError as error:
            raise UsageError(
                f"{command[0]!r} cannot be started", where="EDITOR", allowed="an editor's command, or --file"
            ) from error
        return path.read_text(encoding="utf-8") if done.returncode == 0 else text
