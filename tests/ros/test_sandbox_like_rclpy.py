"""What our rclpy says of names, types, parameters, timers, services and errors is what rclpy says, line by line."""

# ruff: noqa: E402 - the path comes first
from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[2] / "src")]
from snippets import HEAD, SNIPPETS

from chatrobot.programs.events import Ended, Output, ProgramEvent
from chatrobot.programs.pipe import ProgramSettings
from chatrobot.programs.sandboxed import SandboxedProgram, warm_server
from chatrobot.sandbox.warm_server import WarmServer


@pytest.fixture(scope="module")
def server() -> Iterator[WarmServer]:
    with warm_server() as warm:
        warm.start()
        yield warm


def in_the_box(server: WarmServer, source: str) -> list[str]:
    program = SandboxedProgram(server, ProgramSettings(source, horizon_s=100.0))
    program.start()
    events: list[ProgramEvent] = []
    while program.end is None:
        events += program.poll(1.0)
    program.close()
    assert isinstance(program.end, Ended), program.end
    return [event.text for event in events if isinstance(event, Output) and event.stream == "stdout"]


def under_rclpy(source: str) -> list[str]:
    environment = {**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    ran = subprocess.run(
        [sys.executable, "-c", source],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=True,
    )
    return ran.stdout.splitlines()


@pytest.mark.slow
@pytest.mark.realtime
@pytest.mark.parametrize("name", SNIPPETS)
def test_both_print_the_same(server: WarmServer, name: str) -> None:
    source = HEAD + SNIPPETS[name]
    assert in_the_box(server, source) == under_rclpy(source)
