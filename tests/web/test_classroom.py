"""A class as its users run it: the command, the teacher's page, and pupils who steer a robot of their own each."""

from __future__ import annotations

import contextlib
import io
import itertools
import re
import stat
import threading
import time
from collections.abc import Iterator

import httpx
import pytest
from mcap.reader import make_reader
from playwright.sync_api import Browser, expect
from websockets.exceptions import InvalidStatus

from chatrobot.cli.entry import main
from chatrobot.programs.library import KeptProgram, Library
from tests.processes import Heard, wait_until
from tests.web.browser import browser, find_violations, open_page
from tests.web.class_rig import RunningClass, browsing, drive, pupils, robots_where, shared
from tests.web.rig import Client

__all__ = ["browser", "browsing", "pupils", "shared"]
pytestmark = pytest.mark.realtime


def test_each_pupil_takes_the_lesson_and_the_teacher_moves_all_on(pupils: RunningClass) -> None:
    """Before the others, which drive these robots elsewhere."""
    one, teacher = pupils.pupil(2), pupils.teacher()
    begun = [told for told in one.heard[0]["history"] if told["is"] == "lesson"]
    assert begun[0]["head"] == "Task 1 of 4: One metre"
    one.say("say", text="forward 70 cm")
    assert "the goal is still 0.30 m away" in one.wait_for("verdict", state="missing")["text"]
    one.say("say", text="another 30 cm")
    passed = one.wait_for("verdict")["text"]
    assert re.fullmatch(
        r"Task 1 passed: the robot stands at the goal; it drove (1\.0[0-2]|0\.9[89]) m\.", passed
    )
    robots = robots_where(teacher, lambda robots: robots[2]["lesson"]["states"][0] == "passed")
    assert [robot["lesson"]["number"] for robot in robots] == [1, 1, 2]
    one.say("say", text="/again")
    one.wait_for("note", text="The task begins now.")
    teacher.say("move_to", number=2)
    robots = robots_where(teacher, lambda robots: robots[0]["lesson"]["number"] == 2)
    assert [robot["lesson"]["states"][0] for robot in robots] == ["skipped", "skipped", "passed"]
    one.say("say", text="turn left by a bit more than 60 degrees")
    one.say("say", text="forward 30 cm")
    one.wait_for("verdict")
    for command in ("/task", "/again"):
        one.say("say", text=command)
    assert one.wait_for("note")["text"].startswith("Task 2 of 4: ")
    one.wait_for("note", text="The robot drives back to where the task begins.")
    one.wait_for("verdict", text="The task begins now.")
    for _ in range(3):
        one.say("say", text="/skip")
    for command in ("/task", "/hint", "/skip", "/again"):
        one.say("say", text=command)
        while "Lesson not passed: 1 of 4 tasks." not in one.wait_for("note")["text"]:
            pass
    one.say("say", text="/task 9")
    one.wait_for("note", text="There is no such task: /task 1 to /task 4 go to one.")
    one.say("say", text="/task 2")
    robots_where(teacher, lambda robots: robots[2]["lesson"]["states"][1] == "open")
    one.say("say", text="/skip")
    told = _told_in_the_report_of(pupils, 2)
    heard = {text for kind, text in told if kind == "gesagt"}
    assert {"forward 70 cm", "/again", "/skip"} <= heard
    assert not any(text.startswith("go to ") for text in heard), "nobody said that"
    assert {passed, "Task 3 is left out; /task 3 goes back to it."} <= {
        text for kind, text in told if kind == "Hinweis"
    }


def _told_in_the_report_of(pupils: RunningClass, place: int) -> set[tuple[str, str]]:
    time.sleep(1.0)  # it has been written
    http = pupils.http(pupils.token)
    name = http.get("/recordings").json()["files"][place]["name"]
    page = http.get(f"/recordings/{name.replace('mcap', 'html')}?language=de").text
    assert '<html lang="de"' in page
    return set(re.findall(r'class="kind">(.*?)</span></td>\s*<td class="text" dir="auto">(.*?)</td>', page))


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
    (kept,) = (pupils.folder / "chatrobot").glob("class-*")
    Library(kept / "class" / "pupil-2").keep(KeptProgram("busy", ENDLESS_PROGRAM))
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
    page.say("say", text="解除急停")
    assert "Only your teacher" in page.wait_for("note")["text"]
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


def test_the_teacher_alone_fetches_and_deletes_what_is_recorded(pupils: RunningClass) -> None:
    page = pupils.pupil(1)
    page.say("say", text="forward 10 cm")
    page.wait_for_event("result")
    http = pupils.http(pupils.token)
    files = http.get("/recordings").json()["files"]
    assert [file["pupil"] for file in files] == ["1", "2", "3"]
    name = files[1]["name"]
    assert any(name in told.get("text", "") for told in page.heard[0]["history"]), "the pupil is told"
    path = pupils.folder / "config" / "recordings" / name
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    time.sleep(0.6)  # it has been written
    wait_until(lambda: b"forward 10 cm" in _words(http.get(f"/recordings/{name}").content))
    assert "<html" in http.get(f"/recordings/{name.replace('mcap', 'html')}").text
    for stranger, status in ((pupils.http(pupils.pupils_tokens()[1]), 403), (pupils.http("guessed"), 401)):
        for method, where in (("GET", ""), ("GET", f"/{name}"), ("DELETE", f"/{name}"), ("DELETE", "")):
            assert stranger.request(method, f"/recordings{where}").status_code == status
    for elsewhere in ("..%2f..%2fhistory", "%2e%2e", "other.mcap", f"..%2frecordings%2f{name}"):
        for method in ("GET", "DELETE"):
            assert http.request(method, f"/recordings/{elsewhere}").status_code in (404, 405)
    foreign = {"Origin": "http://elsewhere.example"}
    assert http.delete(f"/recordings/{name}", headers=foreign).status_code == 403
    assert path.exists()
    assert http.delete(f"/recordings/{name}").json()["unrecorded"] == ["2"]
    assert not path.exists()
    assert "not recorded any more" in page.wait_for("note")["text"]


def _words(bag: bytes) -> bytes:
    """What was said, of a recording that has its index."""
    messages = make_reader(io.BytesIO(bag)).iter_messages(topics=["/user_input"])
    return b"".join(message.data for _, _, message in messages)


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
    pupils: RunningClass, browsing: Browser
) -> None:
    page = open_page(browsing, f"{pupils.origin}/#{pupils.pupils_tokens()[1]}")
    expect(page.locator("#robot-title")).to_contain_text("Pupil 2 · ")
    page.get_by_role("button", name="Hint").click()
    expect(page.locator("#turns .line").last).to_contain_text("Hint: ")
    assert find_violations(page) == []
    page.goto(f"{pupils.origin}/teacher")
    expect(page.locator("#connection-banner")).to_contain_text("This page may not come in")
    expect(page.locator("#robots li")).to_have_count(0)


def test_two_pupils_links_in_one_browser_stay_each_with_their_own_robot(
    pupils: RunningClass, browsing: Browser
) -> None:
    tokens = pupils.pupils_tokens()
    first = open_page(browsing, f"{pupils.origin}/#{tokens[0]}")
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


def test_a_revoked_link_ends_its_page_and_its_motion_and_another_is_given(
    pupils: RunningClass, browsing: Browser
) -> None:
    old = pupils.pupils_tokens()[0]
    pupil = open_page(browsing, f"{pupils.origin}/#{old}")
    teacher = browsing.new_page(locale="en-GB")
    teacher.goto(f"{pupils.origin}/teacher#{pupils.token}")
    expect(teacher.get_by_role("button", name="New link: Pupil 1")).to_be_visible()
    # Not from the browser, and once both pages stand: what a busy machine holds up stops the robot for that.
    drive(pupils, 0, 1)
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


@pytest.mark.parametrize("dark", [False, True])
def test_axe_finds_nothing_on_the_teachers_page(
    pupils: RunningClass, browsing: Browser, *, dark: bool
) -> None:
    page = browsing.new_page(color_scheme="dark" if dark else "light", locale="en-GB")
    page.goto(f"{pupils.origin}/teacher#{pupils.token}")
    page.get_by_text("Recordings of this class").click()
    page.get_by_role("button", name="Delete: Pupil 1").click()
    expect(page.get_by_role("button", name="Really delete?: Pupil 1")).to_be_visible()
    page.get_by_role("button", name="New link: Pupil 2").click()
    expect(page.get_by_role("button", name="End the old link?: Pupil 2")).to_be_visible()
    page.get_by_label("Task for everybody").fill("Drive a square.")
    page.get_by_role("button", name="Hand out").click()
    page.get_by_role("button", name="Emergency stop for all").click()
    expect(page.get_by_role("button", name="Release emergency stop: Pupil 3")).to_be_visible()
    assert find_violations(page) == []
    page.get_by_role("button", name="Release all emergency stops").click()
    expect(page.get_by_role("button", name="Release emergency stop: Pupil 3")).to_be_hidden()


def test_a_teacher_who_looks_in_first_leaves_the_steering_to_the_pupil(pupils: RunningClass) -> None:
    teacher = pupils.dial("/ws?room=3", pupils.token)
    assert teacher.wait_for("hello", role="teacher", room="3")["steering"] is None
    teacher.say("take")
    assert teacher.wait_for("steering", you=True)["name"] == "The teacher"  # they may, when they want to
    teacher.socket.close()


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (("--class", "3", "--on", "dds"), "--class"),
        (("--class", "31"), "--class"),
        (("--class", "0"), "0 is no class (2 to 30 pupils)"),
        (("--class", "3", "--record", "a.mcap"), "--record"),
        (("--class", "3", "--lesson", "first-move"), "did you mean first-moves?"),
        (("--lesson", "first-moves", "--world", "home"), "--world"),
    ],
)
def test_what_no_class_and_no_lesson_can_be_is_refused(
    arguments: tuple[str, ...], problem: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["web", *arguments]) == 2
    assert problem in capsys.readouterr().err
