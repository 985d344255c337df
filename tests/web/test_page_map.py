"""Orders by the map, what is put on it and what it keeps, in a real browser; the session behind it only notes."""

from __future__ import annotations

import json
import re
from importlib import resources

import pytest
from playwright.sync_api import Browser, Page, expect

from chatrobot.core.events import Result, Telemetry
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.language.context import Context
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.plan.steps import Go
from chatrobot.robots.load import load_profile
from chatrobot.sim.shapes import Circle
from tests.processes import wait_until
from tests.web.browser import PHONE, browser, count_pixels, open_page, page, rehearse
from tests.web.rig import WebRig

__all__ = ["browser", "page"]
pytestmark = pytest.mark.realtime


@pytest.mark.parametrize("code", REPLY_LANGUAGES)
@pytest.mark.parametrize("heading", [None, -135])
def test_what_the_page_says_of_a_tap_means_the_same_point_when_it_is_typed(
    code: str, heading: int | None
) -> None:
    words = json.loads((resources.files("chatrobot.web") / "page" / f"words.{code}.json").read_text("utf-8"))
    text = words["go_point" if heading is None else "go_point_facing"]
    meant = OfflineInterpreter(load_profile("wheeltec_mini_mec")).interpret(
        text.format(x="0.67", y="-0.80", heading=heading), Context()
    )
    assert meant.plan is not None
    (step,) = meant.plan.steps
    assert isinstance(step, Go)
    assert (step.x_m, step.y_m) == (0.67, -0.8)
    assert (step.yaw_rad is None) == (heading is None)


def test_a_tap_is_told_to_a_centimetre_and_driven_to_that_very_point(page: Page, rig: WebRig) -> None:
    page.locator("#floor").click(position={"x": 300, "y": 333})
    told = page.locator("#turns .you")
    expect(told).to_have_text(re.compile(r"go to my point \(-?\d+\.\d\d, -?\d+\.\d\d\)"))
    said = [float(number) for number in re.findall(r"-?\d+\.\d\d", told.inner_text())]
    assert [float(number) for number in rig.session.log[0][1].split()[2:]] == said


def test_enter_on_the_map_proposes_and_enter_once_more_is_the_yes(page: Page, rig: WebRig) -> None:
    page.get_by_role("application", name="Map").focus()
    for key in ("ArrowRight", "Enter", "Enter"):  # it is not asked about yet
        page.keyboard.press(key)
    expect(page.locator("#turns .you")).to_have_count(1)
    rehearse(rig, 1)
    expect(page.locator("#turns").get_by_role("button", name="Do it")).to_be_visible()
    for key in ("ArrowRight", "Enter"):
        page.keyboard.press(key)
    expect(page.locator("#turns .you")).to_have_count(2)
    rehearse(rig, 2)
    rig.tell(Result(1, "stopped", "Stopped.", reason=Reason("replaced")))
    expect(page.locator("#turns > li").first).to_contain_text("Not done")  # so the page has heard all of it
    page.keyboard.press("Enter")
    rig.session.wait_for("approve", 2, True)
    assert [one[0] for one in rig.session.log] == ["say_edited_plan", "say_edited_plan", "approve"]


def test_what_a_person_put_there_has_a_colour_of_its_own(page: Page, rig: WebRig) -> None:
    assert count_pixels(page, "added") == 0
    rig.tell(ObstacleChanged(0, "Obstacle 1", Circle(1.0, 0.5, 0.2).outline()))
    wait_until(lambda: count_pixels(page, "added") > 50 and count_pixels(page, "added-edge") > 20)


def test_a_reload_keeps_the_trail_and_the_speed_of_the_stick(page: Page, rig: WebRig) -> None:
    for x_m in (0.0, 0.5, 1.0):
        rig.tell(Telemetry(0, Pose(x_m, 0.0, 0.0), Twist(), 0.0))
    wait_until(lambda: count_pixels(page, "driven") > 50)
    speed = page.locator("#stick-mps")
    expect(speed).to_have_text("0.30 m/s")
    page.locator("#stick-speed").press("ArrowRight")
    expect(speed).to_have_text("0.35 m/s")
    page.reload()
    expect(speed).to_have_text("0.35 m/s")
    wait_until(lambda: count_pixels(page, "driven") > 50)


def test_a_tool_that_is_switched_on_looks_so_under_the_mouse_too(page: Page, rig: WebRig) -> None:
    follow = page.get_by_role("button", name="Follow")
    follow.click()
    assert rig.session.log == []
    colours = [
        button.evaluate("(one) => getComputedStyle(one).backgroundColor")
        for button in (follow, page.get_by_role("button", name="Ask first"))
    ]
    assert colours[0] == colours[1]


@pytest.mark.parametrize("size", [PHONE, (320, 568), (740, 360)])
def test_the_tools_of_a_phone_are_one_row_and_what_is_shown_lies_below_it(
    browser: Browser, rig: WebRig, size: tuple[int, int]
) -> None:
    page = open_page(browser, rig.origin, size)
    floor, tools = page.locator("#floor").bounding_box(), page.locator("#map-tools").bounding_box()
    assert floor is not None
    assert tools is not None
    assert tools["height"] < 44
    walls = page.evaluate(
        """() => {
          const canvas = document.getElementById("canvas");
          const probe = document.createElement("canvas").getContext("2d");
          probe.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--map-wall");
          probe.fillRect(0, 0, 1, 1);
          const [red, green, blue] = probe.getImageData(0, 0, 1, 1).data;
          const { data, width } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          for (let at = 0; at < data.length; at += 4) {
            if (data[at] === red && data[at + 1] === green && data[at + 2] === blue) return at / 4 / width;
          }
        }"""
    )
    assert floor["y"] + walls > tools["y"] + tools["height"]
    page.locator("summary", has_text="Places").click()
    expect(page.get_by_role("button", name="sofa")).to_be_in_viewport()
    page.context.close()
