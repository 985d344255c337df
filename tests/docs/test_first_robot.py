"""docs/first-robot.md: its profile can be made as it says, and its simulated twin does what it shows."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.docs.test_shown_output import PROGRESS, ROOT, commands, numbers, words

PAGE = ROOT / "docs" / "first-robot.md"


def test_the_page_is_what_happens(tmp_path: Path) -> None:
    text = PAGE.read_text(encoding="utf-8")
    ((source, target),) = re.findall(r"^    cp (.+) ~/\.config/chatrobot/(\S+)$", text, re.MULTILINE)
    (tmp_path / target).parent.mkdir(parents=True)
    found = source.replace("chatrobot robots", f"{shlex.quote(sys.executable)} -m chatrobot robots")
    subprocess.run(
        ["sh", "-c", f"cp {found} {shlex.quote(str(tmp_path / target))}"], check=True, timeout=60.0
    )
    ((command, expected),) = commands(PAGE)
    run = subprocess.run(
        [sys.executable, "-m", "chatrobot", *shlex.split(command)[1:], "--config-dir", str(tmp_path)],
        capture_output=True,
        text=True,
        encoding="utf-8",
        env={**os.environ, "PYTHONUTF8": "1"},
        timeout=60.0,
    )
    assert run.stderr == ""
    printed = [line for line in run.stdout.splitlines() if not PROGRESS.match(line)]
    assert words(printed) == words(expected.splitlines())
    assert numbers(printed) == pytest.approx(numbers(expected.splitlines()), rel=0.01, abs=0.2)
