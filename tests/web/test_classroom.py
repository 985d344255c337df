"""A class as its users run it: the command, the teacher's page, and pupils who steer a robot of their own each."""

from __future__ import annotations

import contextlib
import itertools
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, expect
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from chatrobot.programs.library import KeptProgram, Library
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage
from tests.cli.running import Command
from tests.processes import PATIENCE_S, Heard, TalkingProcess
from tests.web.browser import browser, find_violations, open_page
from tests.web.rig import Client

__all__ = ["browser"]
pytestmark = pytest.mark.realtime
PUPILS = 3


class RunningClass(TalkingProcess):
    """`chatrobot web --class 3`, and those who open its pages."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
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
        how: dict[str, Any] = {
            "additional_headers": headers,
            "proxy": None,
            "max_size": 2**22,
            "close_timeout": 0.5,
        }
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
        robots_where(teacher, lambda robots: not any(one["pages"] or one["moving"] for one in robots))
        teacher.socket.close()

    def close(self) -> None:
        self._dialled.close()
        self._opened.close()
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(PATIENCE_S)


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
    robots = robots_where(teacher, lambda robots: robots[1]["moving"] and robots[1]["pose"][0] > 0.05)
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


WINDOW_S = 2.0
ENDLESS_PROGRAM = "while True:\n    pass\n"
ENDLESS_TEXT = "forward 10 cm, then look left and " * 110
ENDLESS_PLAN = "drive 0.1 m\nturn left 10 deg\n" * 490


@contextlib.contextmanager
def kept_busy(page: Client, *orders: dict[str, str]) -> Iterator[None]:
    """Say these in turn, each as soon as the one before has been answered."""
    is_over = threading.Event()

    def insist() -> None:
        for order in itertools.cycle(orders):
            page.say(**order)
            while not is_over.is_set():
                with contextlib.suppress(TimeoutError):
                    page.wait_for_event("result", timeout_s=0.1)
                    break
            if is_over.is_set():
                return

    thread = threading.Thread(target=insist)
    thread.start()
    yield
    is_over.set()
    thread.join()


def velocities_of(ear: Heard) -> list[bool]:
    """Whether each that comes from now on, for a while, is one."""
    began_s = time.monotonic()
    time.sleep(WINDOW_S)
    return [any(twist) for _, twist in ear.since(began_s)]


@pytest.mark.alone
def test_a_program_and_a_text_without_end_cost_the_others_nothing(pupils: RunningClass) -> None:
    drive(pupils, 0)
    undisturbed = velocities_of(pupils.heard[0])
    Library(pupils.folder / "config/class/pupil-2").keep(KeptProgram("busy", ENDLESS_PROGRAM))
    program = {"do": "edit_program", "name": "busy", "source": ENDLESS_PROGRAM}
    texts = {"do": "say", "text": ENDLESS_TEXT}, {"do": "say_plan", "plan_text": ENDLESS_PLAN}
    with kept_busy(pupils.pupil(1), program), kept_busy(pupils.pupil(2), *texts):
        disturbed = velocities_of(pupils.heard[0])
    assert all(disturbed), "it was stopped"
    assert len(disturbed) > 0.9 * len(undisturbed)


def test_only_the_teacher_releases_an_emergency_stop(pupils: RunningClass) -> None:
    page, teacher = pupils.pupil(0), pupils.teacher()
    page.say("emergency_stop")
    robots_where(teacher, lambda robots: robots[0]["emergency"])
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


def test_two_pupils_links_in_one_browser_stay_each_with_their_own_robot(
    pupils: RunningClass, browser: Browser
) -> None:
    tokens = pupils.pupils_tokens()
    first = open_page(browser, f"{pupils.origin}/#{tokens[0]}")
    second = first.context.new_page()
    second.goto(f"{pupils.origin}/#{tokens[1]}")
    expect(second.locator("#robot-title")).to_contain_text("Pupil 2 · ")
    first.reload()
    expect(first.locator("#robot-title")).to_contain_text("Pupil 1 · ")
    said_s = time.monotonic()
    first.get_by_label("Say something to the robot").fill("turn left three times")
    first.keyboard.press("Enter")
    pupils.heard[0].wait_for_motion(said_s)
    expect(second.locator("#robot-state")).to_have_text("Standing")
    second.keyboard.press("Escape")
    expect(second.locator("#stop-said")).to_have_text("The robot was told to stop.")
    expect(first.locator("#robot-state")).to_have_text("Moving")
    first.context.close()


def test_a_revoked_link_ends_its_page_and_its_motion_and_another_is_given(
    pupils: RunningClass, browser: Browser
) -> None:
    drive(pupils, 1)
    old = pupils.pupils_tokens()[0]
    pupil = open_page(browser, f"{pupils.origin}/#{old}")
    pupil.get_by_label("Say something to the robot").fill("forward 50 m at 0.3 m/s")
    asked_s = time.monotonic()
    pupil.keyboard.press("Enter")
    pupils.heard[0].wait_for_motion(asked_s)
    teacher = browser.new_page(locale="en-GB")
    teacher.goto(f"{pupils.origin}/teacher#{pupils.token}")
    teacher.get_by_role("button", name="New link: Pupil 1").click()
    said_s = time.monotonic()
    teacher.get_by_role("button", name="End the old link?: Pupil 1").click()
    pupils.heard[0].wait_for_zero(said_s)
    assert all(any(twist) for _, twist in pupils.heard[1].since(said_s)), "nobody else is stopped"
    expect(pupil.locator("#connection-banner")).to_contain_text("its link is not valid (any more)")
    with pytest.raises(InvalidStatus):
        pupils.dial("/ws", old)
    pupil.goto(f"{pupils.origin}/?as=pupil-1#{pupils.pupils_tokens()[0]}")  # pasted into the same tab
    expect(pupil.locator("#steering-state")).to_have_text("You steer")
    expect(pupil.locator("#turns .robot").last).to_contain_text("the teacher has ended this link")
    teacher.close()
    pupil.context.close()


@pytest.mark.parametrize("dark", [False, True])
def test_axe_finds_nothing_on_the_teachers_page(
    pupils: RunningClass, browser: Browser, *, dark: bool
) -> None:
    page = browser.new_page(color_scheme="dark" if dark else "light", locale="en-GB")
    page.goto(f"{pupils.origin}/teacher#{pupils.token}")
    page.get_by_role("button", name="New link: Pupil 2").click()
    expect(page.get_by_role("button", name="End the old link?: Pupil 2")).to_be_visible()
    page.get_by_label("Task for everybody").fill("Drive a square.")
    page.get_by_role("button", name="Hand out").click()
    page.get_by_role("button", name="Emergency stop for all").click()
    expect(page.get_by_role("button", name="Release emergency stop: Pupil 3")).to_be_visible()
    assert find_violations(page) == []
    page.get_by_role("button", name="Release all emergency stops").click()
    expect(page.get_by_role("button", name="Release emergency stop: Pupil 3")).to_be_hidden()
    page.close()


def test_a_teacher_who_looks_in_first_leaves_the_steering_to_the_pupil(pupils: RunningClass) -> None:
    teacher = pupils.dial("/ws?room=3", pupils.token)
    assert teacher.wait_for("hello", role="teacher", room="3")["steering"] is None
    teacher.say("take")
    assert teacher.wait_for("steering", you=True)["name"] == "The teacher"  # they may, when they want to
    teacher.socket.close()


def test_a_class_has_simulated_robots_alone_and_a_number_that_can_be(chatrobot: Command) -> None:
    for arguments in (("--class", "3", "--on", "dds"), ("--class", "1"), ("--class", "31")):
        done = chatrobot("web", *arguments)
        assert done.code == 2, done.err
        assert "--class" in done.err
