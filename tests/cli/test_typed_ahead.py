"""What is typed before the console is there counts as typed, not as pasted."""

from __future__ import annotations

import os
import pty
import time
from collections.abc import Iterator

import pytest

from chatrobot.cli import lines
from chatrobot.cli.lines import AT_ONCE_S, TypedAhead
from tests.cli.running import Command


@pytest.fixture
def keys(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    ours, theirs = pty.openpty()
    monkeypatch.setattr(lines, "STDIN", theirs)
    yield ours
    os.close(ours)
    os.close(theirs)


def test_each_line_that_is_typed_stands_alone_and_what_comes_at_once_stays_together(keys: int) -> None:
    typed = TypedAhead()
    typed.start()
    for text in (b"forward 1 m\n", b"/limit 5 m\n", b"turn left\nback 1 m\n", b"unfinished"):
        os.write(keys, text)
        time.sleep(4 * AT_ONCE_S)
    assert typed.stop() == ["forward 1 m", "/limit 5 m", "turn left\nback 1 m"]
    assert not typed.has_ended


def test_the_end_of_the_input_is_noted(keys: int) -> None:
    typed = TypedAhead()
    typed.start()
    os.write(keys, b"forward 1 m\n")
    time.sleep(2 * AT_ONCE_S)
    os.write(keys, b"\x04")
    time.sleep(2 * AT_ONCE_S)
    assert typed.stop() == ["forward 1 m"]
    assert typed.has_ended


def test_one_that_was_never_started_has_nothing() -> None:
    assert TypedAhead().stop() == []


def test_in_a_pipe_a_pause_keeps_the_line_before_it(chatrobot: Command) -> None:
    done = chatrobot("--fast", "--world", "empty", "--json", stdin="forward 1 m\npause\ncontinue\n")
    assert {result["turn"]: result["outcome"] for result in done.named("result")}[1] == "completed"
    cut_off = chatrobot("--fast", "--world", "empty", stdin="forward 1 m\npause\n")
    assert "Paused. Still to do: “forward 1 m”" in cut_off.out
    assert cut_off.code == 5
