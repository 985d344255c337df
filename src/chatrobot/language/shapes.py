"""Shapes → steps."""

from __future__ import annotations

from chatrobot.language.frames import Frame
from chatrobot.language.manner import Pace
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Step


def draw(frames: list[Frame], i: int, pace: Pace) -> tuple[int, list[Step]]:
    """The steps of the shape named in `frames[i]`, and the index of the first frame that is no part of it."""
    raise Unclear("unknown_part", frames[i].text)
