"""Chat, plan, gauges and programs of the page, in a real browser; the session behind the real server only notes."""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser, Page, expect

from chatrobot.core.event import Proposal
from chatrobot.core.events import (
    FindingSeen,
    Finished,
    Interpreted,
    Limited,
    Notice,
    Ordered,
    Paused,
    ProgramLog,
    ProgramWritten,
    Progress,
    Rehearsed,
    Remembered,
    Result,
    Started,
    Telemetry,
)
from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.language.context import Place
from chatrobot.link.motion_link import TURNS
from tests.processes import wait_until
from tests.web.browser import PLAN, browser, count_pixels, open_page, page, rehearse, say, write_program
from tests.web.rig import WebRig

__all__ = ["browser", "page"]
pytestmark = pytest.mark.realtime
EVIL = '<img src=x onerror="document.title=1"><b id="evil">&amp;</b>'

# --- chat ---


def test_a_plan_that_waits_is_answered_by_a_button(page: Page, rig: WebRig) -> None:
    say(page, rig, "drive half a metre")
    rehearse(rig)
    chat = page.get_by_role("log", name="What was said")
    expect(chat).to_contain_text("Rehearsed: 0.95 m in 8 s.")
    wait_until(lambda: count_pixels(page, "rehearsed") > 50)
    chat.get_by_role("button", name="Do it").click()
    rig.session.wait_for("approve", 1, True)
    expect(chat.get_by_role("button")).to_have_count(0)


def test_what_rehearsal_found_is_said(page: Page, rig: WebRig) -> None:
    say(page, rig, "drive ten metres")
    found = FindingSeen(1, "warn", Reason("leaves_area", {"distance_m": 5.0, "total_m": 10.0}))
    rig.tell(Rehearsed(1, True, 30.0, 10.0, ORIGIN, findings=(found,), needs_approval=True))
    expect(page.get_by_role("log", name="What was said")).to_contain_text("leave the allowed area")


def test_an_edited_plan_goes_in_the_place_of_the_one_that_waits(page: Page, rig: WebRig) -> None:
    say(page, rig, "drive half a metre")
    rehearse(rig)
    page.get_by_role("log", name="What was said").get_by_role("button", name="Edit").click()
    page.get_by_label("The plan, one step a line").fill("drive 0.2 m")
    page.get_by_role("button", name="Rehearse and run").click()
    rig.session.wait_for("say_edited_plan", "drive 0.2 m", PLAN)


def test_a_plan_that_cannot_be_read_can_be_mended(page: Page, rig: WebRig) -> None:
    page.get_by_role("button", name="Write a plan").click()
    page.locator("#plan-run").click()
    expect(page.locator("#notice-banner")).to_contain_text("The plan is empty")
    page.get_by_label("The plan, one step a line").fill("turn left 90 deg\nfly 3 m")
    page.get_by_role("button", name="Rehearse and run").click()
    rig.session.wait_for("say_plan", "turn left 90 deg\nfly 3 m")
    rig.tell(Result(1, "unclear", "This plan cannot be read."))
    expect(page.locator("#plan-about")).to_have_text("This plan was not understood, and nothing was done.")
    page.locator("#plan-edit").click()
    expect(page.get_by_label("The plan, one step a line")).to_have_value("turn left 90 deg\nfly 3 m")


def test_an_edit_that_cannot_be_read_stays_open_and_the_version_before_waits(page: Page, rig: WebRig) -> None:
    say(page, rig, "drive half a metre")
    rehearse(rig)
    page.get_by_role("log", name="What was said").get_by_role("button", name="Edit").click()
    editor = page.get_by_label("The plan, one step a line")
    editor.fill("drive 0.2 m\nfly 3 m")
    page.get_by_role("button", name="Rehearse and run").click()
    rig.session.wait_for("say_edited_plan", "drive 0.2 m\nfly 3 m", PLAN)
    rig.tell(Notice(2, Reason("edit_unreadable", {"problem": "line 2: 'fly 3 m'"})))
    rig.tell(Interpreted(2, "offline", PLAN, ""))
    rig.tell(Rehearsed(2, True, 8.0, 0.95, ORIGIN, needs_approval=True))
    expect(editor).to_have_value("drive 0.2 m\nfly 3 m")
    editor.fill("drive 0.2 m")
    page.get_by_role("button", name="Rehearse and run").click()
    rig.session.wait_for("say_edited_plan", "drive 0.2 m", PLAN)
    rig.tell(Interpreted(3, "offline", "drive 0.2 m", ""))
    rig.tell(Notice(4, Reason("edit_unreadable", {"problem": "another person's"})))
    rig.tell(Interpreted(5, "offline", "wait 1 s\nwait 2 s", ""))
    expect(page.locator("#plan-lines li")).to_have_count(2)  # so the page has heard what came before it
    expect(editor).to_be_hidden()


def test_what_an_agent_asks_for_is_seen_before_the_yes_and_its_end_after(page: Page, rig: WebRig) -> None:
    turn = TURNS + 3
    rig.tell(Ordered(turn, "agent", PLAN))
    rig.tell(Rehearsed(turn, True, 8.0, 0.95, ORIGIN, needs_approval=True))
    chat = page.get_by_role("log", name="What was said")
    expect(chat.get_by_text("the agent wants to do this:")).to_be_visible()
    expect(chat).to_contain_text("repeat 2")
    expect(page.locator("#plan-lines li")).to_have_count(len(PLAN.splitlines()))
    expect(page.locator("#plan-about")).to_have_text("Waits for your yes.")
    rig.tell(
        Finished(
            turn,
            "refused",
            Reason("approval_too_late", {"limit_s": 30.0}),
            ORIGIN,
            ORIGIN,
            0.0,
            0.0,
            0.0,
            0.0,
        )
    )
    expect(chat).to_contain_text("No yes came within 30 s")
    expect(chat.get_by_role("button")).to_have_count(0)
    expect(page.locator("#plan-about")).to_have_text("The last plan. It was not done.")


def test_a_question_is_answered_by_yes_or_no(page: Page, rig: WebRig) -> None:
    say(page, rig, "forwrd 1 m")
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
    say(page, rig, "turn")
    rig.tell(Result(1, "unclear", question))
    chat = page.get_by_role("log", name="What was said")
    expect(chat).to_contain_text(question)
    assert chat.get_by_role("button").all_inner_texts() == answers


def test_what_was_said_before_comes_back_with_arrow_up(page: Page, rig: WebRig) -> None:
    for turn, text in enumerate(("forward 1 m", "turn left"), start=1):
        say(page, rig, text)
        rig.tell(Result(turn, "completed", "Done."))
    box = page.get_by_label("Say something to the robot")
    box.press("ArrowUp")
    box.press("ArrowUp")
    expect(box).to_have_value("forward 1 m")
    box.press("ArrowDown")
    expect(box).to_have_value("turn left")


def test_a_text_that_is_too_long_is_said_and_stays_in_the_box(page: Page, rig: WebRig) -> None:
    box = page.get_by_label("Say something to the robot")
    box.fill("forward " * 600)
    box.press("Enter")
    expect(page.locator("#notice-banner")).to_contain_text("That is too long: 4799 characters")
    expect(box).to_have_value("forward " * 600)
    assert not rig.session.log


def test_a_page_that_comes_later_sees_what_was_said(page: Page, rig: WebRig, browser: Browser) -> None:
    say(page, rig, "forward 1 m")
    rig.tell(Result(1, "completed", "Done: drove 1.00 m."))
    later = open_page(browser, rig.origin)
    expect(later.get_by_role("log", name="What was said")).to_contain_text("Done: drove 1.00 m.")
    later.context.close()


def test_how_a_turn_ended_is_told_below_what_was_said_meanwhile(page: Page, rig: WebRig) -> None:
    say(page, rig, "forward 1 m")
    rig.tell(Interpreted(1, "offline", "drive 1 m", "drive forward 1 m"))
    say(page, rig, "my cat is called Tom")
    rig.tell(Result(2, "unclear", "I found no motion in that."))
    rig.tell(Result(1, "completed", "Done: drove 1.00 m."))
    expect(page.locator("#turns > li").last).to_contain_text("Done: drove 1.00 m.")
    expect(page.locator("#turns > li", has_text="drive forward 1 m")).to_have_count(1)


def test_ones_own_texts_stay_ones_own_when_the_page_is_loaded_again(
    page: Page, rig: WebRig, browser: Browser
) -> None:
    say(page, rig, "forward 1 m")
    page.reload()
    mine = page.locator("#turns .you", has_text="forward 1 m")
    expect(mine).to_have_text("forward 1 m")
    other = open_page(browser, rig.origin)
    expect(other.locator("#turns .you .who")).to_have_count(1)
    other.context.close()


def test_what_one_says_is_seen_after_scrolling_up_and_what_others_say_is_told_by_a_button(
    page: Page, rig: WebRig
) -> None:
    for number in range(1, 9):
        say(page, rig, f"drive {number} m")
        rig.tell(Result(number, "refused", f"No, not {number} m."))
    scroll_up = "document.getElementById('talk').scrollTop = 0"
    newest = page.get_by_role("button", name="New messages")
    page.evaluate(scroll_up)
    page.wait_for_timeout(100)
    say(page, rig, "turn left")
    rehearse(rig, 9)
    expect(page.locator("#turns").get_by_role("button", name="Do it")).to_be_in_viewport(ratio=1)
    expect(newest).to_be_hidden()
    page.evaluate(scroll_up)
    page.wait_for_timeout(100)
    rig.room.note_said(10, "turn right", "page-0", "Somebody")
    rig.tell(Result(10, "refused", "No, not right."))
    expect(page.get_by_text("No, not right.")).not_to_be_in_viewport()
    newest.click()
    expect(page.get_by_text("No, not right.")).to_be_in_viewport()
    expect(newest).to_be_hidden()


def test_a_proposal_that_something_newer_replaces_warns_of_nothing(page: Page, rig: WebRig) -> None:
    why = Reason("replaced")
    for turn in (1, 2):
        say(page, rig, f"drive {turn} m")
        rehearse(rig, turn)
    rig.tell(Result(1, "stopped", "Stopped (new instruction). So far: nothing moved.", reason=why))
    first = page.locator("#turns > li", has_text="drive 1 m").locator(".robot")
    expect(first).to_have_text("Not done: something newer took its place.", use_inner_text=True)
    expect(first).to_have_attribute("data-outcome", "understood")
    rig.tell(Started(2))
    rig.tell(Result(2, "stopped", "Stopped (new instruction). So far: drove 0.20 m.", reason=why))
    expect(page.locator("#turns .robot").last).to_have_attribute("data-outcome", "stopped")


def test_an_emergency_stop_stands_once_in_the_chat_of_every_tab(
    page: Page, rig: WebRig, browser: Browser
) -> None:
    other = open_page(browser, rig.origin)
    for _ in range(2):
        page.get_by_role("button", name="Emergency stop", exact=True).click()
    rig.tell(Notice(0, Reason("released", {"source": "joystick"})))
    for one in (page, other):
        told = one.locator("#turns .line", has_text="emergency stop")
        expect(told).to_have_count(2)
        expect(told.first).to_contain_text("The emergency stop is set (by console).")
        expect(told.first).to_contain_text("“Release emergency stop” at the top of the page")
    other.context.close()


# --- plan, gauges, programs ---


def test_the_running_step_is_marked(page: Page, rig: WebRig) -> None:
    say(page, rig, "drive half a metre")
    rehearse(rig)
    rig.tell(Started(1))
    rig.tell(Progress(1, 2, 3, 0.4, ORIGIN, Twist(0.1, 0.0, 0.0)))
    marked = page.locator("#plan-lines [aria-current=step]")
    expect(marked).to_have_text(["repeat 2", "  turn left 90 deg", "end"], use_inner_text=True)


def test_a_paused_plan_is_told_as_that_and_a_pause_of_nothing_too(page: Page, rig: WebRig) -> None:
    page.get_by_role("button", name="Pause").click()
    expect(page.locator("#notice-banner")).to_have_text("Nothing moves that could be paused.")
    say(page, rig, "drive half a metre")
    rehearse(rig)
    rig.tell(Started(1))
    rig.tell(Paused(1, ORIGIN, "drive 0.2 m"))
    expect(page.locator("#plan-about")).to_have_text("Paused.")
    rig.tell(Started(1))
    expect(page.locator("#plan-about")).to_have_text("Runs now.")


def test_a_plan_that_was_stopped_shows_how_far_it_came(page: Page, rig: WebRig) -> None:
    say(page, rig, "drive half a metre")
    rehearse(rig)
    rig.tell(Started(1))
    rig.tell(Progress(1, 2, 3, 0.4, ORIGIN, Twist(0.1, 0.0, 0.0)))
    rig.tell(Result(1, "stopped", "Stopped."))
    expect(page.locator("#plan-about")).to_have_text("The last plan. It was stopped.")
    expect(page.locator("#plan-lines .done")).to_have_text(["drive 0.5 m"])
    expect(page.locator("#plan-lines .left")).to_have_count(3)
    expect(page.locator("#plan-lines [aria-current]")).to_have_count(0)


def test_how_fast_it_is_stays_in_sight_below_a_long_program(page: Page, rig: WebRig) -> None:
    say(page, rig, "write a program")
    write_program(rig, "print(1)\n" * 40)
    expect(page.locator("#program-source li")).to_have_count(40)
    page.evaluate("document.querySelector('.side').scrollTop = 9999")
    expect(page.locator("#program-run")).to_be_in_viewport()
    expect(page.locator("#gauge-speed")).to_be_in_viewport(ratio=1)


def test_a_german_page_writes_decimals_with_a_comma(rig: WebRig, browser: Browser) -> None:
    page = open_page(browser, rig.origin, locale="de-DE")
    rehearse(rig)
    rig.tell(Limited(1, "obstacle", Twist(0.5, 0.0, 0.0), Twist(0.2, 0.0, 0.0)))
    with rig.telling(Telemetry(0, ORIGIN, Twist(0.25, 0.0, 0.0), 1.0)):
        expect(page.locator("#gauge-speed b")).to_have_text("0,25 von 1,00 m/s")
    expect(page.locator("#turns")).to_contain_text("0,95 m")
    expect(page.locator("#limited")).to_contain_text("0,50 m/s")
    page.context.close()


def test_a_plan_is_shown_rounded_and_edited_as_it_is(page: Page, rig: WebRig) -> None:
    say(page, rig, "go to the lab")
    exact = 'go to 4.3 1.5000000000000002 named "lab 1.23456"'
    rig.tell(Interpreted(1, "offline", exact, "go to lab"))
    expect(page.locator("#plan-lines")).to_have_text('go to 4.3 1.5 named "lab 1.23456"')
    page.locator("#plan-edit").click()
    expect(page.get_by_label("The plan, one step a line")).to_have_value(exact)


def test_gauges_say_how_fast_how_near_and_what_is_limited(page: Page, rig: WebRig) -> None:
    moving = Telemetry(0, ORIGIN, Twist(0.25, 0.0, 0.5), 1.0, battery_percent=63.0, nearest_obstacle_m=0.42)
    now = page.get_by_role("region", name="Now")
    with rig.telling(moving):
        expect(now.get_by_role("meter", name="Speed", exact=True)).to_have_attribute("aria-valuenow", "0.25")
        for text in ("0.25 of 1.00 m/s", "29 of 115 °/s", "0.42 m", "63 %"):
            expect(now).to_contain_text(text)
    rig.tell(Limited(1, "obstacle", Twist(0.5, 0.0, 0.0), Twist(0.2, 0.0, 0.0)))
    expect(page.locator("#limited")).to_contain_text("0.20")


def test_a_program_is_shown_with_its_log(page: Page, rig: WebRig) -> None:
    say(page, rig, "write a program")
    write_program(rig, "import rclpy\nprint('hello')\n")
    rig.tell(Started(1))
    rig.tell(ProgramLog(1, 0.5, "INFO", "hello there"))
    programs = page.get_by_role("region", name="Programs")
    expect(programs.locator("#program-source li")).to_have_text(["import rclpy", "print('hello')"])
    expect(programs.get_by_role("log", name="Log")).to_contain_text("0.5 s hello there")


def test_what_was_typed_into_a_program_stays_until_rehearsal_takes_it(page: Page, rig: WebRig) -> None:
    editor, save = page.locator("#program-text"), page.get_by_role("button", name="Save and rehearse")
    say(page, rig, "write a program")
    write_program(rig, "print(1)\n")
    rig.tell(Rehearsed(1, True, 8.0, 0.95, ORIGIN, needs_approval=True))
    page.get_by_role("log", name="What was said").get_by_role("button", name="Edit").click()
    expect(page.get_by_label("The plan, one step a line")).to_be_hidden()
    editor.fill(" ")
    save.click()
    expect(page.locator("#notice-banner")).to_contain_text("The program is empty")
    editor.fill("print(2")
    save.click()
    rig.session.wait_for("say_source", "square", "print(2")
    write_program(rig, "print(1)\n", 2)  # the version before it is asked about
    rig.tell(Rehearsed(2, True, 8.0, 0.95, ORIGIN, needs_approval=True))
    expect(editor).to_have_value("print(2")
    rig.tell(ProgramWritten(3, "another", "offline", "pass\n", ""))
    expect(page.locator("#program-name")).to_have_text("another")
    expect(editor).to_be_hidden()
    write_program(rig, "print(1)\n", 4)
    expect(editor).to_have_value("print(2")
    for turn, ok in ((5, False), (6, True)):
        editor.fill(f"print({turn})")
        save.click()
        rig.session.wait_for("say_source", "square", f"print({turn})")
        write_program(rig, f"print({turn})", turn)
        rig.tell(Rehearsed(turn, ok, 8.0, 0.95, ORIGIN, needs_approval=ok))
        rig.tell(Result(turn, "refused", "No."))
        expect(page.locator("#program-log")).to_contain_text("No.")
        expect(editor).to_be_visible(visible=not ok)
    expect(page.locator("#program-about")).to_contain_text("This version is kept now")


def test_what_others_wrote_is_text_and_never_markup(page: Page, rig: WebRig) -> None:
    say(page, rig, EVIL)
    rig.tell(Interpreted(1, "model", EVIL, EVIL))
    expect(page.locator("#plan-lines")).to_have_text(EVIL)
    rig.tell(ProgramWritten(1, EVIL, "model", EVIL, EVIL))
    rig.tell(ProgramLog(1, 0.1, "INFO", EVIL))
    rig.tell(Result(1, "answered", EVIL))
    expect(page.get_by_role("log", name="What was said")).to_contain_text(EVIL)
    expect(page.locator("#program-name")).to_have_text(EVIL)
    rig.session.understanding.places.all = lambda: {EVIL: Place(Pose(1.0, 0.0, 0.0))}
    rig.tell(Remembered(1, EVIL, Pose(1.0, 0.0, 0.0)))
    page.locator("summary", has_text="Places").click()
    expect(page.get_by_role("button", name=EVIL)).to_be_visible()
    rig.tell(ObstacleChanged(0, EVIL, ((0.5, 0.5), (1.0, 0.5), (1.0, 1.0))))
    assert page.locator("#evil, img:not(.icon, #camera-picture)").count() == 0
    assert "ChatRobot" in page.title()
