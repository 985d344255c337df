"""A browser that is there, driven as a person would: found on the machine, never downloaded."""

from __future__ import annotations

import os
import shutil
import warnings
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, expect, sync_playwright

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
ARGUMENTS = (
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
)  # fmt: skip
NEEDED = "CHATROBOT_TESTS_NEED_A_BROWSER"
"""Set where the tests fail without a browser, as in continuous integration."""
WAY_OUT = (
    "no Chromium or Chrome is here, so the page of the web console is not tested: apt-get install chromium"
)
PATIENCE_MS = 15_000

DESKTOP, PROJECTOR, TABLET, PHONE = (1280, 800), (1920, 1080), (820, 1180), (390, 844)


def find_browser() -> str:
    """Return the path of a browser.

    Raises:
        pytest.fail.Exception: none is here, and one is needed.
        pytest.skip.Exception: none is here.
    """
    for name in NAMES:
        if path := shutil.which(name):
            return path
    if os.environ.get(NEEDED):
        pytest.fail(WAY_OUT)
    warnings.warn(WAY_OUT, stacklevel=2)
    pytest.skip(WAY_OUT)


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One browser for a file of tests: its driver keeps an event loop that others would meet."""
    path = find_browser()
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=path, args=list(ARGUMENTS))
        yield found
        found.close()


def open_page(
    browser: Browser,
    address: str,
    size: tuple[int, int] = DESKTOP,
    *,
    dark: bool = False,
    locale: str = "en-GB",
) -> Page:
    """Open a page as a person with that screen and language does, and wait until it is in."""
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]},
        color_scheme="dark" if dark else "light",
        locale=locale,
        has_touch=size[0] < DESKTOP[0],
    )
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    page.goto(address)
    expect(page.locator("#robot-title")).not_to_have_text("ChatRobot")
    return page


def count_pixels(page: Page, colour: str) -> int:
    """Return how many pixels of the map are drawn in that colour of the style."""
    found: int = page.evaluate(
        """(colour) => {
          const canvas = document.getElementById("canvas");
          const probe = document.createElement("canvas").getContext("2d");
          probe.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(`--map-${colour}`).trim();
          probe.fillRect(0, 0, 1, 1);
          const [red, green, blue] = probe.getImageData(0, 0, 1, 1).data;
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          let count = 0;
          for (let at = 0; at < data.length; at += 4) {
            if (data[at] === red && data[at + 1] === green && data[at + 2] === blue) count += 1;
          }
          return count;
        }""",
        colour,
    )
    return found
