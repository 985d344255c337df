"""`chatrobot web` with the simulated robot in real time, used through a real browser."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.processes import wait_until
from tests.web.browser import browser, count_pixels, open_page

__all__ = ["browser"]
pytestmark = pytest.mark.realtime
END_S = 10.0


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address that `chatrobot web` prints."""
    command = [sys.executable, "-m", "chatrobot", "web", "--port", "0", "--no-open", "--approve"]
    command += ["--world", "empty", "--config-dir", str(tmp_path_factory.mktemp("config"))]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            line = process.stdout.readline()
            found = re.search(r"http://\S+", line)
            assert found, line
            yield found[0]
        finally:
            process.terminate()
            process.wait(END_S)


@pytest.fixture(scope="module")
def page(browser: Browser, address: str) -> Iterator[Page]:
    opened = open_page(browser, address)
    yield opened
    opened.context.close()


def say(page: Page, text: str) -> None:
    page.get_by_label("Say something to the robot").fill(text)
    page.keyboard.press("Enter")


def last_reply(page: Page) -> str:
    return page.locator("#turns .robot .text").last.inner_text()


def test_a_sentence_is_rehearsed_on_the_map_approved_and_driven(page: Page) -> None:
    say(page, "go forward half a metre")
    do_it = page.get_by_role("log", name="What was said").get_by_role("button", name="Do it")
    expect(do_it).to_be_visible()
    wait_until(lambda: count_pixels(page, "rehearsed") > 20)
    do_it.click()
    expect(page.locator("#turns .robot").last).to_have_attribute("data-outcome", "completed")
    assert "0.50 m" in last_reply(page)
    wait_until(lambda: count_pixels(page, "driven") > 20)
    assert count_pixels(page, "rehearsed") == 0


def test_stop_ends_a_motion_in_its_middle(page: Page) -> None:
    say(page, "turn left three times")
    page.get_by_role("log", name="What was said").get_by_role("button", name="Do it").click()
    expect(page.locator("#robot-state")).to_have_text("Moving")
    page.get_by_role("button", name="Stop", exact=True).click()
    expect(page.locator("#turns .robot").last).to_have_attribute("data-outcome", "stopped")
    expect(page.locator("#robot-state")).to_have_text("Standing")


def test_a_held_key_moves_the_robot_and_its_release_stops_it(page: Page) -> None:
    page.get_by_role("application", name="Map").focus()
    before = count_pixels(page, "driven")
    page.keyboard.down("s")
    expect(page.locator("#robot-state")).to_have_text("Moving")
    wait_until(lambda: count_pixels(page, "driven") > before + 10)
    page.keyboard.up("s")
    expect(page.locator("#robot-state")).to_have_text("Standing")


def test_a_tap_on_the_floor_is_rehearsed_and_can_be_cancelled(page: Page) -> None:
    page.locator("#floor").click(position={"x": 230, "y": 330})
    cancel = page.get_by_role("log", name="What was said").get_by_role("button", name="Cancel")
    expect(cancel).to_be_visible()
    cancel.click()
    expect(page.locator("#turns .robot").last).to_have_attribute("data-outcome", "refused")
    expect(page.locator("#robot-state")).to_have_text("Standing")


def test_a_typed_yes_does_the_plan_that_waits(page: Page) -> None:
    say(page, "turn left 20 degrees")
    expect(page.get_by_role("log", name="What was said").get_by_role("button", name="Do it")).to_be_visible()
    say(page, "okay, go")
    wait_until(lambda: "20.0°" in page.locator("#turns").inner_text())
    expect(page.locator("#robot-state")).to_have_text("Standing")


def test_a_question_leaves_a_paused_plan_paused(page: Page) -> None:
    say(page, "turn left three times")
    page.get_by_role("log", name="What was said").get_by_role("button", name="Do it").click()
    expect(page.locator("#robot-state")).to_have_text("Moving")
    page.get_by_role("button", name="Pause").click()
    expect(page.locator("#robot-state")).to_have_text("Paused")
    say(page, "where are you?")
    expect(page.locator("#turns .robot").last).to_have_attribute("data-outcome", "answered")
    expect(page.locator("#robot-state")).to_have_text("Paused")
    expect(page.get_by_role("button", name="Go on")).to_be_visible()
    page.get_by_role("button", name="Stop", exact=True).click()
    expect(page.get_by_role("button", name="Go on")).to_be_hidden()


def test_a_place_that_is_remembered_is_in_the_list_at_once(page: Page) -> None:
    say(page, "remember this place as corner")
    expect(page.locator("#places")).to_contain_text("corner")
