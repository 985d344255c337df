"""An agent over HTTP: one server and its robot for all tests here, in processes of their own."""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import AbstractAsyncContextManager
from pathlib import Path
from typing import Any

import anyio
import pytest

from chatrobot.execution.estimator import STANDING_SPEED_MPS
from tests.mcp_server.mcp_rig import Agent, HttpServer, Wire, over_http, text_of

pytestmark = pytest.mark.realtime


class Served:
    """A server, and the wire of its robot."""

    def __init__(self, folder: Path) -> None:
        self.server = HttpServer(folder)
        self.wire = Wire(folder)
        self.wire.open()

    def agent(self, mode: str = "auto") -> AbstractAsyncContextManager[Agent]:
        """A client with the token; velocities are heard from now on."""
        return self._agent(mode)

    @contextlib.asynccontextmanager
    async def _agent(self, mode: str) -> AsyncIterator[Agent]:
        self.wire.velocities.all.clear()
        async with over_http(self.server.url, self.server.token, self.wire, mode) as agent:
            await agent.call("instruct", plan="go to 0 0 facing 0 deg")
            self.wire.velocities.all.clear()
            yield agent

    def status(self, **headers: str) -> int:
        """The status of a request with those headers."""
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=20.0)
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "tools/list"})
        accept = {"Content-Type": "application/json", "Accept": "application/json, text/event-stream"}
        connection.request("POST", "/mcp", body, {**accept, **named})
        status = connection.getresponse().status
        connection.close()
        return status


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    served = Served(tmp_path_factory.mktemp("http"))
    yield served
    served.wire.close()
    served.server.close()


@pytest.mark.parametrize("mode", ["auto", "legacy"])
def test_an_agent_drives_and_cancels_over_http(served: Served, mode: str) -> None:
    async def task() -> None:
        async with served.agent(mode) as agent:
            done = await agent.data("instruct", text="forward 30 cm")
            assert (done["outcome"], done["path_m"]) == ("completed", pytest.approx(0.3, abs=0.02))
            assert agent.progress, "there is progress on the way"
            await agent.cancel_in_motion(text="forward 3 m")
            assert await agent.stands()
            assert (await agent.data("instruct", text="back 10 cm"))["outcome"] == "completed"

    anyio.run(task)


HTTPX2_WAITS_S = 5.0
"""So long a client of httpx2 hears nothing before it gives up, unless its user says otherwise."""


@pytest.mark.parametrize("mode", ["auto", "legacy"])
def test_a_client_that_gives_up_after_silence_hears_a_long_motion_out(served: Served, mode: str) -> None:
    async def task() -> None:
        server, wire = served.server, served.wire
        async with over_http(server.url, server.token, wire, mode, HTTPX2_WAITS_S) as agent:
            done = await agent.client.call_tool("instruct", {"plan": f"wait {HTTPX2_WAITS_S + 2.0} s"})
            assert done.structured_content["outcome"] == "completed"

    anyio.run(task)


def test_what_is_seen_to_roll_is_never_told_to_stand(served: Served) -> None:
    async def task() -> None:
        async with served.agent() as agent:
            await agent.cancel_in_motion(text="forward 3 m")
            speeds_mps = []
            while (seen := await agent.data("observe", picture=False))["speed_mps"] > STANDING_SPEED_MPS:
                speeds_mps.append(seen["speed_mps"])
                assert seen["moving"]
            assert speeds_mps, "it rolls on for a moment"

    anyio.run(task)


def test_without_the_token_nobody_gets_in(served: Served) -> None:
    assert served.status() == 401
    assert served.status(Authorization="Bearer wrong") == 401
    assert served.status(Authorization=f"Basic {served.server.token}") == 401
    assert served.status(Cookie=f"token={served.server.token}") == 401


def test_a_foreign_host_or_origin_is_refused_even_with_the_token(served: Served) -> None:
    port, token = served.server.port, f"Bearer {served.server.token}"
    for host in (
        "evil.example",
        f"evil.example:{port}",
        f"127.0.0.1.evil.example:{port}",
        "127.0.0.1:1",
        "10.0.0.1",
    ):
        assert served.status(Authorization=token, Host=host) == 421, host
    for origin in (
        "http://evil.example",
        "null",
        f"https://127.0.0.1:{port}",
        "http://127.0.0.1:1",
        "file://",
    ):
        assert served.status(Authorization=token, Origin=origin) == 403, origin
    assert served.status(Authorization=token, Origin=f"http://127.0.0.1:{port}") not in (401, 403, 421)


CLIENT = """
import sys, anyio, httpx2
from mcp import Client
from mcp.client.streamable_http import streamable_http_client

async def task():
    async with (
        httpx2.AsyncClient(headers={"Authorization": "Bearer " + sys.argv[2]}, timeout=60) as http,
        Client(streamable_http_client(sys.argv[1], http_client=http), mode=sys.argv[3]) as client,
    ):
        await client.call_tool("instruct", {"plan": "drive 2 m back"})

anyio.run(task)
"""


@pytest.mark.parametrize("mode", ["auto", "legacy"])
def test_a_client_that_is_killed_stops_the_robot(served: Served, mode: str) -> None:
    served.wire.velocities.all.clear()
    words = [sys.executable, "-c", CLIENT, served.server.url, served.server.token, mode]
    client = subprocess.Popen(words, start_new_session=True)
    try:
        served.wire.velocities.wait_for_motion()
        time.sleep(0.3)
        killed_s = time.monotonic()
        os.kill(client.pid, signal.SIGKILL)
        assert served.wire.velocities.seconds_to_zero(killed_s) < 1.0
    finally:
        client.kill()
        client.wait()


def test_a_persons_stop_ends_the_call_and_the_agent_is_told_who_it_was(served: Served) -> None:
    async def task() -> None:
        async with served.agent() as agent:
            results = []

            async def instruct() -> None:
                results.append(await agent.call("instruct", text="forward 3 m"))

            async def next_one() -> None:
                await anyio.sleep(0.2)
                results.append(await agent.call("instruct", text="turn left"))

            async with anyio.create_task_group() as group:
                group.start_soon(instruct)
                group.start_soon(next_one)
                await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_motion)
                await anyio.sleep(0.4)
                said_s = agent.wire.say("stop")
            stopped, not_begun = results
            assert stopped.structured_content["outcome"] == "stopped"
            assert stopped.structured_content["reason"]["source"] == "user_input"
            assert "A person stopped the robot" in text_of(stopped)
            assert not_begun.structured_content["reason"]["code"] == "not_begun", (
                "nor does what waited set out"
            )
            assert agent.wire.velocities.seconds_to_zero(said_s) < 1.0
            assert await agent.stands()

    anyio.run(task)


def test_a_call_that_is_given_up_while_it_waits_takes_along_what_waits_behind_it(served: Served) -> None:
    async def task() -> None:
        async with served.agent() as agent:
            told: dict[str, dict[str, Any]] = {}

            async def instruct(text: str) -> None:
                told[text] = await agent.data("instruct", text=text)

            async with anyio.create_task_group() as group:
                group.start_soon(instruct, "forward 1 m")
                await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_motion)
                async with anyio.create_task_group() as given_up:
                    given_up.start_soon(instruct, "turn left")
                    await anyio.sleep(0.3)
                    group.start_soon(instruct, "forward 50 cm")
                    await anyio.sleep(0.3)
                    given_up.cancel_scope.cancel()
            assert "turn left" not in told
            assert told["forward 1 m"]["outcome"] == "completed", (
                "it was under way, and somebody waits for it"
            )
            assert told["forward 50 cm"]["reason"]["code"] == "not_begun", "it was to begin after the turn"

    anyio.run(task)


def test_what_an_agent_pauses_it_goes_on_with_and_a_rehearsal_does_not(served: Served) -> None:
    async def task() -> None:
        async with served.agent() as agent:
            results = []

            async def instruct() -> None:
                results.append(await agent.data("instruct", text="forward 1 m"))

            async with anyio.create_task_group() as group:
                group.start_soon(instruct)
                await anyio.to_thread.run_sync(agent.wire.velocities.wait_for_motion)
                await anyio.sleep(0.8)
                await agent.call("instruct", text="pause")
            assert results[0]["outcome"] == "paused"
            assert await agent.stands()
            said_s = time.monotonic()
            await agent.call("rehearse", text="continue")
            await anyio.sleep(0.5)
            assert not any(any(twist) for _, twist in agent.wire.velocities.since(said_s))
            done = await agent.data("instruct", text="continue")
            assert done["outcome"] == "completed"
            assert (await agent.data("observe"))["pose"]["x_m"] == pytest.approx(1.0, abs=0.05)

    anyio.run(task)


def test_programs_are_written_rehearsed_kept_and_run(served: Served) -> None:
    source = (
        "import time\nimport rclpy\nfrom geometry_msgs.msg import Twist\n\n"
        "def main():\n    rclpy.init()\n    node = rclpy.create_node('spin')\n"
        "    out = node.create_publisher(Twist, 'cmd_vel', 10)\n    turn = Twist()\n    turn.angular.z = 0.5\n"
        "    for _ in range(10):\n        out.publish(turn)\n        time.sleep(0.1)\n"
        "    out.publish(Twist())\n    rclpy.shutdown()\n\nmain()\n"
    )

    async def task() -> None:
        async with served.agent() as agent:
            written = await agent.data("programs", action="write", name="spin", text=source)
            assert (written["outcome"], written["program"]["name"]) == ("completed", "spin")
            assert not any(any(twist) for _, twist in agent.wire.velocities.all), "written is not run"
            run = await agent.data("programs", action="run", name="spin")
            assert run["turned_deg"] == pytest.approx(28.6, abs=6.0)
            broken = await agent.call(
                "programs", action="write", name="broken", text=source.replace("0.5", "1/0")
            )
            assert "ZeroDivisionError" in text_of(broken)
            words = await agent.call("programs", action="write", name="hop", text="forward 20 cm")
            assert text_of(words).startswith("Kept as “hop”. completed: ")
            listed = await agent.data("programs")
            assert [each["name"] for each in listed["programs"]] == ["broken", "hop", "spin"]
            assert [each["by"] for each in listed["programs"]] == ["agent", "offline", "agent"]
            missing = await agent.call("programs", action="run", name="waltz")
            assert missing.is_error
            assert "broken, hop, spin" in text_of(missing)
            assert (missing.structured_content or {})["reason"]["code"] == "no_program"
            unknown = await agent.call("programs", action="delete", name="spin")
            assert text_of(unknown) == "'delete' is no action: list, show, write, rehearse, run."

    anyio.run(task)


def test_who_guesses_at_the_token_has_to_wait(served: Served) -> None:
    statuses = [served.status(Authorization=f"Bearer guess{number}") for number in range(12)]
    assert statuses[-1] == 429
    assert set(statuses) == {401, 429}
