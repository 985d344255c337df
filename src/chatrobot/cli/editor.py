"""A person's own editor for a plan: $VISUAL, $EDITOR, or what there is."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

_USUAL = ("sensible-editor", "nano", "vi")


def edited(plan_text: str) -> str | None:
    """`plan_text` as the person leaves it; None where it was emptied, or nothing can be edited here."""
    command = os.environ.get("VISUAL") or os.environ.get("EDITOR") or next(filter(shutil.which, _USUAL), "")
    if not command:
        print("chatrobot: no editor here; set EDITOR", file=sys.stderr)
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "plan.txt"
        file.write_text(plan_text + "\n", encoding="utf-8")
        try:
            subprocess.run([*shlex.split(command), str(file)], check=True)
        except (OSError, ValueError, subprocess.CalledProcessError) as error:
            print(f"chatrobot: {command}: {error}", file=sys.stderr)
            return None
        return file.read_text(encoding="utf-8", errors="replace").strip() or None
