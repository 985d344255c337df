"""Every message that docs/troubleshooting.md explains is one that the program says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from chatrobot.language.data_files import load_table

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
ENTRIES = re.findall(r"^\*\*“(.+)”\*\*(?: \(`(\w+)`\))?\n(.+)", PAGE, re.MULTILINE)
PHRASES = {**load_table("en", "phrases"), **load_table("en", "outcomes"), **load_table("en", "console")}
SOURCE = "\n".join(file.read_text(encoding="utf-8") for file in (ROOT / "src" / "chatrobot").rglob("*.py"))
VALUE = re.compile(r"\{[^{}]*\}")


def test_the_page_has_the_messages_that_people_meet_most() -> None:
    assert len(ENTRIES) == PAGE.count("**“") >= 25


@pytest.mark.parametrize(
    ("message", "code"), [entry[:2] for entry in ENTRIES], ids=[entry[1] for entry in ENTRIES]
)
def test_a_message_is_what_the_program_says(message: str, code: str) -> None:
    if not code:
        assert message in SOURCE
        return
    phrase = VALUE.sub("…", str(PHRASES[code]))
    if message.endswith("…") and not phrase.endswith("…"):
        assert phrase.startswith(message[:-1])
    else:
        assert phrase == message
