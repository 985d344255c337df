"""What the tutorial shows is what the program prints."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TUTORIAL = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
PROGRESS = re.compile(r"^ +-?\d+\.\d+ / ")


def commands() -> list[tuple[str, str]]:
    """Each checked command with what the tutorial says it prints."""
    found = []
    for block in re.findall(r"^```console\n(.*?)^```", TUTORIAL, re.DOTALL | re.MULTILINE):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = part.partition("\n")
            if command.startswith("chatrobot ") and "--fast" in command:
                found.append((command, output))
    return found


@pytest.mark.parametrize(("command", "expected"), commands(), ids=[command for command, _ in commands()])
def test_a_command_of_the_tutorial_prints_what_stands_there(command, expected, tmp_path):
    arguments = [*shlex.split(command)[1:], "--config-dir", str(tmp_path)]
    run = subprocess.run(
        [sys.executable, "-m", "chatrobot", *arguments],
        capture_output=True,
        text=True,
        encoding="utf-8",
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "PYTHONUTF8": "1"},
        timeout=60.0,
    )
    assert run.stderr == ""
    # Progress is shown for those who wait; a tutorial leaves it out.
    printed = [line for line in run.stdout.splitlines() if not PROGRESS.match(line)]
    assert words(printed) == words(expected.splitlines())
    assert numbers(printed) == pytest.approx(numbers(expected.splitlines()), rel=0.01, abs=0.2)


def words(lines: list[str]) -> list[str]:
    return [NUMBER.sub("#", line) for line in lines]


def numbers(lines: list[str]) -> list[float]:
    return [float(number) for number in NUMBER.findall("\n".join(lines))]


def test_the_tutorial_has_commands_to_check():
    assert len(commands()) >= 8


@pytest.mark.parametrize("link", sorted(set(re.findall(r"\]\(([^)#]+)\)", TUTORIAL))))
def test_what_the_tutorial_links_to_is_there(link):
    assert (ROOT / "docs" / link).is_file()
