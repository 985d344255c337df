"""`chatrobot web --class 3` with a lesson, and those who open its pages."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser
from websockets.sync.client import connect

from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage
from tests.processes import PATIENCE_S, Heard, TalkingProcess
from tests.web.rig import Client

PUPILS = 3


class RunningClass(TalkingProcess):
    """`chatrobot web --class 3`, or of so many, and those who open its pages."""

    def __init__(self, folder: Path, count: int = PUPILS) -> None:
        self.folder = folder
        self._opened, self._dialled = contextlib.ExitStack(), contextlib.ExitStack()
        environment = {**os.environ, "XDG_RUNTIME_DIR": str(folder), "PYTHONUNBUFFERED": "1"}
        command = [
            sys.executable,
            "-m",
            "chatrobot",
            "web",
            "--class",
            str(count),
            "--no-open",
            "--port",
            "0",
        ]
        command += ["--lesson", "first-moves", "--config-dir", str(folder / "config")]
        super().__init__(command, environment, stderr=subprocess.STDOUT)
        line = self.wait_for_line("http://")
        found = re.search(r"http://[\w.]+:(\d+)/teacher#(\S+)", line)
        assert found is not None, line
        self.port, self.token = int(found[1]), found[2]
        self.heard = []
        paths = [*(folder / "chatrobot").glob("sim-*.wire")]
        assert len(paths) == count
        for path in sorted(paths, key=lambda path: int(path.stem.rpartition("-")[2])):
            wire, ear = LocalWire(path), Heard()
            wire.subscribe("cmd_vel", TwistMessage, ear)
            self._opened.callback(wire.close)
            self.heard.append(ear)

    @property
    def origin(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def dial(self, path: str, token: str, port: int = 0) -> Client:
        headers = {"Authorization": f"Bearer {token}"}
        how: dict[str, Any] = {
            "additional_headers": headers,
            "proxy": None,
            "max_size": 2**22,
            "close_timeout": 0.5,
            "ping_interval": None,  # an answer would wait behind what a test does not read
        }
        address = f"ws://127.0.0.1:{port or self.port}{path}"
        return Client(self._dialled.enter_context(connect(address, origin=self.origin, **how)))

    def http(self, token: str) -> httpx.Client:
        headers = {"Authorization": f"Bearer {token}", "Origin": self.origin}
        return self._dialled.enter_context(
            httpx.Client(base_url=self.origin, trust_env=False, headers=headers, timeout=PATIENCE_S)
        )

    def teacher(self) -> Client:
        page = self.dial("/class", self.token)
        page.wait_for("hello")
        return page

    def pupils_tokens(self) -> list[str]:
        robots = self.teacher().wait_for("class")["robots"]
        return [robot["link"].partition("#")[2] for robot in robots]

    def pupil(self, place: int) -> Client:
        page = self.dial("/ws", self.pupils_tokens()[place])
        page.wait_for("hello", role="pupil", room=str(place + 1))
        page.say("take")
        page.wait_for("steering", you=True)
        page.hold()
        return page

    def hang_up(self) -> None:
        """Leave nobody at any page, and every robot standing."""
        self._dialled.close()
        teacher = self.teacher()
        robots_where(teacher, _are_left)
        teacher.socket.close()

    def close(self) -> None:
        self._dialled.close()
        self._opened.close()
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(PATIENCE_S)
        left = [*(self.folder / "chatrobot").glob("class-*")]
        assert left == [], "what pupils kept ends with the class"


def _are_left(robots: list[dict[str, Any]]) -> bool:
    return not any(one["pages"] or one["is_looked_at"] or one["moving"] for one in robots)


def robots_where(teacher: Client, holds: Callable[[list[dict[str, Any]]], bool]) -> list[dict[str, Any]]:
    """Return what the teacher sees of the robots once that holds."""
    ends_s = time.monotonic() + PATIENCE_S
    while not holds(robots := teacher.wait_for("class")["robots"]):
        assert time.monotonic() < ends_s, robots
    return robots


@pytest.fixture
def pupils(shared: RunningClass) -> Iterator[RunningClass]:
    yield shared
    shared.hang_up()


@pytest.fixture
def browsing(browser: Browser) -> Iterator[Browser]:
    """A browser whose pages are closed, whatever became of the test; before `pupils` hangs up, if named after it."""
    yield browser
    for context in browser.contexts:
        context.close()


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningClass]:
    running = RunningClass(tmp_path_factory.mktemp("class"))
    yield running
    running.close()


def drive(pupils: RunningClass, *places: int) -> list[Client]:
    """Have these pupils drive; return their pages once they move."""
    began_s = time.monotonic()
    pages = [pupils.pupil(place) for place in places]
    for page in pages:
        page.say("say", text="forward 50 m at 0.3 m/s")
    for place in places:
        pupils.heard[place].wait_for_motion(began_s)
    return pages
