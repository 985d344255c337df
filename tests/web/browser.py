"""A browser that is there, driven as a person would: found on the machine, never downloaded."""

from __future__ import annotations

import os
import shutil
import warnings
from collections.abc import Iterator

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect, sync_playwright

from chatrobot.core.events import Interpreted, ProgramWritten, Rehearsed
from chatrobot.core.geometry import Pose
from tests.web.rig import WebRig

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
PLAN = "drive 0.5 m\nrepeat 2\n  turn left 90 deg\nend\nwait 1 s"
PATH = tuple((0.05 * step, 0.0, 0.0) for step in range(20))

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


@pytest.fixture
def page(browser: Browser, rig: WebRig) -> Iterator[Page]:
    """A page in English, which steers."""
    opened = open_page(browser, rig.origin)
    yield opened
    opened.context.close()


def open_page(
    browser: Browser,
    address: str,
    size: tuple[int, int] = DESKTOP,
    *,
    dark: bool = False,
    locale: str = "en-GB",
    sent: list[str] | None = None,
    script: str = "",
) -> Page:
    """Open a page as a person with that screen and language does, and wait until it is in.

    Args:
        sent: what the page says to the server is added there.
        script: runs before the page's own.
    """
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]},
        color_scheme="dark" if dark else "light",
        locale=locale,
        has_touch=size[0] < DESKTOP[0],
    )
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    page.add_init_script(script)
    if sent is not None:
        page.on("websocket", lambda line: line.on("framesent", lambda frame: sent.append(str(frame))))
    page.goto(address)
    expect(page.locator("#robot-title")).not_to_have_text("ChatRobot")
    return page


def find_violations(page: Page) -> list[tuple[str, list[object]]]:
    """Return what axe finds wrong, each with where."""
    found = Axe().run(page).response["violations"]
    return [(rule["id"], [node["target"] for node in rule["nodes"]]) for rule in found]


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


def say(page: Page, rig: WebRig, text: str) -> None:
    """Type it and press Enter, and wait until it is heard: what it brings about comes after it."""
    page.locator("#say").fill(text)
    page.keyboard.press("Enter")
    rig.session.wait_for("say", text)
    expect(page.locator("#turns .you").last).to_have_text(text)


def rehearse(rig: WebRig, turn: int = 1) -> None:
    """Have a plan rehearsed that waits for a yes."""
    rig.tell(Interpreted(turn, "offline", PLAN, "drive, turn"))
    rig.tell(Rehearsed(turn, True, 8.0, 0.95, Pose(0.95, 0.0, 0.0), path=PATH, needs_approval=True))


def write_program(rig: WebRig, source: str, turn: int = 1) -> None:
    """Have a program written."""
    rig.tell(ProgramWritten(turn, "square", "offline", source, "drives a square"))
