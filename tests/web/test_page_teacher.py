"""The teacher's page in a real browser, beside a class that runs."""

from __future__ import annotations

import time

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.web.browser import browser
from tests.web.class_rig import RunningClass, browsing, drive, pupils, shared

__all__ = ["browser", "browsing", "pupils", "shared"]
pytestmark = pytest.mark.realtime


@pytest.fixture
def teacher(pupils: RunningClass, browsing: Browser) -> Page:
    page = browsing.new_page(locale="en-GB")
    page.goto(f"{pupils.origin}/teacher#{pupils.token}")
    expect(page.locator("#robots li")).to_have_count(3)
    return page


@pytest.mark.parametrize("key", ["Space", "Escape"])
def test_the_open_list_of_tasks_keeps_no_stop_from_the_robots(
    pupils: RunningClass, teacher: Page, key: str
) -> None:
    drive(pupils, 0)
    teacher.locator("#lesson-task").press("Enter")
    teacher.get_by_role("button", name="3 ", exact=False).first.focus()
    said_s = time.monotonic()
    teacher.keyboard.press(key)
    pupils.heard[0].wait_for_zero(said_s)


def test_the_task_that_was_chosen_is_where_all_are_moved(teacher: Page) -> None:
    teacher.locator("#lesson-task").press("Enter")
    teacher.locator("#lesson-tasks").get_by_role("button", name="3 ", exact=False).first.press("Enter")
    expect(teacher.locator("#lesson-task")).to_be_focused()
    teacher.get_by_role("button", name="Move", exact=True).click()
    expect(teacher.locator(".seat .lesson").first).to_contain_text("Task 3 of 4")
