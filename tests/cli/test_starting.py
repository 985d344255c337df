"""Starting shows itself, and a stop that is typed meanwhile is a stop."""

from __future__ import annotations

import contextlib
import sys
import time
from pathlib import Path

import psutil
import pytest

from tests.cli.running import Command
from tests.console.terminal import Terminal


def terminal_of(folder: Path, *arguments: str) -> Terminal:
    return Terminal([sys.executable, "-m", "chatrobot", *arguments, "--config-dir", str(folder)])


@pytest.mark.realtime
def test_a_stop_typed_while_the_robot_starts_begins_nothing_and_says_so(tmp_path: Path) -> None:
    with terminal_of(tmp_path, "do", "forward 2 m", "turn left") as terminal:
        terminal.wait_for("starting Wheeltec")
        terminal.enter("stop")
        assert terminal.wait_for_end() == 5
        assert "“forward 2 m” was waiting, and the stop dropped it." in terminal.text
        assert "“turn left” was waiting, and the stop dropped it." in terminal.text
        assert "drove" not in terminal.text


@pytest.mark.realtime
def test_the_console_shows_that_it_starts_and_then_is_there(tmp_path: Path) -> None:
    with terminal_of(tmp_path) as terminal:
        terminal.wait_for("starting Wheeltec")
        terminal.wait_for("Tell it what to do")
        assert "starting" not in terminal.text
        terminal.enter("bye")
        assert terminal.wait_for_end() == 0


@pytest.mark.realtime
def test_what_programs_read_has_no_such_line(chatrobot: Command) -> None:
    done = chatrobot.apart("do", "forward 0.1 m", "--world", "empty", "--json")
    assert done.code == 0
    assert done.named("result")[0]["outcome"] == "completed"
    assert "starting" not in done.out + done.err


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["--model", "nobody:knows"], "nobody:knows"),
        (["--interpreter", "model"], "no language model is set up"),
    ],
)
def test_what_was_started_for_a_command_that_cannot_run_is_ended(
    chatrobot: Command, options: list[str], problem: str
) -> None:
    done = chatrobot.apart("do", "forward 1 m", *options)
    assert done.code == 2
    assert problem in done.err
    until_s = time.monotonic() + 10.0
    while (left := _processes_of(chatrobot.folder)) and time.monotonic() < until_s:
        time.sleep(0.05)
    assert not left


def _processes_of(folder: Path) -> list[list[str]]:
    """Command lines that name the folder; those of a robot and its Motion do."""
    found = []
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error):
            line = process.cmdline()
            if any(str(folder / "chatrobot") in word for word in line):
                found.append(line)
    return found


def test_a_wrong_profile_is_told_once(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 1 m", "--robot", "nobody")
    assert done.code == 2
    assert done.err.count("nobody") == 1, done.err
