"""At a terminal: one line of progress, a question before the plan, Ctrl-C and Ctrl-Z from the keyboard."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pexpect
import pytest

from tests.cli.running import PATIENCE_S, environment

EMPTY = ["--world", "empty"]


class Terminal:
    """Runs `chatrobot` at a terminal of its own."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._children: list[pexpect.spawn[str]] = []

    def __call__(self, *arguments: str) -> pexpect.spawn[str]:
        child = pexpect.spawn(
            sys.executable,
            ["-m", "chatrobot", *arguments],
            env=environment(self._folder),
            encoding="utf-8",
            timeout=PATIENCE_S,
        )
        self._children.append(child)
        return child

    def close(self) -> None:
        for child in self._children:
            child.close(force=True)


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Terminal]:
    made = Terminal(tmp_path)
    yield made
    made.close()


def code(child: pexpect.spawn[str]) -> int | None:
    child.expect(pexpect.EOF)
    child.wait()
    return child.exitstatus


def test_progress_is_one_line_that_is_written_over(terminal: Terminal) -> None:
    child = terminal("do", "forward 2 m", "--fast", *EMPTY)
    child.expect(pexpect.EOF)
    assert child.before is not None
    assert child.before.count("\r\x1b[K") > 10
    assert child.before.count("\n") == 4


@pytest.mark.parametrize(("answer", "outcome"), [("是", 0), ("", 4), ("what?", 4)])
def test_approval_is_asked_for_and_only_a_yes_is_one(terminal: Terminal, answer: str, outcome: int) -> None:
    child = terminal("do", "forward 1 m", "--approve", "--fast", *EMPTY)
    child.expect_exact("[y/N]")
    child.sendline(answer)
    assert code(child) == outcome


@pytest.mark.realtime
def test_without_a_command_a_terminal_gets_the_console(terminal: Terminal) -> None:
    child = terminal(*EMPTY)
    child.expect_exact("› ")
    child.sendeof()
    assert code(child) == 0


@pytest.mark.realtime
def test_ctrl_c_stops_and_reports(terminal: Terminal) -> None:
    child = terminal("do", "forward 10 m", *EMPTY)
    child.expect("0.[1-9]. / 10.00 m")
    child.sendintr()
    child.expect("Stopped")
    assert code(child) == 5


@pytest.mark.realtime
def test_ctrl_c_answers_the_question_with_no(terminal: Terminal) -> None:
    child = terminal("do", "forward 10 m", "--approve", *EMPTY)
    child.expect_exact("[y/N]")
    child.sendintr()
    assert code(child) == 5


def test_a_plan_can_be_edited_and_is_asked_about_again(
    terminal: Terminal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("VISUAL", "sed -i s/1/0.25/")
    child = terminal("do", "forward 1 m", "--approve", "--fast", *EMPTY)
    child.expect_exact("[y/N]")
    child.sendline("e")
    child.expect_exact("drive 0.25 m")
    child.expect_exact("[y/N]")
    child.sendline("y")
    child.expect_exact("drove 0.25 m of 0.25 m")
    assert code(child) == 0
