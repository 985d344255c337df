"""What docs/programs.md shows is what the program prints, command after command with the same settings folder."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.docs.test_shown_output import PROGRESS, ROOT, commands, numbers, words

PAGE = ROOT / "docs" / "programs.md"


def test_the_page_is_what_happens(tmp_path: Path) -> None:
    shown = commands(PAGE)
    assert len(shown) >= 4
    for command, expected in shown:
        run = subprocess.run(
            [
                sys.executable,
                "-m",
                "chatrobot",
                *shlex.split(command)[1:],
                "--config-dir",
                str(tmp_path / "config"),
            ],
            capture_output=True,
            text=True,
            encoding="utf-8",
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "PYTHONUTF8": "1"},
            timeout=60.0,
        )
        assert run.stderr == ""
        shown_output = run.stdout.replace(str(tmp_path / "config"), "~/.config/chatrobot")
        printed = [line for line in shown_output.splitlines() if line.strip() and not PROGRESS.match(line)]
        wanted = [line for line in expected.splitlines() if line.strip()]
        assert words(printed) == words(wanted), command
        assert numbers(printed) == pytest.approx(numbers(wanted), rel=0.01, abs=0.2)
    assert (tmp_path / "dance" / "build_run.sh").exists()
