"""A replayed recording in a real browser: the map shows the robot where it was."""

from __future__ import annotations

import cmath
import math
import os
import re
import sys
from itertools import combinations
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from chatrobot.core.events import Telemetry
from chatrobot.recording.playback import shown
from chatrobot.recording.reader import read
from chatrobot.sim.load import load_world
from tests.processes import TalkingProcess, wait_until
from tests.report.recorded import session
from tests.web.browser import browser, open_page

__all__ = ["browser"]
pytestmark = pytest.mark.realtime
SAID = ("forward 1 m, then turn left", "curve right with a radius of 0.5 m for 90 degrees")
SAME_M = 0.01
RADIAN_M = 0.3
"""What counts as much as a radian: of poses at one point, the right heading is found."""

NOTE_DRAWN = """
(() => {
  const frames = (window.drawn = []);
  let [places, at, isRobot] = [[], null, false];
  const canvas = CanvasRenderingContext2D.prototype;
  const note = (name, look) => {
    const draw = canvas[name];
    canvas[name] = function (...given) {
      if (this.canvas.id === "canvas") look(...given);
      return draw.apply(this, given);
    };
  };
  note("setTransform", () => { places = []; });
  note("arc", (right, down, radius) => {
    if (radius === 4) places.push([right, down]);
    isRobot = radius >= 20;
  });
  note("translate", (right, down) => { at = [right, down]; });
  note("rotate", (angle) => { if (isRobot) frames.push({ places, at, angle }); });
})()
"""
"""Notes what is drawn: the discs of the places, and the arrow in a ring that is the robot."""


Drawn = tuple[float, float, float]


def test_the_page_shows_the_poses_of_the_recording_to_the_centimetre(
    browser: Browser, tmp_path: Path
) -> None:
    recording = read(session(tmp_path / "drive.mcap", SAID))
    arguments = [sys.executable, "-m", "chatrobot", "replay", str(recording.path), "--web", "--speed", "4"]
    replay = TalkingProcess(arguments, {**os.environ, "PYTHONUNBUFFERED": "1"})
    try:
        found = re.search(r"http://\S+/", replay.wait_for_line("http://"))
        assert found is not None
        page = open_page(browser, found[0], script=NOTE_DRAWN)
        expect(page.locator("#turns")).to_contain_text("This is the end of the recording.")
        drawn = poses_drawn(page)
        page.reload()  # somebody who comes after its end
        wait_until(lambda: bool(poses_drawn(page)))
        assert off_m(poses_drawn(page)[-1], drawn[-1]) < SAME_M
        page.context.close()
    finally:
        replay.process.terminate()
        replay.process.wait(10.0)
    told = [item.pose for _, item in shown(recording) if isinstance(item, Telemetry)]
    assert sum(any(off_m(pose, one) < SAME_M for one in drawn) for pose in told) > 0.5 * len(told) > 30
    for recorded in (recording.odometry, recording.truth):
        check_order(drawn, [(sample.x_m, sample.y_m, sample.yaw_rad) for _, sample in recorded])


def check_order(drawn: list[Drawn], recorded: list[Drawn]) -> None:
    """Check that what was drawn is what was recorded, one pose after the other, up to the last."""
    at = 0
    for one in drawn:
        near = [index for index in range(at, len(recorded)) if off_m(one, recorded[index]) < SAME_M]
        assert near, f"{one} was drawn, and not recorded after {recorded[at]}"
        at = near[0]
    assert off_m(drawn[-1], recorded[-1]) < SAME_M


def off_m(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    """How far two poses are from one another, a radian counted as `RADIAN_M`."""
    return math.dist(one[:2], other[:2]) + RADIAN_M * abs(math.remainder(one[2] - other[2], math.tau))


def poses_drawn(page: Page) -> list[Drawn]:
    """The poses of the robot on the map, measured against the two places that lie furthest apart on it."""
    places = [complex(pose.x_m, pose.y_m) for pose in load_world("home").places.values()]
    first, second = max(
        combinations(range(len(places)), 2), key=lambda two: abs(places[two[0]] - places[two[1]])
    )
    found = []
    for frame in page.evaluate("window.drawn"):
        discs = [complex(right, -down) for right, down in frame["places"]]
        assert len(discs) == len(places)
        metre = (discs[second] - discs[first]) / (places[second] - places[first])
        where = (complex(frame["at"][0], -frame["at"][1]) - discs[first]) / metre + places[first]
        found.append((where.real, where.imag, -frame["angle"] - cmath.phase(metre)))
    return found
