"""Stop, stick and map of the page, in a real browser; the session behind the real server only notes."""

from __future__ import annotations

import json
import math

import pytest
from playwright.sync_api import Browser, Page, expect

from chatrobot.core.events import Paused, Result, Started, Telemetry
from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.sim.shapes import Circle
from chatrobot.web.words import told
from tests.processes import wait_until
from tests.web.browser import DESKTOP, PHONE, browser, count_pixels, open_page, page, rehearse
from tests.web.rig import WebRig

__all__ = ["browser", "page"]
pytestmark = pytest.mark.realtime


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


def test_a_key_on_the_stop_button_stops_after_a_finger_slid_off_it(page: Page, rig: WebRig) -> None:
    button = page.get_by_role("button", name="Stop", exact=True)
    button.hover()
    page.mouse.down()
    page.mouse.move(400, 300)
    page.mouse.up()
    wait_until(lambda: len(rig.session.log) == 2)
    button.press("Enter")
    wait_until(lambda: len(rig.session.log) == 4)


@pytest.mark.parametrize(
    ("size", "locale"),
    [
        ((320, 568), "de-AT"),
        ((390, 844), "en-GB"),
        ((568, 320), "de-AT"),
        ((768, 1024), "en-GB"),
        (DESKTOP, "zh-CN"),
    ],
)
def test_stop_stays_where_it_is_and_hammering_on_it_releases_nothing(
    browser: Browser, rig: WebRig, size: tuple[int, int], locale: str
) -> None:
    page = open_page(browser, rig.origin, size, locale=locale)
    stop, emergency, release = (page.locator(one) for one in ("#stop", "#emergency", "#release"))
    box, other_box = stop.bounding_box(), emergency.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    for press in (stop.click, lambda: rig.tell(Paused(1, ORIGIN, "drive 1 m")), emergency.click):
        press()
        page.wait_for_timeout(100)
        assert (stop.bounding_box(), emergency.bounding_box()) == (box, other_box)
    expect(release).to_be_visible()
    expect(release).to_be_disabled()
    for _ in range(3):
        page.mouse.click(x, y)
    expect(release).to_be_enabled()
    page.mouse.click(x, y)
    page.wait_for_timeout(100)
    assert ("release",) not in rig.session.log
    assert page.evaluate("([x, y]) => document.elementFromPoint(x, y).closest('button').id", [x, y]) == "stop"
    page.context.close()


def test_an_emergency_stop_is_its_own_button_and_is_released_by_another(page: Page, rig: WebRig) -> None:
    release = page.get_by_role("button", name="Release emergency stop")
    expect(release).to_be_hidden()
    page.get_by_role("button", name="Emergency stop", exact=True).click()
    rig.session.wait_for("emergency_stop", "the Emergency stop button")
    expect(page.locator("#robot-state")).to_have_text("Emergency stop")
    release.click()
    rig.session.wait_for("release")


def test_a_key_drives_while_it_is_held_and_lets_go_once(browser: Browser, rig: WebRig) -> None:
    sent: list[str] = []
    page = open_page(browser, rig.origin, sent=sent)
    page.evaluate("document.activeElement.blur()")
    page.keyboard.down("w")
    wait_until(lambda: sum(one[0] == "steer" and one[1] > 0 for one in rig.session.log) >= 3)
    page.keyboard.up("w")
    page.wait_for_timeout(200)
    steers = [json.loads(one) for one in sent if '"steer"' in one]
    assert all(one["vx_mps"] > 0 for one in steers[:-1])
    assert steers[-1] == {"do": "steer", "vx_mps": 0, "vy_mps": 0, "wz_radps": 0}
    page.context.close()


def test_keys_drive_from_the_map_and_not_from_menus_buttons_lists_or_after_send(
    page: Page, rig: WebRig
) -> None:
    summary = page.locator("summary", has_text="Places")
    summary.focus()
    page.keyboard.press("Enter")
    for key in ("ArrowDown", "ArrowDown", "ArrowUp", "s"):
        page.keyboard.press(key, delay=60)
    expect(page.locator("#places button").first).to_be_focused()
    page.keyboard.press("Escape")
    rig.session.wait_for("stop", "the Stop button")
    expect(page.locator("#places-menu")).not_to_have_attribute("open", "")
    expect(summary).to_be_focused()
    for element in ("#follow", "#talk", "#plan-edit"):
        page.locator(element).focus()
        page.keyboard.press("w", delay=60)
    page.locator("#say").fill("forward 1 m")
    page.get_by_role("button", name="Send").click()
    page.keyboard.type("was", delay=60)
    expect(page.locator("#say")).to_have_value("was")
    assert not any(one[0] == "steer" for one in rig.session.log)
    page.get_by_role("button", name="Zoom in").click()
    page.keyboard.press("w", delay=100)
    wait_until(lambda: any(one[0] == "steer" and one[1] > 0 for one in rig.session.log))


def test_a_key_that_is_held_and_moves_nothing_is_told_to_be_let_go(page: Page, rig: WebRig) -> None:
    page.evaluate("document.activeElement.blur()")
    with rig.telling(Telemetry(0, ORIGIN, Twist(), 0.0)):
        page.keyboard.down("s")
        expect(page.locator("#limited")).to_have_text(
            "The robot does not move. After a stop let go first, then hold again."
        )
        page.keyboard.up("s")
    expect(page.locator("#limited")).to_be_empty()


def test_a_robot_that_stands_far_off_when_the_page_is_loaded_is_on_the_map(page: Page, rig: WebRig) -> None:
    floor = page.locator("#floor").bounding_box()
    assert floor is not None
    with rig.telling(Telemetry(0, Pose(30.0, 5.0, 0.0), Twist(), 0.0)):
        wait_until(lambda: count_pixels(page, "robot") > 20)
        page.mouse.move(floor["x"] + 200, floor["y"] + 300)
        page.mouse.down()
        page.mouse.move(floor["x"] - 900, floor["y"] + 300, steps=3)
        page.mouse.up()
        page.wait_for_timeout(500)
        assert count_pixels(page, "robot") == 0, "a person moved the map, and it stays"


@pytest.mark.parametrize("event", ["blur", "contextmenu", "pagehide"])
def test_the_pad_lets_go_when_the_page_is_left(page: Page, rig: WebRig, event: str) -> None:
    pad = page.locator("#pad").bounding_box()
    assert pad is not None
    page.mouse.move(pad["x"] + pad["width"] / 2, pad["y"] + pad["height"] / 2)
    page.mouse.down()
    page.mouse.move(pad["x"] + pad["width"] / 2, pad["y"] + 4)
    wait_until(lambda: any(one[0] == "steer" and one[1] > 0.2 for one in rig.session.log))
    page.evaluate("(name) => dispatchEvent(new Event(name))", event)
    rig.session.wait_for("steer", 0.0, 0.0, 0.0)


# --- map ---


def test_a_tap_on_the_floor_asks_for_the_way_there(page: Page, rig: WebRig) -> None:
    page.locator("#floor").click(position={"x": 300, "y": 300})
    wait_until(lambda: bool(rig.session.log))
    do, plan_text, _ = rig.session.log[0]
    assert do == "say_edited_plan"
    assert plan_text.startswith("go to ")
    assert "facing" not in plan_text


@pytest.mark.parametrize("size", [PHONE, (640, 360), (320, 568)])
def test_on_a_phone_the_question_about_a_tap_is_seen_whatever_panel_or_lesson_was(
    browser: Browser, rig: WebRig, size: tuple[int, int]
) -> None:
    page = open_page(browser, rig.origin, size)
    lines = [f"Line {number} of the task." for number in range(6)]
    rig.room.pin("lesson", told("lesson", over=False, head="Task 1", lines=lines, about=[]))
    page.locator(".tabs [data-tab=drive]").click()
    page.locator("#floor").click(position={"x": 200, "y": 110})
    wait_until(lambda: bool(rig.session.log))
    rehearse(rig)
    do_it = page.get_by_role("log", name="What was said").get_by_role("button", name="Do it")
    expect(do_it).to_be_in_viewport(ratio=1)
    page.locator(".tabs [data-tab=plan]").click()
    expect(page.locator(".asks .tabs [data-tab=chat]")).to_have_text("Chat")
    page.locator("#plan-run").click()
    rig.session.wait_for("approve", 1, True)
    rig.tell(Started(1))
    expect(page.locator(".asks .tabs [data-tab=chat]")).to_have_count(0)
    page.locator(".tabs [data-tab=chat]").click()
    rig.tell(Result(1, "completed", "Done: go to."))
    expect(page.get_by_text("Done: go to.")).to_be_in_viewport(ratio=1)
    page.context.close()


def _metres_across(page: Page, rig: WebRig) -> float:
    """How far apart the points of the floor lie at a fifth and four fifths of the map's width."""
    floor = page.locator("#floor").bounding_box()
    assert floor is not None
    asked = []
    for share in (0.2, 0.8):
        rig.session.log.clear()
        page.mouse.click(floor["x"] + share * floor["width"], floor["y"] + floor["height"] / 2)
        wait_until(lambda: bool(rig.session.log))
        asked.append([float(number) for number in rig.session.log[0][1].split()[2:4]])
    return math.dist(*asked)


def test_the_map_shows_all_in_a_window_of_another_size_until_it_is_moved(page: Page, rig: WebRig) -> None:
    across_m = _metres_across(page, rig)
    page.set_viewport_size({"width": 900, "height": 420})
    wait_until(
        lambda: _metres_across(page, rig) > 1.5 * across_m
    )  # it is lower now, so the same scale is not enough
    page.mouse.move(400, 250)
    page.mouse.wheel(0, -400)
    page.wait_for_timeout(100)
    zoomed_m = _metres_across(page, rig)
    page.set_viewport_size({"width": 890, "height": 420})
    page.wait_for_timeout(200)
    assert _metres_across(page, rig) == pytest.approx(zoomed_m, rel=0.1)


def test_the_heading_is_told_without_whole_turns(page: Page, rig: WebRig) -> None:
    def summary() -> str:
        rig.tell(Telemetry(0, Pose(0.0, 0.0, math.radians(432.0)), Twist(), 0.0))
        return page.locator("#map-summary").text_content() or ""

    wait_until(lambda: "heading 72 degrees" in summary())


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
    assert rig.session.log[1][1].endswith('named "sofa"')
    expect(page.locator("#turns .you").last).to_have_text("go to the sofa")


def test_an_obstacle_is_put_dragged_and_taken_away_by_whoever_steers(page: Page, rig: WebRig) -> None:
    floor, button = page.locator("#floor"), page.get_by_role("button", name="Obstacle")
    button.click()
    floor.click(position={"x": 300, "y": 300})
    wait_until(lambda: bool(rig.session.log))
    (_, put), *_ = rig.session.log
    x, y, radius = put["circle"]
    assert (put["add"], radius) == ("Obstacle 1", 0.2)
    expect(button).to_have_attribute("aria-pressed", "true")
    rig.tell(ObstacleChanged(0, "Obstacle 1", Circle(x, y, radius).outline()))
    box = floor.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 300, box["y"] + 300)
    page.wait_for_timeout(100)
    page.mouse.down()
    page.mouse.move(box["x"] + 340, box["y"] + 300, steps=4)
    page.mouse.up()
    wait_until(lambda: len(rig.session.log) == 2)
    _, moved = rig.session.log[1]
    assert moved["add"] == "Obstacle 1"
    assert moved["circle"][0] > x + 0.1
    assert moved["circle"][1:] == pytest.approx([y, radius], abs=0.01)
    floor.click(position={"x": 300, "y": 300})
    wait_until(lambda: len(rig.session.log) == 3)
    assert rig.session.log[2] == ("obstacle", {"remove": "Obstacle 1"})
    button.click()
    page.mouse.move(box["x"] + 300, box["y"] + 300)
    page.mouse.down()
    page.mouse.move(box["x"] + 340, box["y"] + 300, steps=4)
    page.mouse.up()
    floor.click(position={"x": 340, "y": 300})
    wait_until(lambda: len(rig.session.log) == 4)
    assert rig.session.log[3][0] == "say_edited_plan", "a drag moves the map again, and a tap sends the robot"
    button.click()
    page.get_by_role("button", name="Set heading").click()
    expect(button).to_have_attribute("aria-pressed", "false")
    button.click()
    page.keyboard.press("Escape")
    expect(button).to_have_attribute("aria-pressed", "false")


def test_who_only_watches_puts_no_obstacle_there(rig: WebRig) -> None:
    rig.page().say("take")
    watcher = rig.page()
    watcher.say("obstacle", name="box", x_m=1.0, y_m=0.0)
    assert watcher.wait_for("refused")["do"] == "obstacle"
    assert rig.session.log == []


@pytest.mark.parametrize("locale", ["en-GB", "de-DE", "zh-CN"])
def test_no_button_of_the_dock_lies_over_another_or_is_too_thin_for_a_finger(
    browser: Browser, rig: WebRig, locale: str
) -> None:
    page = open_page(browser, rig.origin, PHONE, locale=locale)
    boxes = [page.locator(button).bounding_box() for button in ("#stop", "#pause", "#emergency")]
    edges = [(box["x"], box["x"] + box["width"]) for box in boxes if box is not None]
    assert [at for pair in edges for at in pair] == sorted(at for pair in edges for at in pair)
    assert all(end - begin >= 40 for begin, end in edges)
    page.context.close()
