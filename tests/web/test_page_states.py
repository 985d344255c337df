"""What a person sees and does on the page, in a real browser; the session behind the real server only notes."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect

from chatrobot.cli.web import listen
from chatrobot.core.event import Proposal
from chatrobot.core.events import (
    Interpreted,
    Limited,
    ProgramLog,
    ProgramWritten,
    Progress,
    Rehearsed,
    Result,
    Started,
    Telemetry,
)
from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.web.server import WebServer
from tests.web.browser import DESKTOP, PHONE, TABLET, browser, count_pixels, open_page
from tests.web.rig import WebRig, wait_until

__all__ = ["browser"]
pytestmark = pytest.mark.realtime
EVIL = '<img src=x onerror="document.title=1"><b id="evil">&amp;</b>'
PATH = tuple((0.05 * step, 0.0, 0.0) for step in range(20))


@pytest.fixture
def page(browser: Browser, rig: WebRig) -> Iterator[Page]:
    opened = open_page(browser, rig.origin)
    yield opened
    opened.context.close()


def say(page: Page, text: str) -> None:
    page.get_by_label("Say something to the robot").fill(text)
    page.keyboard.press("Enter")


def rehearse(rig: WebRig, turn: int = 1) -> None:
    rig.tell(
        Interpreted(
            turn, "offline", "drive 0.5 m\nrepeat 2\n  turn left 90 deg\nend\nwait 1 s", "drive, turn"
        )
    )
    rig.tell(Rehearsed(turn, True, 8.0, 0.95, Pose(0.95, 0.0, 0.0), path=PATH, needs_approval=True))


def written(rig: WebRig, source: str, turn: int = 1) -> None:
    rig.tell(ProgramWritten(turn, "square", "offline", source, "drives a square"))


# --- chat ---


def test_a_plan_that_waits_is_answered_by_a_button(page: Page, rig: WebRig) -> None:
    say(page, "drive half a metre")
    rig.session.wait_for("say", "drive half a metre")
    rehearse(rig)
    chat = page.get_by_role("log", name="What was said")
    expect(chat).to_contain_text("Rehearsed: 0.95 m in 8 s.")
    wait_until(lambda: count_pixels(page, "rehearsed") > 50)
    chat.get_by_role("button", name="Do it").click()
    rig.session.wait_for("approve", 1, True)
    expect(chat.get_by_role("button")).to_have_count(0)


def test_an_edited_plan_goes_in_the_place_of_the_one_that_waits(page: Page, rig: WebRig) -> None:
    say(page, "drive half a metre")
    rehearse(rig)
    page.get_by_role("log", name="What was said").get_by_role("button", name="Edit").click()
    page.get_by_label("The plan, one step a line").fill("drive 0.2 m")
    page.get_by_role("button", name="Rehearse and run").click()
    rig.session.wait_for(
        "say_edited_plan", "drive 0.2 m", "drive 0.5 m\nrepeat 2\n  turn left 90 deg\nend\nwait 1 s"
    )


def test_a_question_is_answered_by_yes_or_no(page: Page, rig: WebRig) -> None:
    say(page, "forwrd 1 m")
    rig.session.wait_for("say", "forwrd 1 m")
    rig.tell(Result(1, "unclear", "Did you mean “forward 1 m”?", proposal=Proposal("drive 1 m", "Did you?")))
    page.get_by_role("button", name="Yes").click()
    rig.session.wait_for("say", "yes")


@pytest.mark.parametrize(
    ("question", "answers"),
    [
        ("To the left or to the right?", ["left", "right"]),
        ("Diagonally which way: forward-left or back-right?", ["forward-left", "back-right"]),
        ("往左还是往右？", ["往左", "往右"]),
        ("I am lost. Shall I drive on until something is near, or wait here for you?", []),
    ],
)
def test_a_question_that_offers_answers_has_a_button_for_each(
    page: Page, rig: WebRig, question: str, answers: list[str]
) -> None:
    say(page, "turn")
    rig.session.wait_for("say", "turn")
    rig.tell(Result(1, "unclear", question))
    chat = page.get_by_role("log", name="What was said")
    expect(chat).to_contain_text(question)
    assert chat.get_by_role("button").all_inner_texts() == answers


def test_what_was_said_before_comes_back_with_arrow_up(page: Page, rig: WebRig) -> None:
    for turn, text in enumerate(("forward 1 m", "turn left"), start=1):
        say(page, text)
        rig.tell(Result(turn, "completed", "Done."))
    box = page.get_by_label("Say something to the robot")
    box.press("ArrowUp")
    box.press("ArrowUp")
    expect(box).to_have_value("forward 1 m")
    box.press("ArrowDown")
    expect(box).to_have_value("turn left")


def test_a_page_that_comes_later_sees_what_was_said(page: Page, rig: WebRig, browser: Browser) -> None:
    say(page, "forward 1 m")
    rig.session.wait_for("say", "forward 1 m")
    rig.tell(Result(1, "completed", "Done: drove 1.00 m."))
    later = open_page(browser, rig.origin)
    expect(later.get_by_role("log", name="What was said")).to_contain_text("Done: drove 1.00 m.")
    later.context.close()


# --- plan, gauges, programs ---


def test_the_running_step_is_marked(page: Page, rig: WebRig) -> None:
    say(page, "drive half a metre")
    rehearse(rig)
    rig.tell(Started(1))
    rig.tell(Progress(1, 2, 3, 0.4, ORIGIN, Twist(0.1, 0.0, 0.0)))
    marked = page.locator("#plan-lines [aria-current=step]")
    expect(marked).to_have_text(["repeat 2", "  turn left 90 deg", "end"], use_inner_text=True)


def test_gauges_say_how_fast_how_near_and_what_is_limited(page: Page, rig: WebRig) -> None:
    rig.tell(Telemetry(0, ORIGIN, Twist(0.25, 0.0, 0.5), 1.0, battery_percent=63.0, nearest_obstacle_m=0.42))
    now = page.get_by_role("region", name="Now")
    expect(now.get_by_role("meter", name="Speed", exact=True)).to_have_attribute("aria-valuenow", "0.25")
    for text in ("0.25 of 1.00 m/s", "29 of 115 °/s", "0.42 m", "63 %"):
        expect(now).to_contain_text(text)
    rig.tell(Limited(1, "obstacle", Twist(0.5, 0.0, 0.0), Twist(0.2, 0.0, 0.0)))
    expect(page.locator("#limited")).to_contain_text("0.20")


def test_a_program_is_shown_with_its_log(page: Page, rig: WebRig) -> None:
    say(page, "write a program")
    written(rig, "import rclpy\nprint('hello')\n")
    rig.tell(Started(1))
    rig.tell(ProgramLog(1, 0.5, "INFO", "hello there"))
    programs = page.get_by_role("region", name="Programs")
    expect(programs.locator("#program-source li")).to_have_text(["import rclpy", "print('hello')"])
    expect(programs.get_by_role("log", name="Log")).to_contain_text("0.5 s hello there")


def test_what_others_wrote_is_text_and_never_markup(page: Page, rig: WebRig) -> None:
    say(page, EVIL)
    rig.session.wait_for("say", EVIL)
    rig.tell(Interpreted(1, "model", EVIL, EVIL))
    expect(page.locator("#plan-lines")).to_have_text(EVIL)
    rig.tell(ProgramWritten(1, EVIL, "model", EVIL, EVIL))
    rig.tell(ProgramLog(1, 0.1, "INFO", EVIL))
    rig.tell(Result(1, "answered", EVIL))
    expect(page.get_by_role("log", name="What was said")).to_contain_text(EVIL)
    expect(page.locator("#program-name")).to_have_text(EVIL)
    assert page.locator("#evil, img:not(.icon)").count() == 0
    assert "ChatRobot" in page.title()


# --- stop, stick ---


def test_the_space_bar_stops_even_on_a_button_and_before_a_word_is_typed(page: Page, rig: WebRig) -> None:
    page.get_by_role("button", name="Follow").focus()
    page.keyboard.press("Space")
    rig.session.wait_for("stop", "the Stop button")
    expect(page.get_by_role("button", name="Follow")).to_have_attribute("aria-pressed", "false")
    before = len(rig.session.log)
    box = page.get_by_label("Say something to the robot")
    box.press("Space")
    wait_until(lambda: len(rig.session.log) > before)
    box.fill("go")
    box.press("Space")
    expect(box).to_have_value("go ")


def test_stop_goes_out_when_the_finger_comes_down_on_both_lines(page: Page, rig: WebRig) -> None:
    button = page.get_by_role("button", name="Stop", exact=True).bounding_box()
    assert button is not None
    page.mouse.move(button["x"] + 20, button["y"] + 20)
    page.mouse.down()
    wait_until(lambda: rig.session.log.count(("stop", "the Stop button")) == 2)
    page.mouse.up()
    page.wait_for_timeout(100)
    assert rig.session.log.count(("stop", "the Stop button")) == 2


def test_an_emergency_stop_is_its_own_button_and_is_released_by_another(page: Page, rig: WebRig) -> None:
    release = page.get_by_role("button", name="Release emergency stop")
    expect(release).to_be_hidden()
    page.get_by_role("button", name="Emergency stop", exact=True).click()
    rig.session.wait_for("emergency_stop", "the Emergency stop button")
    expect(page.locator("#robot-state")).to_have_text("Emergency stop")
    release.click()
    rig.session.wait_for("release")


def test_a_key_drives_while_it_is_held_and_lets_go_once(page: Page, rig: WebRig) -> None:
    page.locator("body").focus()
    page.evaluate("document.activeElement.blur()")
    page.keyboard.down("w")
    wait_until(lambda: sum(one[0] == "steer" and one[1] > 0 for one in rig.session.log) >= 3)
    page.keyboard.up("w")
    rig.session.wait_for("steer", 0.0, 0.0, 0.0)
    count = len(rig.session.log)
    page.wait_for_timeout(200)
    assert len(rig.session.log) == count


def test_the_pad_lets_go_when_the_page_is_left(page: Page, rig: WebRig) -> None:
    pad = page.locator("#pad").bounding_box()
    assert pad is not None
    page.mouse.move(pad["x"] + pad["width"] / 2, pad["y"] + pad["height"] / 2)
    page.mouse.down()
    page.mouse.move(pad["x"] + pad["width"] / 2, pad["y"] + 4)
    wait_until(lambda: any(one[0] == "steer" and one[1] > 0.2 for one in rig.session.log))
    page.evaluate("dispatchEvent(new Event('blur'))")
    rig.session.wait_for("steer", 0.0, 0.0, 0.0)


# --- map ---


def test_a_tap_on_the_floor_asks_for_the_way_there(page: Page, rig: WebRig) -> None:
    page.locator("#floor").click(position={"x": 300, "y": 300})
    wait_until(lambda: bool(rig.session.log))
    do, plan_text, _ = rig.session.log[0]
    assert do == "say_edited_plan"
    assert plan_text.startswith("go to ")
    assert "facing" not in plan_text


def test_a_drag_sets_the_heading_where_that_was_asked_for_and_moves_the_map_else(
    page: Page, rig: WebRig
) -> None:
    floor = page.locator("#floor").bounding_box()
    assert floor is not None
    x, y = floor["x"] + 250, floor["y"] + 300

    def drag() -> None:
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 30, y - 30, steps=3)
        page.mouse.up()

    drag()
    page.wait_for_timeout(100)
    assert rig.session.log == []
    page.get_by_role("button", name="Set heading").click()
    drag()
    wait_until(lambda: bool(rig.session.log))
    assert rig.session.log[0][1].endswith("facing 45 deg")


def test_the_map_can_be_used_with_keys_and_by_the_list_of_places(page: Page, rig: WebRig) -> None:
    page.get_by_role("application", name="Map").focus()
    for key in ("ArrowRight", "ArrowRight", "ArrowUp", "+", "Enter"):
        page.keyboard.press(key)
    wait_until(lambda: len(rig.session.log) == 1)
    page.locator("summary", has_text="Places").click()
    page.get_by_role("button", name="sofa").click()
    wait_until(lambda: len(rig.session.log) == 2)
    assert rig.session.log[1][1].startswith("go to -1.1 0")


# --- people ---


def test_two_tabs_one_steers_and_taking_over_is_shown_to_both(
    page: Page, rig: WebRig, browser: Browser
) -> None:
    second = open_page(browser, rig.origin)
    expect(page.locator("#steering-state")).to_have_text("You steer")
    expect(second.locator("#watching-banner")).to_contain_text("You watch; take over to steer.")
    expect(second.get_by_role("button", name="Send")).to_be_disabled()
    second.get_by_role("button", name="Take over").click()
    expect(second.locator("#steering-state")).to_have_text("You steer")
    expect(page.locator("#notice-banner")).to_contain_text("has taken over steering. You watch now.")
    expect(page.get_by_role("button", name="Take over")).to_be_visible()
    second.context.close()


def test_a_lost_connection_is_said_and_comes_back(page: Page, rig: WebRig) -> None:
    port, stop_port = rig.access.port, rig.access.stop_port
    rig.server.close()
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


# --- every screen, every language, every person ---


def test_a_browser_in_chinese_gets_a_chinese_page_that_can_be_switched(rig: WebRig, browser: Browser) -> None:
    page = open_page(browser, rig.origin, locale="zh-CN")
    expect(page.get_by_role("button", name="停止", exact=True)).to_be_visible()
    expect(page.get_by_role("button", name="急停", exact=True)).to_be_visible()
    assert page.locator("html").get_attribute("lang") == "zh-Hans"
    page.get_by_role("button", name="English").click()
    expect(page.get_by_role("button", name="Stop", exact=True)).to_be_visible()
    page.context.close()


@pytest.mark.parametrize("size", [PHONE, TABLET, (844, 390), (320, 640)])
def test_small_screens_hold_everything_and_always_the_stop(
    rig: WebRig, browser: Browser, size: tuple[int, int]
) -> None:
    page = open_page(browser, rig.origin, size)
    stop = page.get_by_role("button", name="Stop", exact=True)
    expect(stop).to_be_in_viewport(ratio=1)
    expect(page.get_by_role("button", name="Emergency stop", exact=True)).to_be_in_viewport(ratio=1)
    assert page.evaluate("document.documentElement.scrollWidth") <= size[0]
    if page.locator(".tabs").is_visible():
        page.get_by_role("button", name="Drive", exact=True).click()
        expect(page.locator("#pad")).to_be_in_viewport()
        expect(stop).to_be_in_viewport(ratio=1)
    page.context.close()


def test_the_keyboard_alone_gets_everywhere_and_every_focus_is_seen(page: Page, rig: WebRig) -> None:
    say(page, "drive half a metre")
    rehearse(rig)
    expect(page.get_by_role("button", name="Do it").first).to_be_visible()
    reached: list[str] = []
    for _ in range(60):
        page.keyboard.press("Tab")
        name, is_seen = page.evaluate(
            """() => {
              const element = document.activeElement;
              const style = getComputedStyle(element);
              return [element.id || element.textContent.trim() || element.tagName,
                      element === document.body || (style.outlineStyle !== "none" && parseFloat(style.outlineWidth) > 1)];
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


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize(("size", "locale"), [(DESKTOP, "en-GB"), (PHONE, "zh-CN")])
def test_axe_finds_nothing(
    rig: WebRig, browser: Browser, size: tuple[int, int], locale: str, dark: bool
) -> None:
    page = open_page(browser, rig.origin, size, dark=dark, locale=locale)
    page.locator("#say").fill("drive half a metre")
    page.keyboard.press("Enter")
    rig.session.wait_for("say", "drive half a metre")
    written(rig, "import rclpy\n")
    rig.tell(Result(1, "refused", "No."))
    rehearse(rig, 2)
    expect(page.locator("#turns .buttons button")).to_have_count(3)
    watcher = open_page(browser, rig.origin, size, dark=dark, locale=locale)
    for one in (page, watcher):
        found = Axe().run(one).response["violations"]
        assert [(rule["id"], [node["target"] for node in rule["nodes"]]) for rule in found] == []
    for tab in ("drive", "plan", "programs"):
        if page.locator(".tabs").is_visible():
            page.locator(f".tabs [data-tab={tab}]").click()
            found = Axe().run(page).response["violations"]
            assert [(rule["id"], [node["target"] for node in rule["nodes"]]) for rule in found] == []
    page.context.close()
    watcher.context.close()
