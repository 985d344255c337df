"""docs/lessons.md shows what is so."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from chatrobot.lessons.checks import CHECKS
from chatrobot.lessons.sheet import parse_sheet
from tests.cli.running import Command, chatrobot

__all__ = ["chatrobot"]
ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "lessons.md").read_text(encoding="utf-8")


def shown(begin: str) -> str:
    """What the page says that a command prints."""
    found = re.search(rf"^\$ {re.escape(begin)}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    assert found is not None, begin
    return found[1]


def test_the_list_of_lessons_is_as_shown(chatrobot: Command) -> None:
    assert chatrobot("lesson").out == shown("chatrobot lesson")


def test_lines_are_checked_as_shown(chatrobot: Command) -> None:
    command = re.search(r"^\$ (printf .* \| (chatrobot .*))$", PAGE, re.MULTILINE)
    assert command is not None
    lines = shlex.split(command[1])[1].replace("\\n", "\n")
    done = chatrobot(*shlex.split(command[2])[1:], stdin=lines)
    assert done.out == shown(command[1])
    assert done.code == 1


def test_the_sheet_can_be_used_and_every_check_is_in_the_table() -> None:
    found = re.search(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
    assert found is not None
    assert len(parse_sheet(found[1], "the page", "mine", ROOT).tasks) == 1
    table = PAGE.rpartition("| check | asks for |")[2]
    named = [
        name
        for row in re.findall(r"^\| (`.*?`) \|", table, re.MULTILINE)
        for name in re.findall(r"`(\w+)`", row)
    ]
    assert sorted(named) == sorted(CHECKS)


def test_what_the_console_is_shown_to_say_is_what_the_lesson_says(chatrobot: Command) -> None:
    """The console itself needs a terminal: its verdicts are those of the same lines without one."""
    page = shown("chatrobot lesson first-moves")
    said = re.findall(r"^› (.*)$", page, re.MULTILINE)
    done = chatrobot("lesson", "first-moves", "--check", "-", stdin="\n".join(said))
    verdicts = re.findall(r"^  (?:→|✓) .*$", page, re.MULTILINE)
    assert [line for line in verdicts if "Done" not in line] == re.findall(
        r"^  (?:→|✓) .*$", done.out, re.MULTILINE
    )
