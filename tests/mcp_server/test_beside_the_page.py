"""An agent and a person on one robot, each in processes of their own: `chatrobot mcp` attached to `chatrobot web`."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

import anyio
import pytest
from mcp import Client as McpClient
from mcp.client.stdio import StdioServerParameters, stdio_client

from tests.mcp_server.mcp_rig import Agent, Wire, environment, text_of
from tests.web.test_command import RunningWeb

pytestmark = pytest.mark.realtime
LET_GO_S = 1.0
"""By then a stick of which nothing is heard is nobody's any more."""
ATTACHED = [sys.executable, "-m", "chatrobot", "mcp"]


class House:
    """One `chatrobot web`, with its page open and beating; agents come with `agent`."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        self.folder = folder
        self.web = RunningWeb(folder, *arguments)
        self.page = self.web.page()
        self.wire = Wire(folder, self.web.velocities)

    @contextlib.asynccontextmanager
    async def agent(self) -> AsyncIterator[Agent]:
        """A client of `chatrobot mcp`, which finds the console by itself."""
        server = StdioServerParameters(command=ATTACHED[0], args=ATTACHED[1:], env=environment(self.folder))
        async with McpClient(stdio_client(server)) as client:
            yield Agent(client, self.wire)

    async def asked_about(self) -> dict[str, Any]:
        """Wait until the page asks whether a plan may be driven; return the question."""
        while True:
            event = await self.told("event")
            if event["event"].get("needs_approval"):
                return dict(event["event"])

    async def told(self, kind: str, **fields: Any) -> dict[str, Any]:
        """Wait until the page is told that."""
        return await anyio.to_thread.run_sync(lambda: self.page.wait_for(kind, 20.0, **fields))

    async def hears_all(self) -> None:
        """Have the page read whatever it was told until now."""
        self.page.say("history")
        await self.told("history")

    async def moves(self, since_s: float) -> float:
        """Wait for motion."""
        return await anyio.to_thread.run_sync(self.web.velocities.wait_for_motion, since_s)

    async def seconds_to_zero(self, since_s: float) -> float:
        """Wait until the robot has been told to stand, and keeps to it."""
        return await anyio.to_thread.run_sync(self.web.velocities.seconds_to_zero, since_s)

    def close(self) -> None:
        """End the console as its user does."""
        self.web.process.send_signal(signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.web.process.wait(10.0)
        self.web.close()


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> Iterator[House]:
    """A console whose person is asked about every plan."""
    house = House(tmp_path_factory.mktemp("asked"), "--approve")
    yield house
    house.close()


@pytest.fixture(scope="module")
def free(tmp_path_factory: pytest.TempPathFactory) -> Iterator[House]:
    """A console whose robot drives without being asked about."""
    house = House(tmp_path_factory.mktemp("free"))
    yield house
    house.close()


async def _while_it_drives(
    house: House, agent: Agent, text: str, do: Callable[[], Awaitable[None]]
) -> dict[str, Any]:
    """Have the agent instruct; once the robot moves, do that. Return what the agent is told of its instruction."""
    told: list[dict[str, Any]] = []

    async def instruct() -> None:
        result = await agent.call("instruct", text=text)
        told.append({**(result.structured_content or {}), "text": text_of(result)})

    async with anyio.create_task_group() as group:
        began_s = time.monotonic()
        group.start_soon(instruct)
        await house.moves(began_s)
        await anyio.sleep(0.3)
        await do()
    return told[0]


async def _seen(agent: Agent, *, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """Observe until that holds."""
    with anyio.fail_after(20.0):
        while not holds(seen := await agent.data("observe")):
            await anyio.sleep(0.1)
    return seen


def test_the_page_asks_and_its_yes_moves_the_robot_as_the_agent_was_told(asked: House) -> None:
    async def task() -> None:
        async with asked.agent() as agent:
            waiting = await agent.call("instruct", text="forward 30 cm")
            assert f"http://127.0.0.1:{asked.web.port}/" in text_of(waiting)
            question = await asked.asked_about()
            assert not any(any(twist) for _, twist in asked.web.velocities.all)
            yes_s = time.monotonic()
            asked.page.say("approve", turn=question["turn"], yes=True)
            await asked.moves(yes_s)
            seen = await _seen(agent, holds=lambda seen: "0.30 m" in str(seen["happened"][:1]))
            assert seen["pose"]["x_m"] == pytest.approx(0.3, abs=0.03)
            last = await agent.client.read_resource("chatrobot://last")
            assert '"completed"' in str(last.contents[0])
            ended = await asked.told("event")
            while ended["event"]["event"] != "finished":
                ended = await asked.told("event")
            assert ended["event"]["turn"] == question["turn"], "the page is told of the agent's end, too"

    anyio.run(task)


def test_a_no_in_the_page_is_told_to_the_agent_and_nothing_moves(asked: House) -> None:
    async def task() -> None:
        async with asked.agent() as agent:
            said_s = time.monotonic()
            await agent.data("instruct", text="back 30 cm")
            asked.page.say("approve", turn=(await asked.asked_about())["turn"], yes=False)
            seen = await _seen(agent, holds=lambda seen: "waiting_for_approval_at" not in seen)
            assert "refused" in seen["happened"][0]
            assert not any(any(twist) for _, twist in asked.web.velocities.since(said_s))

    anyio.run(task)


def test_an_edit_in_the_page_is_told_to_the_agent_with_what_was_driven(asked: House) -> None:
    async def task() -> None:
        async with asked.agent() as agent:
            await agent.data("instruct", text="back 60 cm")
            question = await asked.asked_about()
            asked.page.say("edit", turn=question["turn"], plan_text="drive 0.2 m back")
            edited = await asked.asked_about()
            asked.page.say("approve", turn=edited["turn"], yes=True)
            seen = await _seen(
                agent, holds=lambda seen: "edited your plan of turn" in str(seen["happened"][:1])
            )
            assert "drive 0.2 m back" in seen["happened"][0]
            assert "0.20 m" in seen["happened"][0], "as it was measured"
            assert "A person has edited this plan" in seen["happened"][1], "and not: not approved"
            last = await agent.client.read_resource("chatrobot://last")
            edited = json.loads(last.contents[0].model_dump()["text"])["edited_by_person"]
            assert edited["plan"] == "drive 0.2 m back"
            assert edited["result"]["outcome"] == "completed"

    anyio.run(task)


def test_a_second_agent_hears_that_the_first_ones_plan_waits(asked: House) -> None:
    async def task() -> None:
        async with asked.agent() as first, asked.agent() as second:
            await first.data("instruct", text="back 30 cm")
            question = await asked.asked_about()
            told = await second.call("instruct", text="forward 1 m")
            assert "Not taken" in text_of(told), "what waits is not its own plan"
            assert told.structured_content is not None
            assert told.structured_content["outcome"] == "waiting"
            asked.page.say("approve", turn=question["turn"], yes=False)
            await _seen(second, holds=lambda seen: "waiting_for_approval_at" not in seen)

    anyio.run(task)


def test_the_persons_stop_ends_the_agents_motion_and_says_whose_it_was(free: House) -> None:
    async def task() -> None:
        stop_line = free.web.stop_line(free.page)
        async with free.agent() as agent:

            async def stop() -> None:
                said_s = time.monotonic()
                stop_line.say("stop")
                assert await free.seconds_to_zero(said_s) < 0.5

            told = await _while_it_drives(free, agent, "forward 2 m", stop)
            assert told["outcome"] == "stopped"
            assert "A person stopped the robot" in told["text"]
            assert 0.0 < told["path_m"] < 1.9

    anyio.run(task)


def test_an_emergency_stop_refuses_the_agent_until_the_page_releases_it(free: House) -> None:
    async def task() -> None:
        async with free.agent() as agent:

            async def press() -> None:
                free.page.say("emergency_stop")

            told = await _while_it_drives(free, agent, "back 2 m", press)
            assert told["outcome"] == "stopped"
            assert "emergency stop is set" in told["text"]
            assert "emergency_stop" in await agent.data("observe")
            refused_s = time.monotonic()
            for text in ("back 30 cm", "release the emergency stop"):
                assert (await agent.data("instruct", text=text))["outcome"] == "refused"
            assert not any(any(twist) for _, twist in free.web.velocities.since(refused_s))
            free.page.say("release")
            await free.told("emergency", set=False)
            assert (await agent.data("instruct", text="turn left 20 degrees"))["outcome"] == "completed"

    anyio.run(task)


def test_a_person_at_the_stick_takes_over_and_the_agent_is_refused_meanwhile(free: House) -> None:
    async def task() -> None:
        async with free.agent() as agent:
            told = []

            async def hold() -> None:
                for _ in range(30):
                    free.page.say("steer", vx_mps=0.0, vy_mps=0.0, wz_radps=0.4)
                    await anyio.sleep(0.05)

            async def steer() -> None:
                async with anyio.create_task_group() as group:
                    group.start_soon(hold)
                    await anyio.sleep(0.5)
                    told.append(await agent.call("instruct", text="back 30 cm"))

            ended = await _while_it_drives(free, agent, "forward 2 m", steer)
            assert ended["outcome"] == "stopped"
            assert "A person has taken over" in ended["text"]
            refused = told[0].structured_content
            assert refused is not None
            assert refused["outcome"] == "refused"
            assert "driving" in text_of(told[0])
            await anyio.sleep(LET_GO_S)
            assert (await agent.data("instruct", text="back 10 cm"))["outcome"] == "completed"

    anyio.run(task)


def test_a_cancelled_call_stops_the_robot_and_the_page_is_told(free: House) -> None:
    async def task() -> None:
        async with free.agent() as agent:
            await free.hears_all()
            cancelled_s = await agent.cancel_in_motion(text="forward 2 m")
            assert await free.seconds_to_zero(cancelled_s) < 0.5
            while (event := (await free.told("event"))["event"])["event"] != "finished":
                pass
            assert event["outcome"] == "stopped"

    anyio.run(task)


CLIENT = """
import sys, anyio
from mcp import Client
from mcp.client.stdio import StdioServerParameters, stdio_client

async def task():
    server = StdioServerParameters(command=sys.executable, args=["-m", "chatrobot", "mcp"], env=ENVIRONMENT)
    async with Client(stdio_client(server)) as client:
        await client.call_tool("instruct", {"text": TEXT})
        await anyio.sleep(60)

anyio.run(task)
"""


def killed_in_motion(house: House, text: str) -> float:
    """Have a client of its own process instruct, and kill it while the robot moves; return when."""
    source = CLIENT.replace("ENVIRONMENT", repr(environment(house.folder))).replace("TEXT", repr(text))
    client = subprocess.Popen([sys.executable, "-c", source], start_new_session=True)
    try:
        house.web.velocities.wait_for_motion(time.monotonic())
        time.sleep(0.2)
        killed_s = time.monotonic()
        os.kill(client.pid, signal.SIGKILL)
        return killed_s
    finally:
        client.kill()
        client.wait()


def test_a_killed_client_ends_its_motion_and_no_other(free: House) -> None:
    assert free.web.velocities.seconds_to_zero(killed_in_motion(free, "back 2 m")) < 1.0

    async def task() -> None:
        async with free.agent() as idle:
            await idle.data("observe")
            client = subprocess.Popen(
                ATTACHED, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, env=environment(free.folder)
            )
            await anyio.sleep(1.0)
            said_s = time.monotonic()
            free.page.say("say", text="forward 50 cm")
            await free.moves(said_s)
            client.kill()
            client.wait()
        while (event := (await free.told("event"))["event"])["event"] != "result" or event["turn"] >= 10**6:
            pass
        assert event["outcome"] == "completed", "two agents left while the person's plan was driven"

    anyio.run(task)


def test_the_end_of_the_console_is_told_to_the_agent_whose_motion_it_ends(tmp_path: Path) -> None:
    house = House(tmp_path)

    async def task() -> None:
        async with house.agent() as agent:

            async def end() -> None:
                ended_s = time.monotonic()
                house.web.process.send_signal(signal.SIGINT)
                assert await house.seconds_to_zero(ended_s) < 1.0

            told = await _while_it_drives(house, agent, "forward 3 m", end)
            assert told["outcome"] == "stopped"

    try:
        anyio.run(task)
        assert house.web.process.wait(10.0) == 5
        assert not list((tmp_path / "chatrobot").glob("agents-*")), "nobody attaches to what has ended"
    finally:
        house.web.close()
