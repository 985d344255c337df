"""The picture of a line that lasts a second shows what is sent today, and so do the numbers beside it."""

from __future__ import annotations

import re

import pytest
from scripts import speed_profile

from chatrobot.core.clock import TICK_S

NUMBER = re.compile(r"[0-9]+(?:\.[0-9]+)?")


def test_the_picture_is_what_is_sent_today() -> None:
    kept, drawn = speed_profile.FILE.read_text(encoding="utf-8"), speed_profile.draw()
    assert NUMBER.sub("#", kept) == NUMBER.sub("#", drawn), "make pictures"
    numbers = [list(map(float, NUMBER.findall(text))) for text in (kept, drawn)]
    assert numbers[0] == pytest.approx(numbers[1], abs=1.0), "to the pixel; make pictures"


def test_a_second_at_half_a_metre_takes_one_and_a_half_and_covers_half_a_metre() -> None:
    sent = speed_profile.speeds()
    moving = [speed for speed in sent if speed > 0.0]
    assert len(moving) * TICK_S == pytest.approx(1.5, abs=0.05)
    assert sum(sent) * TICK_S == pytest.approx(0.5, abs=0.01)
    assert max(sent) == pytest.approx(0.5, abs=0.02)
