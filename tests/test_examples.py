"""Every example runs, is short, and says what it is meant to say."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.running import environment

EXAMPLES = Path(__file__).parent.parent / "examples"
SAID = {
    "first_drive": "completed Pose(x_m=1.0",
    "dialogue": "'fly to the moon': refused",
    "raw_plan": "completed: 4.0",
    "listen": "stopped after 0.",
    "json_lines": "2 completed",
}


def test_every_example_is_tested() -> None:
    assert {file.stem for file in EXAMPLES.glob("*.py")} == set(SAID)


@pytest.mark.parametrize("name", list(SAID))
def test_example(name: str, tmp_path: Path) -> None:
    file = EXAMPLES / f"{name}.py"
    assert len(file.read_text(encoding="utf-8").splitlines()) <= 30
    done = subprocess.run(
        [sys.executable, str(file), "--fast"],
        capture_output=True,
        text=True,
        env=environment(tmp_path),
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert SAID[name] in done.stdout
