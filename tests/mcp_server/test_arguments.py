"""What is called with wrong arguments does nothing, and says what it takes. No robot is met."""

from __future__ import annotations

from typing import Any

import anyio
import pytest
from mcp import Client
from mcp_types import CallToolResult, Tool

from chatrobot.mcp_server.robot import AgentRobot
from chatrobot.mcp_server.server import build_server
from chatrobot.robots.load import load_profile
from tests.mcp_server.mcp_rig import text_of
from tests.mcp_server.test_descriptions import nobody

HAS = {
    "instruct": "it has `text`, `plan`",
    "rehearse": "it has `text`, `plan`",
    "observe": "it has `picture`",
    "places": "it takes none",
    "programs": "it has `action`, `name`, `text`",
}


def call(tool: str, arguments: dict[str, Any]) -> CallToolResult:
    """Call a tool of a server that has no robot."""

    async def task() -> CallToolResult:
        with anyio.fail_after(10.0):
            async with Client(server()) as client:
                result = await client.call_tool(tool, arguments)
        assert isinstance(result, CallToolResult)
        return result

    return anyio.run(task)


def server() -> Any:
    """A server without a robot."""
    return build_server(AgentRobot(nobody), load_profile("wheeltec_mini_mec"), is_simulated=True)


@pytest.mark.parametrize("tool", HAS)
@pytest.mark.parametrize("name", ["rehearse", "speed_mps", "Text", "ctx", "self"])
def test_an_argument_that_is_none_of_the_tools_refuses_the_call(tool: str, name: str) -> None:
    valid = {"text": "forward 10 cm"} if "`text`" in HAS[tool] else {}
    refused = call(tool, {**valid, name: True})
    assert refused.is_error
    assert text_of(refused) == f"Nothing was done: {tool} has no argument `{name}`; {HAS[tool]}."
    told = {"outcome": "failed", "reply": text_of(refused), "reason": {"code": "bad_arguments"}}
    assert refused.structured_content == told


def test_a_stop_is_obeyed_whatever_comes_with_it() -> None:
    stopped = call("stop", {"why": "a cat"})
    assert not stopped.is_error
    assert (stopped.structured_content or {})["stopped"]


@pytest.mark.parametrize(
    ("tool", "arguments", "problem"),
    [
        ("observe", {"picture": "maybe"}, '`picture` of observe is a boolean, not "maybe".'),
        ("observe", {"picture": None}, "`picture` of observe is a boolean, not null."),
        ("programs", {"action": 5}, "`action` of programs is a string, not 5."),
        ("programs", {"name": ["a"]}, '`name` of programs is a string, not ["a"].'),
    ],
)
def test_an_argument_of_another_type_refuses_the_call(
    tool: str, arguments: dict[str, Any], problem: str
) -> None:
    refused = call(tool, arguments)
    assert refused.is_error
    assert text_of(refused) == f"Nothing was done: {problem}"
    assert (refused.structured_content or {})["reason"] == {"code": "bad_arguments"}


def test_the_schemas_say_that_there_are_no_other_arguments() -> None:
    tools: list[Tool] = anyio.run(server().list_tools)
    assert len(tools) == len(HAS) + 1
    assert all(tool.input_schema["additionalProperties"] is False for tool in tools)
