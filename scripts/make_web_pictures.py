"""Makes the pictures of the web console from the real program in a real browser: `make pictures`."""

from __future__ import annotations

import io
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from PIL import Image, ImageOps
from playwright.sync_api import Browser, Page, expect, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from tests.web.browser import ARGUMENTS, DESKTOP, PATIENCE_MS, PHONE, find_browser, open_page  # noqa: E402

IMAGES = ROOT / "docs" / "images"
BITS = 6
"""A channel: nobody sees the difference, and the file is a quarter smaller."""
MOST_BYTES = 150_000
LOOK_S = 5.0
"""So long the robot has been driving when its picture is taken."""


def main() -> None:
    """Every picture, anew."""
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as driver, tempfile.TemporaryDirectory() as folder:
        browser = driver.chromium.launch(executable_path=find_browser(), args=list(ARGUMENTS))
        with _serving(Path(folder)) as address:
            _desktop(browser, address)
        with _serving(Path(folder)) as address:
            _programs(browser, address)
        with _serving(Path(folder)) as address:
            _phone(browser, address)
        browser.close()


@contextmanager
def _serving(folder: Path) -> Iterator[str]:
    command = [sys.executable, "-m", "chatrobot", "web", "--port", "0", "--no-open"]
    with subprocess.Popen(
        [*command, "--config-dir", str(folder)], stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            assert process.stdout is not None
            found = re.search(r"http://\S+", process.stdout.readline())
            assert found is not None
            yield found[0]
        finally:
            process.terminate()


def _desktop(browser: Browser, address: str) -> None:
    page = open_page(browser, address, DESKTOP)
    _say(page, "go forward 20 metres")
    expect(page.get_by_role("button", name="Yes")).to_be_visible()
    _say(page, "go to the kitchen, then turn left and wait 3 seconds")
    _shoot(page, "web.png")


def _programs(browser: Browser, address: str) -> None:
    page = open_page(browser, address, DESKTOP, dark=True)
    _say(page, "write a program that drives in a square of half a metre")
    expect(page.locator("#program-source")).to_be_visible()
    _shoot(page, "web-program.png")


def _phone(browser: Browser, address: str) -> None:
    page = open_page(browser, address, PHONE, locale="zh-CN")
    _say(page, "去书桌")
    _shoot(page, "web-phone-zh.png")


def _say(page: Page, text: str) -> None:
    page.locator("#say").fill(text)
    page.keyboard.press("Enter")


def _shoot(page: Page, name: str) -> None:
    """Save the page."""
    page.wait_for_timeout(1000 * LOOK_S)
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    page.keyboard.press("Escape")
    page.context.close()
    picture = ImageOps.posterize(picture, BITS)
    picture.save(IMAGES / name, optimize=True)
    size = (IMAGES / name).stat().st_size
    assert size < MOST_BYTES, f"{name} has {size} bytes"
    print(f"{name}: {size} bytes")


if __name__ == "__main__":
    main()
