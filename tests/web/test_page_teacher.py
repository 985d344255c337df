"""The teacher's page in a real browser, beside a class that runs."""

from __future__ import annotations

import time

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.web.browser import browser, open_page
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


def test_a_teacher_who_looks_in_is_no_pupil_at_the_page(pupils: RunningClass, teacher: Page) -> None:
    looks = pupils.dial("/ws?room=2", pupils.token)
    expect(teacher.locator(".seat .who").nth(1)).to_have_text("Nobody is at the page · a teacher looks in")
    looks.socket.close()
    pupils.pupil(1)
    expect(teacher.locator(".seat .who").nth(1)).to_have_text("Pupil's page open: 1")


def test_what_a_card_says_and_asks_moves_no_button(pupils: RunningClass, teacher: Page) -> None:
    buttons = teacher.locator("main :is(button, a):visible")
    before = [one.bounding_box() for one in buttons.all()]
    one = pupils.pupil(0)
    one.say(
        "say", text="go to the moon, then to the kitchen of my aunt, and tell everybody there what you saw"
    )
    expect(teacher.locator(".seat .doing").first).not_to_be_empty()
    expect(teacher.locator(".seat .heard").first).to_contain_text("go to the moon")
    one.say("emergency_stop")
    teacher.get_by_role("button", name="New link: Pupil 3").click()
    expect(teacher.get_by_role("button", name="End the old link?: Pupil 3")).to_be_visible()
    expect(teacher.get_by_role("button", name="Release emergency stop: Pupil 1")).to_be_visible()
    after = [one.bounding_box() for one in buttons.all()]
    assert [box for box in before if box not in after] == []
    teacher.get_by_role("button", name="Release emergency stop: Pupil 1").click()
    expect(teacher.locator(".seat .chip").first).to_have_text("Standing")


def test_a_press_on_a_recording_that_is_listed_anew_meanwhile_counts(teacher: Page) -> None:
    teacher.get_by_text("Recordings of this class").click()
    button = teacher.get_by_role("button", name="Delete: Pupil 1")
    button.hover()
    teacher.mouse.down()
    with teacher.expect_response("**/recordings"):
        pass
    teacher.mouse.up()
    expect(teacher.get_by_role("button", name="Really delete?: Pupil 1")).to_be_focused()


def test_an_empty_task_is_not_handed_out_and_the_teacher_is_told(teacher: Page) -> None:
    teacher.get_by_label("Task for everybody").fill("  ")
    teacher.get_by_role("button", name="Hand out").click()
    expect(teacher.locator("#notice-banner")).to_have_text(
        "There is no task yet: write it, then hand it out."
    )


def test_a_link_is_copied_where_the_page_is_not_secure(pupils: RunningClass, teacher: Page) -> None:
    teacher.evaluate("Object.defineProperty(navigator, 'clipboard', {value: undefined})")
    teacher.get_by_role("button", name="Copy link: Pupil 2").click()
    expect(teacher.locator("#notice-banner")).to_have_text("The link of pupil 2 is copied.")
    teacher.get_by_label("Task for everybody").press("Control+V")
    expect(teacher.get_by_label("Task for everybody")).to_have_value(
        f"{pupils.origin}/#{pupils.pupils_tokens()[1]}"
    )


def test_at_the_end_of_a_lesson_a_button_goes_back_to_a_task(pupils: RunningClass, browsing: Browser) -> None:
    page = open_page(browsing, f"{pupils.origin}/#{pupils.pupils_tokens()[2]}")
    page.locator("#say").fill("/task 4")
    page.keyboard.press("Enter")
    expect(page.locator("#lesson-head")).to_contain_text("Task 4 of 4")
    page.get_by_role("button", name="Leave it out").click()
    page.get_by_role("button", name="Back to task 2").click()
    expect(page.locator("#lesson-head")).to_have_text("Task 2 of 4: Backwards")
    expect(page.get_by_role("button", name="Hint")).to_be_visible()


def test_a_command_of_the_terminal_is_answered_with_what_a_page_has_for_it(
    pupils: RunningClass, browsing: Browser
) -> None:
    page = open_page(browsing, f"{pupils.origin}/#{pupils.pupils_tokens()[0]}")
    for typed, answer in (("/obstacle add box 1 0", "press “Obstacle”"), ("/map", "does nothing here")):
        page.locator("#say").fill(typed)
        page.keyboard.press("Enter")
        expect(page.locator("#turns .line").last).to_contain_text(answer)


def test_a_pupil_reads_that_the_teacher_releases_an_emergency_stop(
    pupils: RunningClass, teacher: Page, browsing: Browser
) -> None:
    page = open_page(browsing, f"{pupils.origin}/#{pupils.pupils_tokens()[0]}")
    page.get_by_role("button", name="Emergency stop").click()
    expect(page.locator("#release-banner")).to_contain_text("nothing moves until your teacher releases it")
    expect(page.locator("#release")).to_be_hidden()
    teacher.get_by_role("button", name="Release emergency stop: Pupil 1").click()
    expect(page.locator("#release-banner")).to_be_hidden()
