"""Lines in, events out: no part of a line is an order, a yes is one to what was shown, `turn` names the line."""

from __future__ import annotations

from typing import Any

import pytest

from chatrobot.cli.lines import MAX_LINE_BYTES, LineSplitter
from chatrobot.link.envelope import MOST_CHARACTERS
from tests.cli.running import Command, Done

JSON = ("--json", "--world", "empty")
FAST = (*JSON, "--fast")
ASKED = (*FAST, "--approve")
BLANKS = " " * MAX_LINE_BYTES
ORDERED_AT_ITS_END = ("please do not move " * 10_000)[: 2 * MAX_LINE_BYTES] + "forward 1 m"
TOO_LONG = [
    ORDERED_AT_ITS_END,
    f"forward 1 m{BLANKS} no, do not",
    f"{BLANKS}forward 1 m",
    f"{BLANKS[11:]}forward 1 m, no",
    f'{{"text": "forward 1 m"}}{BLANKS}no',
]


def outcomes(done: Done) -> dict[int, str]:
    return {event["turn"]: event["outcome"] for event in done.named("result")}


# --- lines that are too long ---


@pytest.mark.parametrize("line", TOO_LONG, ids=range(len(TOO_LONG)))
def test_of_a_line_that_is_too_long_nothing_is_done(chatrobot: Command, line: str) -> None:
    for ending in ("", "\n", "\nwhere are you?\n"):
        done = chatrobot(*FAST, stdin=f"{line}{ending}")
        assert not done.named("started")
        told = 1 if line[0] != "{" else 0
        assert len(done.named("result")) == told + ending.count("?")
        assert len(done.named("notice")) == 1 - told


@pytest.mark.parametrize("text", ["forward 1\ufffd m", "turn left \udcbd turn", "vorwärts 1\ufffd m"])
def test_of_a_text_with_bytes_that_are_no_text_nothing_is_done(chatrobot: Command, text: str) -> None:
    (result,) = chatrobot("do", text, *FAST).named("result")
    assert result["outcome"] == "unclear"
    assert result["path_m"] == result["turned_rad"] == 0.0
    assert "UTF-8" in result["reply"]


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


# --- lines that are JSON ---


@pytest.mark.parametrize("line", ["[" * 5000, "5 m vor", "true north", '"forward" 1 m'])
def test_a_line_that_is_no_json_is_a_text(chatrobot: Command, line: str) -> None:
    done = chatrobot(*FAST, stdin=f"{line}\n")
    assert [event["turn"] for event in done.named("result")] == [1]
    assert not done.named("notice")


def test_what_is_json_by_itself_is_said_as_the_text_of_an_object(chatrobot: Command) -> None:
    (result,) = chatrobot(*FAST, stdin='{"text": "5"}\n').named("result")
    assert (result["turn"], result["outcome"]) == (1, "unclear")


@pytest.mark.parametrize("line", ['"stop"', '["stop"]', '"emergency stop"', '"停"'])
def test_a_stop_stops_though_it_is_json_of_no_known_form(chatrobot: Command, line: str) -> None:
    done = chatrobot(*FAST, stdin=f"forward 1 m\n{line}\n")
    assert {event["outcome"] for event in done.named("result")} == {"stopped"}
    assert not done.named("notice")


# --- a yes in a pipe ---


@pytest.mark.parametrize("flags", [ASKED, pytest.param((*JSON, "--approve"), marks=pytest.mark.realtime)])
def test_where_the_input_has_ended_nobody_is_waited_for(chatrobot: Command, flags: tuple[str, ...]) -> None:
    done = chatrobot.apart(*flags, stdin="forward 1 m\nturn left\n")
    assert outcomes(done) == {1: "refused", 2: "refused"}
    assert [event["reason"]["code"] for event in done.named("notice")] == ["nobody_approves"] * 2
    assert {event["reason"]["code"] for event in done.named("result")} == {"not_approved"}
    assert done.code == 4


def test_in_simulated_time_the_next_line_answers_the_plan_that_waits(chatrobot: Command) -> None:
    done = chatrobot.apart(*ASKED, stdin="forward 1 m\nyes\nforward 1 m\nno\n")
    assert outcomes(done) == {1: "completed", 2: "answered", 3: "refused", 4: "answered"}
    assert not done.named("notice")


@pytest.mark.realtime
def test_in_real_time_a_yes_that_came_before_its_plan_was_shown_is_told_so_and_moves_nothing(
    chatrobot: Command,
) -> None:
    done = chatrobot.apart(*JSON, "--approve", stdin="forward 1 m\nyes\nforward 1 m\nno\n")
    assert outcomes(done) == {1: "refused", 2: "answered", 3: "refused", 4: "answered"}
    assert (
        "came before the plan was shown" in next(e for e in done.named("result") if e["turn"] == 2)["reply"]
    )
    assert not done.named("started")


def test_an_approve_that_came_before_its_question_approves_nothing(chatrobot: Command) -> None:
    done = chatrobot.apart(*ASKED, stdin='{"approve": true}\nforward 1 m\n{"approve": true}\n')
    assert outcomes(done) == {1: "refused"}
    codes = [event["reason"]["code"] for event in done.named("notice")]
    assert codes == ["nothing_asked", "nothing_asked", "nobody_approves"]


def test_a_yes_to_what_was_shown_is_not_held_up_by_what_waits_behind_it(chatrobot: Command) -> None:
    with chatrobot.start(*ASKED) as robot:
        robot.say("forward 1 m\nturn left")
        assert robot.event("rehearsed")["turn"] == 1
        robot.say("yes")
        assert robot.event("result", lambda event: event["turn"] == 1)["outcome"] == "completed"
        assert robot.event("rehearsed")["turn"] == 2
        assert robot.end() == 0
        assert {event["turn"]: event.get("outcome") for event in robot.seen}[2] == "refused"


# --- which result belongs to which line ---


def test_results_may_come_out_of_order_and_turn_counts_the_texts(chatrobot: Command) -> None:
    said = 'forward 1 m\n\n{"approve": true}\n{"text": "blorf"}\n{\ndo as follows:\n1. turn left\nquit\n'
    done = chatrobot(*FAST, stdin=said)
    results: list[dict[str, Any]] = done.named("result")
    assert [(event["turn"], event["outcome"]) for event in results] == [
        (2, "unclear"), (1, "completed"), (3, "completed"),
    ]  # fmt: skip
    assert {event["turn"] for event in done.named("notice")} == {0}
