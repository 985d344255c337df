"""An agent over stdio: the SDK's client, `chatrobot mcp` and its robot, each in processes of their own."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import anyio
import pytest
from mcp import Client
from mcp.client.stdio import StdioServerParameters, stdio_client

from chatrobot.recording.reader import read
from tests.mcp_server.mcp_rig import (
    PATIENCE_S,
    Wire,
    command,
    environment,
    json_lines,
    over_stdio,
    poll,
    text_of,
)

pytestmark = pytest.mark.realtime


def test_an_agent_rehearses_drives_looks_and_cancels(tmp_path: Path) -> None:
    path = tmp_path / "agent.mcap"

    async def task() -> None:
        async with over_stdio(tmp_path, "--record", str(path)) as agent:
            turn = {"kind": "turn", "angle_rad": 1.5707963267948966}
            as_object = {"steps": [{"kind": "drive", "distance_m": 0.4}, turn]}
            rehearsed = await agent.data("rehearse", plan=as_object)
            assert rehearsed["outcome"] == "completed"
            assert rehearsed["rehearsed"]["length_m"] == pytest.approx(0.4, abs=0.01)
            assert not agent.wire.velocities.all or not any(any(t) for _, t in agent.wire.velocities.all)

            shown = text_of(await agent.call("rehearse", text="forward 40 cm, then left"))
            assert "Plan: drive 0.4 m; turn left 90 deg" in shown, "many models see no more than this"

            done = await agent.data("instruct", plan="drive 0.4 m\nturn left 90 deg")
            assert done["outcome"] == "completed"
            assert done["path_m"] == pytest.approx(0.4, abs=0.02)
            assert done["turned_deg"] == pytest.approx(90.0, abs=2.0)
            told = [percent for percent, _, _ in agent.progress]
            assert len(told) >= 3
            assert told == sorted(told)
            assert told[-1] <= 100.0

            seen = await agent.data("observe")
            assert seen["pose"]["x_m"] == pytest.approx(0.4, abs=0.03)
            own = {"simulated": True, "world": "empty", "shared_with": None}
            assert seen["robot"] == {"name": "wheeltec_mini_mec", **own}
            assert set(seen["free_way_m"]) >= {"ahead", "left", "behind", "right"}

            await agent.cancel_in_motion(text="前进三米")
            assert await agent.stands()
            after = await agent.data("observe")
            assert "cancelled" in json.dumps(after["happened"]) or "取消" in str(after["happened"])
            assert abs(after["pose"]["y_m"]) < 2.0, "it was to be 3 m and was cancelled long before"

            again = await agent.data("instruct", text="back 20 cm")
            assert again["outcome"] == "completed", "the next call works as ever"

    anyio.run(task)
    recording = read(path)
    plan, in_words = "drive 0.4 m\nturn left 90 deg", "forward 40 cm, then left"  # rehearsed, then driven
    assert [text for _, text in recording.words] == [plan, in_words, plan, "前进三米", "back 20 cm"]
    ended = [event["outcome"] for _, event in recording.events if event["event"] == "result"]
    assert ended == ["completed", "completed", "completed", "stopped", "completed"]
    assert max(odometry.x_m for _, odometry in recording.odometry) == pytest.approx(0.4, abs=0.03)


def test_an_argument_that_a_tool_does_not_have_moves_nothing(tmp_path: Path) -> None:
    async def task() -> None:
        async with over_stdio(tmp_path) as agent:
            await agent.data("observe")
            for wrong in ({"rehearse": True}, {"speed_mps": 0.05}):
                refused = await agent.data("instruct", text="forward 10 cm", **wrong)
                assert refused["reason"]["code"] == "bad_arguments"
            assert not any(any(twist) for _, twist in agent.wire.velocities.all)

    anyio.run(task)


def test_which_robot_it_is_can_be_read_before_the_first_call(tmp_path: Path) -> None:
    async def task() -> None:
        words = command(tmp_path)
        server = StdioServerParameters(command=words[0], args=words[1:], env=environment(tmp_path))
        async with Client(stdio_client(server)) as client:
            (state,) = (await client.read_resource("chatrobot://state")).contents
        told = json.loads(state.text)
        own = {"simulated": True, "world": "empty", "shared_with": None}
        assert told["robot"] == {"name": "wheeltec_mini_mec", **own}
        assert told["connected"]

    anyio.run(task)


def test_an_emergency_stop_refuses_all_motion_and_no_agent_releases_it(tmp_path: Path) -> None:
    async def task() -> None:
        async with over_stdio(tmp_path) as agent:
            for wrong in ({"plan": "drive"}, {"plan": "{bad"}, {"text": 5}):
                assert (await agent.data("instruct", **wrong))["outcome"] == "unclear"

            agent.wire.say("emergency stop")
            await anyio.sleep(0.3)
            said_s = time.monotonic()
            refused = await agent.data("instruct", text="forward 1 m")
            assert refused["outcome"] == "refused"
            assert refused["reason"]["code"] == "emergency_stop"
            for text in ("release the emergency stop", "release", "解除急停"):
                assert (await agent.data("instruct", text=text))["outcome"] in ("refused", "unclear")
            again = await agent.data("instruct", plan="drive 0.2 m")
            assert (again["outcome"], again["reason"]["code"]) == ("refused", "emergency_stop")
            assert "emergency_stop" in await agent.data("observe")
            assert not any(any(twist) for _, twist in agent.wire.velocities.since(said_s))

    anyio.run(task)


def test_a_robot_that_needs_a_yes_moves_for_no_agent_alone(tmp_path: Path) -> None:
    async def task() -> None:
        async with over_stdio(tmp_path, "--approve") as agent:
            began_s = time.monotonic()
            refused = await agent.call("instruct", text="forward 1 m")
            assert refused.structured_content["outcome"] == "refused"
            assert "person's yes" in text_of(refused)
            assert "chatrobot web" in text_of(refused)
            assert time.monotonic() - began_s < 20.0, "it is withdrawn, and does not wait for half a minute"
            assert (await agent.data("instruct", text="yes"))["outcome"] != "completed"
            assert (await agent.data("rehearse", text="forward 1 m"))["outcome"] == "completed"
            assert not any(any(twist) for _, twist in agent.wire.velocities.all)

    anyio.run(task)


CLIENT = """
import sys, anyio
from mcp import Client
from mcp.client.stdio import StdioServerParameters, stdio_client

async def task():
    server = StdioServerParameters(command=sys.argv[1], args=sys.argv[2:], env=None)
    async with Client(stdio_client(server)) as client:
        await client.call_tool("instruct", {"text": "forward 5 m"})

anyio.run(task)
"""


def test_a_client_that_is_killed_stops_the_robot_and_leaves_nothing_behind(tmp_path: Path) -> None:
    words = command(tmp_path)
    client = subprocess.Popen(
        [sys.executable, "-c", CLIENT.replace("env=None", f"env={environment(tmp_path)!r}"), *words],
        start_new_session=True,
    )
    wire = Wire(tmp_path)
    try:
        wire.open()
        wire.velocities.wait_for_motion()
        time.sleep(0.3)
        killed_s = time.monotonic()
        os.kill(client.pid, signal.SIGKILL)
        assert wire.velocities.seconds_to_zero(killed_s) < 1.0
        assert poll(lambda: not wire.has_motion), "Motion leaves with its client"
    finally:
        client.kill()
        client.wait()
        wire.close()


def say(process: subprocess.Popen[bytes], **message: object) -> None:
    assert process.stdin is not None
    process.stdin.write((json.dumps({"jsonrpc": "2.0", **message}) + "\n").encode())
    process.stdin.flush()


def test_garbage_is_answered_output_is_the_protocol_alone_and_asked_to_end_it_stops_the_robot(
    tmp_path: Path,
) -> None:
    server = subprocess.Popen(
        command(tmp_path), stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment(tmp_path)
    )
    assert server.stdin is not None
    for garbage in (
        b"forward 1 m\n",
        b"\xff\xfe\x00\n",
        b"{}\n",
        b"[1, 2\n",
        b"x" * 5_000_000 + b"\n",
        b"\n",
    ):
        server.stdin.write(garbage)
    hello = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "t", "version": "1"}}
    say(server, id=1, method="initialize", params=hello)
    say(server, method="notifications/initialized")
    long = {"name": "instruct", "arguments": {"text": "forward 1 m " * 17_000}}
    say(server, id=2, method="tools/call", params=long)
    say(
        server, id=3, method="tools/call", params={"name": "instruct", "arguments": {"text": "forward 20 cm"}}
    )
    assert server.stdout is not None
    answers: dict[Any, Any] = {}
    while 3 not in answers:
        (message,) = json_lines(server.stdout.readline().decode())
        answers[message.get("id")] = message.get("result", message.get("error"))
    assert answers[None]["code"] == -32700
    assert answers[1]["serverInfo"]["name"] == "chatrobot"
    assert "characters" in answers[2]["content"][0]["text"]
    assert answers[2]["isError"]
    assert answers[3]["structuredContent"]["path_m"] == pytest.approx(0.2, abs=0.02)

    wire = Wire(tmp_path)
    wire.open()
    say(server, id=4, method="tools/call", params={"name": "instruct", "arguments": {"text": "forward 5 m"}})
    wire.velocities.wait_for_motion()
    asked_s = time.monotonic()
    server.terminate()
    assert wire.velocities.seconds_to_zero(asked_s) < 1.0
    assert server.wait(PATIENCE_S) == 5
    *_, last = json_lines(server.stdout.read().decode())
    assert last["result"]["structuredContent"]["outcome"] == "stopped", "an agent is told how its call ended"
    wire.close()
