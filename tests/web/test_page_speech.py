"""Speech in a real browser: what it hears and reads aloud is faked, what the page does with it is not."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from chatrobot.core.events import Result
from tests.web.browser import browser, open_page, say
from tests.web.rig import WebRig

__all__ = ["browser"]
pytestmark = pytest.mark.realtime

FAKE = """
window.begun = [];
window.aloud = [];
window.SpeechRecognition = class {
  start() { window.begun.push(this.lang); window.heardBy = this; }
  abort() { this.onend && this.onend(); }
};
window.hear = (text) => window.heardBy.onresult({ results: [[{ transcript: text }]] });
Object.defineProperty(window, "speechSynthesis", { value: {
  cancel() {}, speak(spoken) { window.aloud.push([spoken.lang, spoken.text]); },
} });
"""
INSECURE = 'Object.defineProperty(window, "isSecureContext", { value: false });'


@pytest.fixture
def speaking(browser: Browser, rig: WebRig) -> Any:
    page = open_page(browser, rig.origin, script=FAKE)
    yield page
    page.context.close()


def test_the_microphone_listens_once_it_is_told_where_the_sound_goes_and_leaves_what_it_heard_to_its_person(
    speaking: Page, rig: WebRig
) -> None:
    page, button = speaking, speaking.get_by_role("button", name="Speak", exact=True)
    expect(button).to_have_attribute("aria-pressed", "false")
    button.click()
    expect(page.locator("#microphone-note")).to_contain_text("send the sound to their maker")
    assert page.evaluate("begun") == []
    page.get_by_role("button", name="Listen").click()
    expect(button).to_have_attribute("aria-pressed", "true")
    page.evaluate('hear("forward one metre")')
    expect(page.locator("#say")).to_have_value("forward one metre")
    assert rig.session.log == []
    page.locator("#send").click()
    rig.session.wait_for("say", "forward one metre")
    page.evaluate('hear("stop stop")')
    rig.session.wait_for("say", "stop stop")
    expect(button).to_have_attribute("aria-pressed", "false")
    page.locator("#language").click()
    page.get_by_role("button", name="中文").click()
    page.get_by_role("button", name="说话", exact=True).click()
    assert page.evaluate("begun") == ["en-US", "zh-CN"]


def test_replies_are_read_aloud_on_request_alone(speaking: Page, rig: WebRig) -> None:
    say(speaking, rig, "forward 1 m")
    rig.tell(Result(1, "completed", "Done: drove 1.00 m."))
    expect(speaking.get_by_role("log", name="What was said")).to_contain_text("drove 1.00 m")
    assert speaking.evaluate("aloud") == []
    speaking.get_by_role("button", name="Read replies aloud").click()
    rig.tell(Result(2, "completed", "Done: drove 2.00 m."))
    expect(speaking.get_by_role("log", name="What was said")).to_contain_text("drove 2.00 m")
    assert speaking.evaluate("aloud") == [["en-US", "Done: drove 2.00 m."]]


def test_there_is_no_microphone_where_a_browser_allows_none(browser: Browser, rig: WebRig) -> None:
    page = open_page(browser, rig.origin, script=FAKE + INSECURE)
    expect(page.locator("#say")).to_be_visible()
    expect(page.locator("#microphone")).to_be_hidden()
    page.context.close()
