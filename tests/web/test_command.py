"""`chatrobot web` as its user runs it: one line with the address, a robot that drives, and that stands when it ends."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tests.cli.running import Command
from tests.processes import RunningRobot, wait_until
from tests.web.rig import Client

pytestmark = pytest.mark.realtime
ARGUMENTS = ("web", "--no-open", "--port", "0", "--world", "empty")


class RunningWeb(RunningRobot):
    """The command, and pages that it serves."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        self._opened = contextlib.ExitStack()
        super().__init__(folder, (*ARGUMENTS, *arguments))
        line = self.wait_for_line("http://")
        found = re.search(r"http://[\w.]+:(\d+)/(?:#(\S+))?", line)
        assert found is not None, line
        self.port, self.token = int(found[1]), found[2]

    def dial(self, path: str, port: int) -> Client:
        headers = {"Authorization": f"Bearer {self.token}"} if self.token else {}
        how: dict[str, Any] = {"additional_headers": headers, "proxy": None, "max_size": 2**22}
        how["max_queue"] = None  # a page reads what comes, whatever the test waits for
        how["close_timeout"] = 0.5
        address, origin = f"ws://127.0.0.1:{port}{path}", f"http://127.0.0.1:{self.port}"
        return Client(self._opened.enter_context(connect(address, origin=origin, **how)))

    def page(self) -> Client:
        page = self.dial("/ws", self.port)
        page.wait_for("hello")
        page.hold()
        return page

    def close(self) -> None:
        self._opened.close()
        super().close()

    def stop_line(self, page: Client) -> Client:
        return self.dial("/stop", page.heard[0]["stop_port"])


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningWeb]:
    """For those that leave it as it was, but for where the robot is."""
    running = RunningWeb(tmp_path_factory.mktemp("web"))
    yield running
    running.close()


@pytest.fixture
def page(shared: RunningWeb) -> Iterator[Client]:
    """The page that steers it."""
    page = shared.page()
    yield page
    page.socket.close()
    wait_until(lambda: not any(any(twist) for _, twist in shared.velocities.since(time.monotonic() - 0.3)))


@pytest.fixture
def web(tmp_path: Path) -> Iterator[RunningWeb]:
    running = RunningWeb(tmp_path)
    yield running
    running.close()


def drive(web: RunningWeb, page: Client, text: str = "forward 3 m") -> float:
    said_s = time.monotonic()
    page.say("say", text=text)
    return web.velocities.wait_for_motion(said_s)


def test_what_a_page_says_is_driven_and_measured(shared: RunningWeb, page: Client) -> None:
    page.say("say", text="forward 0.3 m, then turn left 30 degrees")
    result = page.wait_for_event("result", 20.0)["event"]
    assert result["outcome"] == "completed"
    assert result["path_m"] == pytest.approx(0.3, abs=0.02)
    page.say("go", x_m=0.5, y_m=0.0)
    turn = page.wait_for_event("rehearsed")["event"]["turn"]
    time.sleep(0.3)
    page.say("approve", turn=turn, yes=True)
    assert page.wait_for_event("result", 20.0)["event"]["pose"]["x_m"] == pytest.approx(0.5, abs=0.03)
    page.say("say", text="write a program that drives forward 20 cm")  # a new one is asked about
    asked = page.wait_for_event("rehearsed")["event"]
    assert asked["needs_approval"]
    page.say("approve", turn=asked["turn"], yes=False)
    assert page.wait_for_event("result")["event"]["outcome"] == "refused"
    address, recording = [line for line in shared.lines if line]
    assert address == f"Web console: http://127.0.0.1:{shared.port}/"
    assert recording.startswith("Recording to ")


def test_the_page_of_the_documents_shows_what_is_printed(shared: RunningWeb) -> None:
    text = (Path(__file__).parents[2] / "docs" / "web.md").read_text(encoding="utf-8")
    command, printed = text.partition("```console\n$ ")[2].splitlines()[:2]
    assert command == "chatrobot web"
    assert printed.replace("8080", str(shared.port)) == shared.lines[0]


def test_the_stop_line_stops_a_moving_robot(shared: RunningWeb, page: Client) -> None:
    line = shared.stop_line(page)
    drive(shared, page)
    said_s = time.monotonic()
    line.say("stop")
    assert shared.velocities.seconds_to_zero(said_s) < 0.25
    assert page.wait_for_event("result")["event"]["outcome"] == "stopped"


def test_a_robot_whose_steering_page_is_gone_stands(shared: RunningWeb, page: Client) -> None:
    drive(shared, page, "back 3 m")
    gone_s = time.monotonic()
    page.socket.close()
    assert shared.velocities.seconds_to_zero(gone_s) < 0.5
    page = shared.page()
    assert page.heard[0]["history"][-1]["event"]["outcome"] == "stopped"
    drive(shared, page)
    frozen_s = time.monotonic()
    page.freeze()
    assert shared.velocities.seconds_to_zero(frozen_s) < 0.8
    page.socket.close()


def test_a_stick_drives_while_it_is_held(shared: RunningWeb, page: Client) -> None:
    began_s = time.monotonic()
    while time.monotonic() - began_s < 1.0:
        page.say("steer", vx_mps=0.3, vy_mps=0.0, wz_radps=0.0)
        time.sleep(0.05)
    moved = [twist for _, twist in shared.velocities.since(began_s) if any(twist)]
    assert max(twist.vx_mps for twist in moved) == pytest.approx(0.3, abs=0.02)
    let_go_s = time.monotonic()  # nothing more is said of it, while the page beats on
    assert shared.velocities.seconds_to_zero(let_go_s) < 0.8


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_its_end_stops_the_robot_and_tells_the_pages(web: RunningWeb, number: signal.Signals) -> None:
    page = web.page()
    drive(web, page)
    ended_s = time.monotonic()
    os.kill(web.process.pid, number)
    assert web.velocities.seconds_to_zero(ended_s) < 0.5
    assert page.wait_for("gone")["what"] == "server"
    with pytest.raises(ConnectionClosed):
        page.wait_for("nothing")
    assert web.process.wait(10.0) == 5


def test_a_motion_that_dies_is_told_and_ends_it(web: RunningWeb) -> None:
    page = web.page()
    os.kill(web.motion_pid, signal.SIGKILL)
    assert page.wait_for("gone")["what"] == "motion"
    assert web.process.wait(10.0) == 1


def test_on_other_addresses_only_the_link_lets_in(tmp_path: Path) -> None:
    web = RunningWeb(tmp_path, "--host", "0.0.0.0")
    try:
        assert web.token
        here = web.wait_for_line("On this machine")
        assert here.endswith(f"http://127.0.0.1:{web.port}/#{web.token}")
        assert "#" in web.wait_for_line("To watch only")
        address = f"http://127.0.0.1:{web.port}"
        assert httpx.get(f"{address}/me", trust_env=False).status_code == 401
        page = web.page()
        assert page.heard[0]["role"] == "steerer"
        others = [line for line in web.lines[1:] if line.strip() != here.strip()]
        assert web.token not in "".join(others), "the link is printed once, and once for this machine"
    finally:
        web.close()


def test_a_port_that_was_asked_for_and_is_taken_is_an_error(chatrobot: Command) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = chatrobot("web", "--no-open", "--port", str(port))
    assert done.code == 2
    assert f"127.0.0.1:{port}" in done.err
    assert "--port 0" in done.err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--fast"], "real time"),
        (["--tls-cert", "x.pem"], "belong together"),
        (["--tls-cert", "no.pem", "--tls-key", "no.pem"], "cannot be read"),
        (["--token", "a b"], "--token"),
        (["--host", "no.such.host.invalid", "--port", "0"], "no.such.host.invalid"),
        (["--port", "99999"], "not a port"),
    ],
)
def test_wrong_options_name_the_way_out(chatrobot: Command, arguments: list[str], said: str) -> None:
    done = chatrobot("web", "--no-open", *arguments)
    assert done.code == 2
    assert said in done.err
    assert done.out == ""
