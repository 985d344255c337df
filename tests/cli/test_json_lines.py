"""Lines in, events out: no part of a line is an order."""

from __future__ import annotations

import pytest

from chatrobot.cli.lines import MAX_LINE_BYTES, LineSplitter
from chatrobot.dialogue.utterances import MOST_CHARACTERS
from tests.cli.running import Command

JSON = ("--json", "--world", "empty")
FAST = (*JSON, "--fast")
BLANKS = " " * MAX_LINE_BYTES
ORDERED_AT_ITS_END = ("please do not move " * 10_000)[: 2 * MAX_LINE_BYTES] + "forward 1 m"
TOO_LONG = [
    ORDERED_AT_ITS_END,
    f"forward 1 m{BLANKS} no, do not",
    f"{BLANKS}forward 1 m",
    f"{BLANKS[11:]}forward 1 m, no",
    f'{{"text": "forward 1 m"}}{BLANKS}no',
]


# --- lines that are too long ---


@pytest.mark.parametrize("line", TOO_LONG, ids=range(len(TOO_LONG)))
def test_of_a_line_that_is_too_long_nothing_is_done(chatrobot: Command, line: str) -> None:
    for ending in ("", "\n", "\nwhere are you?\n"):
        done = chatrobot(*FAST, stdin=f"{line}{ending}")
        assert not done.named("started")
        told = 1 if line[0] != "{" else 0
        assert len(done.named("result")) == told + ending.count("?")
        assert len(done.named("notice")) == 1 - told


def test_a_line_that_is_too_long_is_one_turn_that_says_so(chatrobot: Command) -> None:
    (result,) = chatrobot(*FAST, stdin=f"{ORDERED_AT_ITS_END}\n").named("result")
    assert (result["turn"], result["outcome"]) == (1, "unclear")
    assert result["reply"] == "This line is too long, so nothing of it is done: 65536 bytes at most."
    assert "too long" in chatrobot("--fast", "--world", "empty", stdin=f"{ORDERED_AT_ITS_END}\n").out


@pytest.mark.parametrize("read_bytes", [1000, MAX_LINE_BYTES, 10 * MAX_LINE_BYTES])
def test_what_is_cut_is_too_long_for_everybody_and_the_next_line_is_whole(read_bytes: int) -> None:
    data = f"one\n{ORDERED_AT_ITS_END}{BLANKS}\n\nlast".encode()
    splitter = LineSplitter()
    lines = [
        line
        for begin in range(0, len(data), read_bytes)
        for line in splitter.take(data[begin : begin + read_bytes])
    ]
    assert [lines[0], *lines[2:], splitter.end()] == ["one", "", "last"]
    assert MOST_CHARACTERS < len(lines[1].strip()) <= MAX_LINE_BYTES + 1


def test_the_longest_line_is_whole() -> None:
    longest = "x" * MAX_LINE_BYTES
    assert LineSplitter().take(f"{longest}\n".encode()) == [longest]
    assert len(longest) <= MOST_CHARACTERS
