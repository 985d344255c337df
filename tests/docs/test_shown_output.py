"""What README and tutorial show is what the program prints."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.running import Command

ROOT = Path(__file__).resolve().parents[2]
NAMES = ("tutorial", "worlds", "recordings", "tutorial.de", "tutorial.zh")
PAGES = (ROOT / "README.md", *(ROOT / "docs" / f"{name}.md" for name in NAMES))

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
PROGRESS = re.compile(r"^ +-?\d+\.\d+ / ")


def commands(page: Path) -> list[tuple[str, str]]:
    """Each checked command of a page with what the page says it prints."""
    found = []
    text = page.read_text(encoding="utf-8")
    for block in re.findall(r"^```console\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = part.partition("\n")
            if command.startswith("chatrobot ") and "--fast" in command:
                found.append((command, output))
    return found


SHOWN = [shown for page in PAGES for shown in commands(page)]
LINKS = sorted(
    (page, link)
    for page in (*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"))
    for link in set(re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")))
    if "://" not in link
)
NAMED = re.compile(r'<a name="([^"]+)">')
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)


@pytest.mark.parametrize(("command", "expected"), SHOWN, ids=[command for command, _ in SHOWN])
def test_a_command_prints_what_the_page_shows(
    command: str, expected: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # some write a file
    run = Command(tmp_path)(*shlex.split(command)[1:], "--config-dir", str(tmp_path))
    assert run.err == ""
    # Progress is shown for those who wait; a tutorial leaves it out.
    printed = [line for line in run.out.splitlines() if not PROGRESS.match(line)]
    assert words(printed) == words(expected.splitlines())
    assert numbers(printed) == pytest.approx(numbers(expected.splitlines()), rel=0.01, abs=0.2)


def words(lines: list[str]) -> list[str]:
    return [NUMBER.sub("#", line) for line in lines]


def numbers(lines: list[str]) -> list[float]:
    return [float(number) for number in NUMBER.findall("\n".join(lines))]


def test_the_pages_have_commands_to_check() -> None:
    assert [len(commands(page)) >= least for page, least in zip(PAGES, (3, 8, 1, 1, 6, 6), strict=True)] == [
        True
    ] * 6


@pytest.mark.parametrize(("page", "link"), LINKS, ids=[f"{page.name}:{link}" for page, link in LINKS])
def test_what_a_page_links_to_is_there(page: Path, link: str) -> None:
    path, _, anchor = link.partition("#")
    target = page.parent / path if path else page
    assert target.exists()
    text = target.read_text(encoding="utf-8") if anchor else ""
    assert not anchor or anchor in {*map(slug, HEADING.findall(text)), *NAMED.findall(text)}


def slug(heading: str) -> str:
    """What code hosts make of a heading."""
    return re.sub(r"[^\w\- ]", "", heading.casefold()).replace(" ", "-")


def test_the_python_of_the_readme_runs() -> None:
    (code,) = re.findall(
        r"^```python\n(.*?)^```", PAGES[0].read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    )
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60.0, check=True
    )
    assert run.stdout == "Done: drove 1.00 m of 1.00 m.\n"
