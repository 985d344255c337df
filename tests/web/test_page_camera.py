"""The robot's camera in the page, in a real browser: asked for while it is open, and looked through no longer."""

from __future__ import annotations

import io
import time

import pytest
from PIL import Image
from playwright.sync_api import Browser, expect

from tests.processes import wait_until
from tests.web.browser import browser, find_violations, open_page
from tests.web.rig import serving

__all__ = ["browser"]
pytestmark = pytest.mark.realtime
SHOWN_S = 1.5


class FakeCamera:
    """Shows a picture of 64 x 48 whose colour changes; counts who looks."""

    def __init__(self) -> None:
        self.begun = self.ended = self.taken = 0
        self.has_picture = True

    def begin(self) -> None:
        self.begun += 1

    def end(self) -> None:
        self.ended += 1

    def take(self) -> bytes:
        self.taken += 1
        file = io.BytesIO()
        Image.new("RGB", (64, 48), (40 * self.taken % 256, 90, 20)).save(file, "JPEG")
        return file.getvalue()


def test_the_camera_is_looked_through_while_it_is_open_and_a_few_times_a_second(browser: Browser) -> None:
    camera = FakeCamera()
    with serving(camera=camera) as rig:
        page = open_page(browser, rig.origin)
        assert camera.begun == 0, "nobody has asked"
        page.get_by_text("Camera", exact=True).click()
        picture = page.get_by_role("img", name="What the robot's camera sees now")
        expect(picture).to_be_visible()
        assert picture.evaluate("(image) => image.naturalWidth") == 64
        first = picture.get_attribute("src")
        before, began_s = camera.taken, time.monotonic()
        page.wait_for_timeout(SHOWN_S * 1e3)
        assert 1 <= camera.taken - before <= (time.monotonic() - began_s) / 0.3 + 1
        assert picture.get_attribute("src") != first
        assert find_violations(page) == []
        camera.has_picture = False
        expect(page.get_by_text("No picture comes from the camera.")).to_be_visible()
        page.get_by_text("Camera", exact=True).click()
        wait_until(lambda: camera.ended == camera.begun == 1)
        assert not any("image/" in str(message) for message in rig.room.history("en")), "kept nowhere"
        page.context.close()


def test_a_robot_without_a_camera_shows_none(browser: Browser) -> None:
    with serving() as rig:
        page = open_page(browser, rig.origin)
        expect(page.locator("#camera")).to_be_hidden()
        line = rig.page()
        line.say("look")
        line.say("history")
        line.wait_for("history")
        assert not [told for told in line.heard if told["is"] in ("picture", "refused")]
        page.context.close()
