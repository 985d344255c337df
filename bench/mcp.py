"""An agent over MCP: a cancelled call and `stop`, to the zero at a subscriber in another process; start; what an
agent's model reads. Run: python -m bench.mcp

Promised: a cancelled call is a zero within 50 ms, and all descriptions of tools together are at most 1,000 tokens.
"""

from __future__ import annotations

import json
import tempfile
import time
from functools import partial
from pathlib import Path

import anyio
from tests.mcp_server.mcp_rig import Agent, HttpServer, Wire, over_http, over_stdio

from bench import line

REPETITIONS = 30
CHARS_A_TOKEN = 3.0
"""Fewer than any tokenizer of today needs for English and JSON: the figure errs towards too many tokens."""


async def seconds_to_zero(agent: Agent, since_s: float) -> float:
    """Seconds to the first zero; the client, which may still have to say that it has given up, goes on meanwhile."""
    zero_s = await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_zero, since_s)
    assert await agent.stands(), "the robot was to stand"
    return zero_s - since_s


async def cancelled(agent: Agent) -> float:
    """Seconds from the cancelled call to the zero."""
    at_s = await agent.cancel_in_motion(plan="repeat 20\n  drive 0.5 m\n  drive 0.5 m back\nend")
    return await seconds_to_zero(agent, at_s)


async def stopped(agent: Agent) -> float:
    """Seconds from a call of `stop`, while `instruct` moves the robot, to the zero."""
    began_s = time.monotonic()
    async with anyio.create_task_group() as group:
        group.start_soon(partial(agent.call, "instruct", text="forward 3 m"))
        await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_motion, began_s)
        await anyio.sleep(0.3)
        at_s = time.monotonic()
        await agent.call("stop")
    return await seconds_to_zero(agent, at_s)


async def over_each_carrier(folder: Path) -> None:
    """Measure over stdio and over HTTP."""
    began_s = time.monotonic()
    async with over_stdio(folder / "stdio") as agent:
        await agent.client.list_tools()
        print(f"process started → tools listed: {time.monotonic() - began_s:.2f} s")
        line("stdio: cancelled → zero", [await cancelled(agent) for _ in range(REPETITIONS)])
        line("stdio: stop → zero", [await stopped(agent) for _ in range(REPETITIONS)])
        await sizes(agent)
    server = HttpServer(folder / "http")
    wire = Wire(folder / "http")
    wire.open()
    try:
        for mode in ("auto", "legacy"):
            async with over_http(server.url, server.token, wire, mode) as agent:
                line(f"HTTP ({mode}): cancelled → zero", [await cancelled(agent) for _ in range(REPETITIONS)])
    finally:
        wire.close()
        server.close()


async def sizes(agent: Agent) -> None:
    """Print what a client's model reads of the tools."""
    tools = (await agent.client.list_tools()).tools
    chars = len(json.dumps([tool.model_dump(by_alias=True, exclude_none=True) for tool in tools]))
    print(
        f"descriptions of {len(tools)} tools: {chars} characters, at most {chars / CHARS_A_TOKEN:.0f} tokens"
    )


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("stdio", "http"):
            (Path(folder) / name).mkdir()
        anyio.run(over_each_carrier, Path(folder))


if __name__ == "__main__":
    main()
