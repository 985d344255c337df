"""The page of a report in a real browser: it sorts, it loads nothing, it fits a phone."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from chatrobot.cli.report.drive import Drive
from chatrobot.cli.report.page import make_page
from chatrobot.cli.report.summary import words_in
from chatrobot.recording.reader import read
from tests.report.recorded import SAID, heard, write
from tests.report.test_report import HOSTILE
from tests.web.browser import PHONE, browser

__all__ = ["browser"]
pytestmark = pytest.mark.realtime


def opened(browser: Browser, file: Path, *, script: bool = True) -> tuple[Page, list[str]]:
    context = browser.new_context(
        viewport={"width": PHONE[0], "height": PHONE[1]}, java_script_enabled=script
    )
    page = context.new_page()
    seen: list[str] = []
    page.on("request", lambda request: seen.append(request.url))
    page.on("console", lambda message: seen.append(message.text))
    page.goto(file.as_uri())
    return page, seen


def written(recording: Path, folder: Path) -> Path:
    file = folder / "run.html"
    file.write_text(make_page(Drive.of(read(recording)), words_in("en")), encoding="utf-8")
    return file


def test_the_page_sorts_loads_nothing_and_fits_a_phone(
    browser: Browser, recorded: Path, tmp_path: Path
) -> None:
    file = written(recorded, tmp_path)
    page, seen = opened(browser, file)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE[0]
    said = page.locator("tr.heard td.text")
    page.get_by_role("button", name="in words").click()
    assert said.all_text_contents() == sorted([*SAID, "stop"])
    measured = page.get_by_role("button", name="measured, m")
    measured.click()
    measured.click()
    numbers = page.locator("td[data-name='measured, m']").all_text_contents()
    assert [float(number) for number in numbers] == sorted(map(float, numbers), reverse=True)
    expect(page.locator("th[aria-sort='descending']")).to_have_text("measured, m")
    assert seen == [file.as_uri()]
    page.context.close()


def test_a_hostile_text_is_only_text_and_the_page_reads_without_script(
    browser: Browser, tmp_path: Path
) -> None:
    file = written(write(tmp_path / "run.mcap", [heard(0.0, 1, HOSTILE)]), tmp_path)
    for script in (True, False):
        page, seen = opened(browser, file, script=script)
        expect(page).to_have_title("Report: Wheeltec mini mecanum")
        expect(page.locator("tr.heard td.text")).to_contain_text("<script>document.title='run'</script>")
        assert page.locator("th button").count() == (4 if script else 0)
        assert seen == [file.as_uri()]
        page.context.close()
