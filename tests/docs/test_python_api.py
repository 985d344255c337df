"""docs/python-api.md: its examples print what it shows, and it names every argument, method and error there is."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import chatrobot
from tests.cli.running import environment

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "python-api.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```python\n(.*?)^```\n\n```text\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize(
    ("code", "printed"), EXAMPLES, ids=[printed.split("\n")[0] for _, printed in EXAMPLES]
)
def test_an_example_prints_what_the_page_shows(code: str, printed: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60.0, env=environment(tmp_path)
    )
    assert done.stderr == ""
    assert done.stdout == printed


def test_every_example_is_run() -> None:
    assert len(EXAMPLES) == PAGE.count("```python") >= 4


def test_every_argument_and_method_is_named() -> None:
    arguments = list(inspect.signature(chatrobot.connect).parameters)
    table = PAGE.split("## `Robot`")[0]
    assert re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE) == arguments
    methods = [name for name in vars(chatrobot.Robot) if not name.startswith("_")]
    assert not [name for name in methods if not re.search(rf"`{name}\b", PAGE)]
