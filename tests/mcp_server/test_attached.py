"""A person and an agent on one robot: `chatrobot mcp` attached to a process in which a person has the robot."""

from __future__ import annotations

import contextlib
import os
import queue
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Iterator
from pathlib import Path
from unittest.mock import patch

import anyio
import pytest
from mcp import Client
from mcp.client.stdio import StdioServerParameters, stdio_client

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.events import Event, Rehearsed
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.pump import Pump
from chatrobot.mcp_server.host import host_agents
from tests.mcp_server.mcp_rig import Agent, Wire, environment, poll, text_of

pytestmark = pytest.mark.realtime
ADDRESS = "http://127.0.0.1:8080/"


class Person:
    """A person with a robot in this process, who lets agents in; their plans wait for the person's yes."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.heard: queue.Queue[Event] = queue.Queue()
        setup = Setup(world="empty", folder=folder / "config", options=Options(approve=True))
        self._connection: Connection = connect(setup, self.heard.put)
        self.session = self._connection.session
        self._pump = Pump(self.session, lambda _: None)
        self._pump.start()
        host = host_agents(self._connection, lambda: ADDRESS, is_simulated=True)
        assert host is not None
        self.host = host
        self.wire = Wire(folder)
        self.wire.open()

    def asked_about(self) -> int:
        """Wait for the question whether a plan may be driven; return its turn."""
        while True:
            event = self.heard.get(timeout=30.0)
            if isinstance(event, Rehearsed) and event.needs_approval:
                return event.turn

    def close(self) -> None:
        """Leave, the agents first."""
        self.wire.close()
        self.host.close()
        self._pump.stop()
        self._connection.close()

    @contextlib.asynccontextmanager
    async def agent(self) -> AsyncIterator[Agent]:
        """A client of `chatrobot mcp`, which finds this process."""
        words = ["-m", "chatrobot", "mcp"]
        server = StdioServerParameters(command=sys.executable, args=words, env=environment(self.folder))
        async with Client(stdio_client(server)) as client:
            yield Agent(client, self.wire)


@pytest.fixture(scope="module")
def person(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Person]:
    folder = tmp_path_factory.mktemp("attached")
    with patch.dict(os.environ, {"XDG_RUNTIME_DIR": str(folder)}):
        person = Person(folder)
        yield person
        person.close()
        assert not list((folder / "chatrobot").glob("agents-*")), "nothing is left behind"


def test_an_agents_plan_waits_for_the_persons_yes(person: Person) -> None:
    async def task() -> None:
        async with person.agent() as agent:
            waiting = await agent.call("instruct", text="forward 30 cm")
            assert waiting.structured_content is not None
            assert waiting.structured_content["outcome"] == "waiting"
            assert ADDRESS in text_of(waiting)
            assert (await agent.data("instruct", text="yes"))["outcome"] == "waiting", "its own yes is none"
            turn = await anyio.to_thread.run_sync(person.asked_about)
            assert not any(any(twist) for _, twist in agent.wire.velocities.all)
            person.session.approve(turn, yes=True)
            await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_motion)
            await anyio.sleep(1.0)
            while (seen := await agent.data("observe"))["moving"]:
                await anyio.sleep(0.1)
            assert seen["pose"]["x_m"] == pytest.approx(0.3, abs=0.03)
            assert "0.30 m" in seen["happened"][0]
            assert seen["robot"]["shared_with"] == "chatrobot web"

    anyio.run(task)


def test_a_person_who_says_no_is_obeyed(person: Person) -> None:
    async def task() -> None:
        async with person.agent() as agent:
            said_s = time.monotonic()
            await agent.data("instruct", text="back 30 cm")
            turn = await anyio.to_thread.run_sync(person.asked_about)
            person.session.approve(turn, yes=False)
            await anyio.sleep(0.5)
            seen = await agent.data("observe")
            assert "waiting_for_approval_at" not in seen
            assert "refused" in seen["happened"][0]
            assert not any(any(twist) for _, twist in agent.wire.velocities.since(said_s))

    anyio.run(task)


def test_a_persons_emergency_stop_holds_until_they_release_it(person: Person) -> None:
    async def task() -> None:
        async with person.agent() as agent:
            await agent.data("instruct", text="forward 2 m")
            person.session.approve(await anyio.to_thread.run_sync(person.asked_about), yes=True)
            await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_motion, time.monotonic())
            pressed_s = time.monotonic()
            person.session.emergency_stop("the red button")
            zero_s = await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_zero, pressed_s)
            assert zero_s - pressed_s < 0.5
            await anyio.sleep(0.8)

            await agent.data("instruct", text="back 30 cm")
            person.session.approve(await anyio.to_thread.run_sync(person.asked_about), yes=True)
            await anyio.sleep(0.5)
            seen = await agent.data("observe")
            assert "emergency" in str(seen["happened"][0]).casefold()
            assert "released" not in str(await agent.data("instruct", text="release the emergency stop"))

            person.session.release()
            await anyio.sleep(0.3)
            await agent.data("instruct", text="back 30 cm")
            person.session.approve(await anyio.to_thread.run_sync(person.asked_about), yes=True)
            await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_motion, time.monotonic())
            await agent.call("stop")
            assert await agent.stands()

    anyio.run(task)


def test_a_client_that_leaves_withdraws_nothing_of_the_persons(person: Person) -> None:
    async def task() -> None:
        async with person.agent() as agent:
            assert (await agent.data("rehearse", text="forward 30 cm"))["outcome"] == "completed"
        turn = person.session.say_plan("drive 0.3 m")
        assert await anyio.to_thread.run_sync(person.asked_about) == turn
        person.session.approve(turn, yes=True)
        await anyio.to_thread.run_sync(poll, lambda: turn in person.session.results)
        assert person.session.results[turn].outcome == "completed"

    anyio.run(task)


CLIENT = """
import sys, anyio
from mcp import Client
from mcp.client.stdio import StdioServerParameters, stdio_client

async def task():
    server = StdioServerParameters(command=sys.executable, args=["-m", "chatrobot", "mcp"], env=ENVIRONMENT)
    async with Client(stdio_client(server)) as client:
        await client.call_tool("instruct", {"text": "back 3 m"})
        await anyio.sleep(60)

anyio.run(task)
"""


def test_a_client_that_is_killed_ends_what_it_had_approved(person: Person) -> None:
    source = CLIENT.replace("ENVIRONMENT", repr(environment(person.folder)))
    client = subprocess.Popen([sys.executable, "-c", source], start_new_session=True)
    try:
        person.session.approve(person.asked_about(), yes=True)
        person.wire.velocities.wait_for_motion(time.monotonic())
        killed_s = time.monotonic()
        client.kill()
        assert person.wire.velocities.seconds_to_zero(killed_s) < 1.0
    finally:
        client.kill()
        client.wait()
