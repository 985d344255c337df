"""Two people, a lost connection, every screen and language, the keyboard alone, axe: the page in a real browser."""

from __future__ import annotations

import time

import pytest
from playwright.sync_api import Browser, Page, expect

from chatrobot.cli.web import listen
from chatrobot.core.events import Result, Started, Telemetry
from chatrobot.core.geometry import ORIGIN, Twist
from chatrobot.web.access import Access
from chatrobot.web.server import WebServer
from chatrobot.web.words import told
from tests.processes import wait_until
from tests.web.browser import (
    DESKTOP,
    PHONE,
    TABLET,
    browser,
    find_violations,
    open_page,
    page,
    rehearse,
    say,
    write_program,
)
from tests.web.rig import WebRig

__all__ = ["browser", "page"]
pytestmark = pytest.mark.realtime


# --- people ---


def test_a_stop_that_a_watcher_types_stops_the_robot(page: Page, rig: WebRig, browser: Browser) -> None:
    expect(page.locator("#steering-state")).to_have_text("You steer")
    watcher = open_page(browser, rig.origin)
    watcher.locator("#say").fill("forward 1 m")
    watcher.locator("#say").press("Enter")
    expect(watcher.locator("#notice-banner")).not_to_be_empty()
    expect(watcher.locator("#say")).to_have_value("forward 1 m")
    watcher.locator("#say").fill("stop, please")
    watcher.locator("#say").press("Enter")
    wait_until(lambda: any(what[0] == "stop" for what in rig.session.log))
    assert not any(what[0] == "say" for what in rig.session.log)
    watcher.context.close()


def test_two_tabs_one_steers_and_taking_over_is_shown_to_both(
    page: Page, rig: WebRig, browser: Browser
) -> None:
    second = open_page(browser, rig.origin)
    expect(page.locator("#steering-state")).to_have_text("You steer")
    expect(second.locator("#watching-banner")).to_contain_text("You watch; take over to steer.")
    expect(second.get_by_role("button", name="Send")).to_be_disabled()
    second.set_viewport_size({"width": 390, "height": 844})
    assert second.evaluate("document.querySelector('.top').scrollWidth") <= 390
    second.get_by_role("button", name="Take over").click()
    second.set_viewport_size({"width": 1280, "height": 800})
    expect(second.locator("#steering-state")).to_have_text("You steer")
    expect(page.locator("#notice-banner")).to_contain_text("has taken over steering. You watch now.")
    expect(page.get_by_role("button", name="Take over")).to_be_visible()
    second.context.close()


def test_a_lost_connection_is_said_and_comes_back(page: Page, rig: WebRig) -> None:
    port, stop_port = rig.access.port, rig.access.stop_port
    rehearse(rig)
    rig.tell(Started(1, ORIGIN))
    expect(page.locator("#plan-about")).to_have_text("Runs now.")
    rig.server.close()
    expect(page.locator("#plan-about")).to_contain_text("Not connected")
    expect(page.get_by_role("alert")).to_contain_text("The connection is gone. The robot has stopped")
    expect(page.locator("#robot-state")).to_have_text("Not connected")
    page.keyboard.press("Escape")
    expect(page.locator("#stop-said")).to_contain_text("this Stop reached nothing")
    rig.server = WebServer(rig.access, rig.rooms)
    rig.server.start(listen("127.0.0.1", port), listen("127.0.0.1", stop_port))
    expect(page.locator("#connection-banner")).to_be_hidden()
    expect(page.locator("#steering-state")).to_have_text("You steer")
    page.keyboard.press("Escape")
    expect(page.locator("#stop-said")).to_have_text("The robot was told to stop.")


def test_a_server_that_falls_silent_is_said_within_a_second(page: Page, rig: WebRig) -> None:
    with rig.telling(Telemetry(0, ORIGIN, Twist(0.3, 0.0, 0.0), 0.0)):
        expect(page.locator("#robot-state")).to_have_text("Moving")
    silent_s = time.monotonic()
    expect(page.locator("#robot-state")).to_have_text("No answer")
    assert time.monotonic() - silent_s < 2.5  # before the connection is given up
    expect(page.locator("#gauge-speed b")).to_have_text("–")
    with rig.telling(Telemetry(0, ORIGIN, Twist(), 0.0)):
        expect(page.locator("#robot-state")).to_have_text("Standing")


# --- every screen, every language, every person ---


def test_a_browser_in_chinese_gets_a_chinese_page_that_can_be_switched(rig: WebRig, browser: Browser) -> None:
    page = open_page(browser, rig.origin, locale="zh-CN")
    expect(page.get_by_role("button", name="停止", exact=True)).to_be_visible()
    expect(page.get_by_role("button", name="急停", exact=True)).to_be_visible()
    assert page.locator("html").get_attribute("lang") == "zh-Hans"
    page.locator("#language").click()
    page.get_by_role("button", name="English").click()
    expect(page.get_by_role("button", name="Stop", exact=True)).to_be_visible()
    page.locator("#language").click()
    page.get_by_role("button", name="Deutsch").click()
    expect(page.get_by_role("button", name="Not-Halt", exact=True)).to_be_visible()
    assert page.locator("html").get_attribute("lang") == "de"
    page.context.close()


@pytest.mark.parametrize(
    ("size", "locale"),
    [
        (PHONE, "en-GB"),
        (TABLET, "en-GB"),
        ((844, 390), "de-AT"),
        ((320, 640), "en-GB"),
        ((320, 640), "de-AT"),
    ],
)
def test_small_screens_hold_everything_and_always_the_stop(
    rig: WebRig, browser: Browser, size: tuple[int, int], locale: str
) -> None:
    page = open_page(browser, rig.origin, size, locale=locale)
    stop = page.locator("#stop")
    expect(stop).to_be_in_viewport(ratio=1)
    expect(page.locator("#emergency")).to_be_in_viewport(ratio=1)
    assert page.evaluate("document.documentElement.scrollWidth") <= size[0]
    if page.locator(".tabs").is_visible():
        page.locator(".tabs [data-tab=drive]").click()
        expect(page.locator("#pad")).to_be_in_viewport()
        expect(stop).to_be_in_viewport(ratio=1)
    page.context.close()


_CUT_OFF = """() => {
  const context = document.createElement("canvas").getContext("2d");
  const widthOf = (element, text) => {
    context.font = getComputedStyle(element).font;
    return context.measureText(text).width;
  };
  const room = (element) => {
    const style = getComputedStyle(element);
    return element.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
  };
  const say = document.getElementById("say");
  const emergency = document.getElementById("emergency");
  const title = document.getElementById("robot-title");
  const found = [];
  if (widthOf(say, say.placeholder) > room(say)) found.push("placeholder");
  const words = emergency.textContent.split(/[ -]/).map((word) => widthOf(emergency, word));
  if (Math.max(...words) > room(emergency) + 1) found.push("emergency");
  if (title.clientWidth < widthOf(title, "Wheeltec")) found.push("title");
  if (document.querySelector("#stop small").checkVisibility()) found.push("keys");
  return found;
}"""


@pytest.mark.parametrize("locale", ["en-GB", "de-DE", "zh-CN"])
@pytest.mark.parametrize("size", [(390, 760), (320, 568), (740, 360)])
def test_a_phone_cuts_off_no_words_and_shows_the_box_to_speak_in(
    rig: WebRig, browser: Browser, size: tuple[int, int], locale: str
) -> None:
    page = open_page(browser, rig.origin, size, locale=locale)
    expect(page.locator("#say")).to_be_in_viewport(ratio=1)
    assert page.evaluate(_CUT_OFF) == []
    page.context.close()


def test_the_keyboard_alone_gets_everywhere_and_every_focus_is_seen(page: Page, rig: WebRig) -> None:
    say(page, rig, "drive half a metre")
    rehearse(rig)
    expect(page.get_by_role("button", name="Do it").first).to_be_visible()
    reached: list[str] = []
    for _ in range(60):
        page.keyboard.press("Tab")
        name, is_seen = page.evaluate(
            """() => {
              const element = document.activeElement;
              const style = getComputedStyle(element);
              const isSeen = style.outlineStyle !== "none" && parseFloat(style.outlineWidth) > 1;
              return [element.id || element.textContent.trim(), isSeen || element === document.body];
            }"""
        )
        assert is_seen, name
        reached.append(name)
    wanted = {
        "say",
        "send",
        "Do it",
        "Cancel",
        "floor",
        "follow",
        "heading",
        "zoom-in",
        "stick-speed",
        "plan-edit",
    }
    assert wanted | {"stop", "pause", "emergency", "language", "give"} <= set(reached)


@pytest.mark.parametrize(
    ("size", "locale", "dark"), [(DESKTOP, "en-GB", False), (DESKTOP, "de-DE", True), (PHONE, "zh-CN", True)]
)
def test_axe_finds_nothing(
    rig: WebRig, browser: Browser, size: tuple[int, int], locale: str, dark: bool
) -> None:
    page = open_page(browser, rig.origin, size, dark=dark, locale=locale)
    say(page, rig, "drive half a metre")
    write_program(rig, "import rclpy\n")
    rig.tell(Result(1, "refused", "No."))
    rehearse(rig, 2)
    expect(page.locator("#turns .buttons button")).to_have_count(3)
    assert find_violations(page) == []
    for tab in page.locator(".tabs button:visible").all():
        tab.click()
        assert find_violations(page) == []
    page.context.close()


def test_axe_finds_nothing_for_whoever_watches(page: Page, rig: WebRig, browser: Browser) -> None:
    expect(page.locator("#steering-state")).to_have_text("You steer")
    watcher = open_page(browser, rig.origin)
    assert find_violations(watcher) == []
    watcher.context.close()


def test_a_server_begun_anew_has_its_line_for_stop_open_from_a_page_that_stayed(browser: Browser) -> None:
    first = WebRig(Access("127.0.0.1"), [""])
    first.server.start(listen("127.0.0.1", 0), listen("127.0.0.1", 0))
    page = open_page(browser, first.origin)
    box = page.get_by_label("Say something to the robot")
    say(page, first, "forward 1 m")
    box.fill("half a sen")
    first.close()
    expect(page.locator("#connection-banner")).to_be_visible()
    expect(page.locator("#gauge-speed b")).to_have_text("–")
    second = WebRig(Access("127.0.0.1"), [""])
    try:
        with page.expect_navigation():
            second.server.start(listen("127.0.0.1", first.access.port), listen("127.0.0.1", 0))
        expect(page.locator("#steering-state")).to_have_text("You steer")
        expect(page.get_by_role("log", name="What was said")).to_contain_text("The server was started anew")
        expect(box).to_have_value("half a sen")
        box.press("ArrowUp")
        expect(box).to_have_value("forward 1 m")
        wait_until(lambda: bool(page.evaluate("import('/stop.js').then((line) => line.isStopLineOpen())")))
    finally:
        page.context.close()
        second.close()


def test_the_newest_stays_in_sight_when_the_keyboard_of_a_phone_comes_up(
    rig: WebRig, browser: Browser
) -> None:
    page = open_page(browser, rig.origin, PHONE)
    for number in range(1, 9):
        say(page, rig, f"drive {number} m")
        rig.tell(Result(number, "refused", f"No, not {number} m."))
    expect(page.get_by_text("No, not 8 m.")).to_be_in_viewport()
    page.set_viewport_size({"width": PHONE[0], "height": 600})
    expect(page.get_by_text("No, not 8 m.")).to_be_in_viewport()
    page.context.close()


def test_the_newest_stays_in_sight_beside_a_lesson_after_a_reload(page: Page, rig: WebRig) -> None:
    lines = [f"Line {number} of the task." for number in range(6)]
    rig.room.pin("lesson", told("lesson", over=False, head="Task 1", lines=lines, about=[]))
    for number in range(1, 9):
        say(page, rig, f"drive {number} m")
        rig.tell(Result(number, "refused", f"No, not {number} m."))
    obeyed: list[str] = []
    rig.room.take_command = lambda _, text: obeyed.append(text) is None and text == "/skip"
    page.get_by_role("button", name="Leave it out").dblclick()
    wait_until(lambda: "/skip" in obeyed)
    page.reload()
    assert obeyed == ["/skip"]
    expect(page.get_by_text("No, not 8 m.")).to_be_in_viewport()
    say(page, rig, "drive 9 m")
    rig.tell(Result(9, "refused", "No, not 9 m."))
    expect(page.get_by_text("No, not 9 m.")).to_be_in_viewport()
