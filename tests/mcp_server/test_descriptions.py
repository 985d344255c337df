"""What an agent's model reads of the tools, and what its client is told of their effects. Nothing is started."""

from __future__ import annotations

import json

import anyio
import pytest
from mcp_types import Tool

from chatrobot.compose import Connection
from chatrobot.core.events import Event, Rehearsed, Started
from chatrobot.core.geometry import Pose
from chatrobot.mcp_server.http import Guard
from chatrobot.mcp_server.robot import AgentRobot
from chatrobot.mcp_server.server import build_server
from chatrobot.mcp_server.streams import MOST_LINE_BYTES, LineSplitter
from chatrobot.plan.text import parse_plan
from chatrobot.robots.load import load_profile

CHARS_A_TOKEN = 3.0
"""Tokenizers of today need more characters for a token of English or JSON: this errs towards too many tokens."""


def nobody(_: object) -> Connection:
    raise AssertionError("no robot is met")


@pytest.fixture
def tools() -> dict[str, Tool]:
    server = build_server(AgentRobot(nobody), load_profile("wheeltec_mini_mec"), is_simulated=True)
    return {tool.name: tool for tool in anyio.run(server.list_tools)}


def test_all_descriptions_together_are_at_most_a_thousand_tokens(tools: dict[str, Tool]) -> None:
    told = json.dumps([tool.model_dump(by_alias=True, exclude_none=True) for tool in tools.values()])
    assert len(told) / CHARS_A_TOKEN <= 1000.0


def test_there_are_the_six_tools_that_others_rely_on(tools: dict[str, Tool]) -> None:
    assert set(tools) == {"instruct", "rehearse", "observe", "stop", "places", "programs"}
    for name in ("instruct", "rehearse"):
        assert "required" not in tools[name].input_schema, "text or plan"
    for name in ("observe", "stop", "places", "programs"):
        assert not tools[name].input_schema.get("required"), f"{name}() takes no argument"


def test_what_only_looks_says_so_and_what_moves_says_so(tools: dict[str, Tool]) -> None:
    hints = {name: tool.annotations for name, tool in tools.items()}
    assert all(each is not None for each in hints.values())
    reading = {name for name, each in hints.items() if each is not None and each.read_only_hint}
    destructive = {name for name, each in hints.items() if each is not None and each.destructive_hint}
    assert reading == {"rehearse", "observe", "places"}
    assert destructive == {"instruct", "programs"}
    assert hints["stop"] is not None
    assert hints["stop"].idempotent_hint


def test_the_prompt_teaches_a_plan_that_can_be_read() -> None:
    server = build_server(AgentRobot(nobody), load_profile("wheeltec_mini_mec"), is_simulated=True)
    prompt = anyio.run(server.get_prompt, "plan_language", {"task": "patrol"})
    (message,) = prompt.messages  # type: ignore[union-attr]
    text = message.content.text  # type: ignore[union-attr]
    example = text.split("half a metre:\n")[1].split("\nend")[0] + "\nend"
    assert len(parse_plan(example).steps) == 1
    assert "patrol" in text


def test_a_car_is_not_told_that_it_can_turn_on_the_spot() -> None:
    server = build_server(AgentRobot(nobody), load_profile("wheeltec_mini_akm"), is_simulated=True)
    prompt = anyio.run(server.get_prompt, "plan_language", {})
    text = prompt.messages[0].content.text  # type: ignore[union-attr]
    assert "\nturn " not in text
    assert "cannot turn on the spot" in text


def test_a_line_without_an_end_takes_no_memory_and_the_next_one_is_read() -> None:
    splitter = LineSplitter()
    for _ in range(MOST_LINE_BYTES // 100_000 + 5):
        assert splitter.take(b"x" * 100_000) == []
        assert len(splitter._held) <= MOST_LINE_BYTES
    assert splitter.take(b'x\n{"a": 1}\n{"b"') == ['{"a": 1}']
    assert splitter.take(b": 2}\n") == ['{"b": 2}']


@pytest.mark.parametrize(
    ("names", "host", "is_let_in"),
    [
        (("localhost",), "localhost:8765", True),
        (("localhost",), "LOCALHOST", True),
        (("localhost",), "127.0.0.2:8765", False),
        (("localhost",), "", False),
        (("::1",), "[::1]:8765", True),
        (("robot.local",), "192.168.1.7:8765", True),
        (("robot.local",), "robot.local:8765", True),
        (("robot.local",), "rebound.example:8765", False),
        (("robot.local",), "robot.local:80", False),
    ],
)
def test_a_host_is_ours_or_is_not(names: tuple[str, ...], host: str, is_let_in: bool) -> None:
    async def app(*_: object) -> None:
        """Serve nothing."""

    assert Guard(app, "t" * 16, names, 8765)._is_ours(host) is is_let_in


def test_events_are_passed_over_while_nobody_listens() -> None:
    AgentRobot(nobody)._hear(Event(0))


def test_a_yes_that_comes_before_its_question_is_noted_leaves_nothing_waiting() -> None:
    robot = AgentRobot(nobody)
    asked = Rehearsed(7, True, 3.6, 1.0, Pose(1.0, 0.0, 0.0), needs_approval=True)
    robot._hear(asked)
    robot._hear(Started(7))
    robot.wait_for_yes(7)
    assert robot.waiting_turn is None
    robot._hear(asked)  # it was paused, and is gone on with
    robot.wait_for_yes(7)
    assert robot.waiting_turn == 7
