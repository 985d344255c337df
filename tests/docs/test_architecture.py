"""docs/architecture.md lists the packages on the levels that tests/test_layers.py enforces."""

from __future__ import annotations

import re
from pathlib import Path

from tests.test_layers import BESIDE, LEVELS, SOURCE

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "architecture.md").read_text(encoding="utf-8")


def test_the_table_of_levels_is_what_is_enforced() -> None:
    there = {path.stem for path in (SOURCE / "chatrobot").iterdir() if not path.name.startswith("__")}
    told: dict[str, str] = {}
    for level, packages in re.findall(r"^\| (\d+|beside) \| (.+) \|$", PAGE, re.MULTILINE):
        names = re.findall(r"`(\w+)`", packages)
        told |= dict.fromkeys(names[:1] if level == "beside" else names, level)
    enforced = {name: str(level) for name, level in LEVELS.items()} | dict.fromkeys(BESIDE, "beside")
    assert told == {name: level for name, level in enforced.items() if name in there}
