"""A class as its users run it: the command, the teacher's page, and pupils who steer a robot of their own each."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, expect
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage
from tests.cli.running import Command
from tests.processes import PATIENCE_S, Heard, TalkingProcess
from tests.web.browser import browser, open_page
from tests.web.rig import Client

__all__ = ["browser"]
pytestmark = pytest.mark.realtime
PUPILS = 3


class RunningClass(TalkingProcess):
    """`chatrobot web --class 3`, and those who open its pages."""

    def __init__(self, folder: Path) -> None:
        self._opened, self._dialled = contextlib.ExitStack(), contextlib.ExitStack()
        environment = {**os.environ, "XDG_RUNTIME_DIR": str(folder), "PYTHONUNBUFFERED": "1"}
        command = [
            sys.executable,
            "-m",
            "chatrobot",
            "web",
            "--class",
            str(PUPILS),
            "--no-open",
            "--port",
            "0",
        ]
        command += ["--world", "empty", "--config-dir", str(folder / "config")]
        super().__init__(command, environment, stderr=subprocess.STDOUT)
        line = self.wait_for_line("http://")
        found = re.search(r"http://[\w.]+:(\d+)/teacher#(\S+)", line)
        assert found is not None, line
        self.port, self.token = int(found[1]), found[2]
        self.heard = []
        paths = [*(folder / "chatrobot").glob("sim-*.wire")]
        assert len(paths) == PUPILS
        for path in sorted(paths):
            wire, ear = LocalWire(path), Heard()
            wire.subscribe("cmd_vel", TwistMessage, ear)
            self._opened.callback(wire.close)
            self.heard.append(ear)

    @property
    def origin(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def dial(self, path: str, token: str, port: int = 0) -> Client:
        headers = {"Authorization": f"Bearer {token}"}
        how: dict[str, Any] = {"additional_headers": headers, "proxy": None, "max_size": 2**22}
        address = f"ws://127.0.0.1:{port or self.port}{path}"
        return Client(self._dialled.enter_context(connect(address, origin=self.origin, **how)))

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
        while any(robot["pages"] or robot["moving"] for robot in teacher.wait_for("class")["robots"]):
            pass
        teacher.socket.close()

    def close(self) -> None:
        self._dialled.close()
        self._opened.close()
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(PATIENCE_S)


@pytest.fixture
def pupils(shared: RunningClass) -> Iterator[RunningClass]:
    yield shared
    shared.hang_up()


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


def test_each_pupil_drives_a_robot_of_their_own_and_the_teacher_sees_which(pupils: RunningClass) -> None:
    drive(pupils, 1)
    teacher = pupils.teacher()
    while True:
        robots = teacher.wait_for("class")["robots"]
        if robots[1]["moving"] and robots[1]["pose"][0] > 0.05:
            break
    assert [robot["moving"] for robot in robots] == [False, True, False]
    assert [robot["pages"] for robot in robots][1] == 1
    assert robots[1]["plan_text"].startswith("drive 50 m")


def test_the_teacher_stops_one_and_then_all(pupils: RunningClass) -> None:
    _, stopped, _ = drive(pupils, 0, 1, 2)
    teacher = pupils.teacher()
    said_s = time.monotonic()
    teacher.say("stop", room="2")
    pupils.heard[1].wait_for_zero(said_s)
    assert "the teacher pressed Stop" in stopped.wait_for_event("result")["text"]
    time.sleep(0.3)
    assert all(any(twist) for _, twist in pupils.heard[0].since(said_s))
    stop_port = teacher.heard[0]["stop_port"]
    line = pupils.dial("/stop", pupils.token, stop_port)
    said_s = time.monotonic()
    line.say("stop")
    line.wait_for("stopped")
    assert max(ear.seconds_to_zero(said_s) for ear in (pupils.heard[0], pupils.heard[2])) < 0.25


def test_only_the_teacher_releases_an_emergency_stop(pupils: RunningClass) -> None:
    page, teacher = pupils.pupil(0), pupils.teacher()
    page.say("emergency_stop")
    while not teacher.wait_for("class")["robots"][0]["emergency"]:
        pass
    page.say("release")
    assert page.wait_for("refused")["do"] == "release"
    page.say("say", text="forward 10 cm")
    assert page.wait_for_event("result")["event"]["outcome"] == "refused"
    teacher.say("release", room="1")
    page.wait_for("emergency", set=False)
    page.say("say", text="forward 10 cm")
    assert page.wait_for_event("result")["event"]["outcome"] == "completed"


def test_a_task_reaches_every_pupil_and_who_comes_later(pupils: RunningClass) -> None:
    here = pupils.pupil(0)
    pupils.teacher().say("task", text="Drive a <b>square</b>.")
    assert here.wait_for("task")["text"] == "Drive a <b>square</b>."
    later = pupils.dial("/ws", pupils.pupils_tokens()[2])
    history = later.wait_for("hello")["history"]
    assert [one["text"] for one in history if one["is"] == "task"] == ["Drive a <b>square</b>."]


def test_a_pupils_link_is_for_one_robot_and_not_for_the_class(pupils: RunningClass) -> None:
    token = pupils.pupils_tokens()[0]
    with pytest.raises(InvalidStatus):
        pupils.dial("/class", token)
    elsewhere = pupils.dial("/ws?room=2", token)
    assert elsewhere.wait_for("hello")["room"] == "1"
    with httpx.Client(base_url=pupils.origin, trust_env=False) as http:
        assert http.get("/me").status_code == 401
        assert http.get("/teacher").status_code == 200


def test_a_pupil_who_opens_the_teachers_page_is_told_that_it_is_not_theirs(
    pupils: RunningClass, browser: Browser
) -> None:
    page = open_page(browser, f"{pupils.origin}/#{pupils.pupils_tokens()[1]}")
    expect(page.locator("#robot-title")).to_contain_text("Pupil 2 · ")
    page.goto(f"{pupils.origin}/teacher")
    expect(page.locator("#connection-banner")).to_contain_text("This page may not come in")
    expect(page.locator("#robots li")).to_have_count(0)
    page.context.close()


def test_a_teacher_who_looks_in_first_leaves_the_steering_to_the_pupil(pupils: RunningClass) -> None:
    teacher = pupils.dial("/ws?room=3", pupils.token)
    assert teacher.wait_for("hello", role="teacher", room="3")["steering"] is None
    teacher.say("take")
    teacher.wait_for("steering", you=True)  # they may, when they want to
    teacher.socket.close()


def test_a_class_has_simulated_robots_alone_and_a_number_that_can_be(chatrobot: Command) -> None:
    for arguments in (("--class", "3", "--on", "dds"), ("--class", "1"), ("--class", "31")):
        done = chatrobot("web", *arguments)
        assert done.code == 2, done.err
        assert "--class" in done.err
