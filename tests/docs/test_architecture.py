"""docs/architecture.md lists the levels that tests/test_layers.py enforces; files that documents name are there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.test_layers import BESIDE, LEVELS, SOURCE

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
PAGES = [ROOT / "CONTRIBUTING.md", ROOT / "SECURITY.md", *sorted((ROOT / "docs").glob("*.md"))]
NOT_OURS = {"FILE.py", "acme/wire.py", "acme/wiggle.py", "test_acme.py"}
"""Examples of files that a reader has."""


def test_the_table_of_levels_is_what_is_enforced() -> None:
    there = {path.stem for path in (SOURCE / "chatrobot").iterdir() if not path.name.startswith("__")}
    told: dict[str, str] = {}
    for level, packages in re.findall(r"^\| (\d+|beside) \| (.+) \|$", PAGE, re.MULTILINE):
        names = re.findall(r"`(\w+)`", packages)
        told |= dict.fromkeys(names[:1] if level == "beside" else names, level)
    enforced = {name: str(level) for name, level in LEVELS.items()} | dict.fromkeys(BESIDE, "beside")
    assert told == {name: level for name, level in enforced.items() if name in there}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_file_that_a_page_names_is_there(page: Path) -> None:
    files = {
        f"/{path.relative_to(ROOT)}"
        for name in ("src", "tests", "scripts", "bench", "ros")
        for path in (ROOT / name).rglob("*.py")
    }
    named = set(re.findall(r"`((?:\w+/)*\w+\.py)\b[^`]*`", page.read_text(encoding="utf-8"))) - NOT_OURS
    assert not {name for name in named if not any(file.endswith(f"/{name}") for file in files)}
