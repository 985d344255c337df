"""The steps a plan is made of, in one place to import from. Each lives in its module of `plan/primitives`.

A `Plan` round-trips through plan text (`chatrobot.plan.text`) and JSON (`chatrobot.plan.json_form`).
"""

from __future__ import annotations

from chatrobot.plan.base import (
    MAX_EXPANDED_STEPS,
    MAX_LINES,
    MAX_NESTING,
    Block,
    Condition,
    Frame,
    ObstacleWithin,
    Plan,
    Step,
    count_steps,
)
from chatrobot.plan.primitives.drive import Drive, Go
from chatrobot.plan.primitives.no_motion import MAX_REPEAT, MAX_WAIT_S, Remember, Repeat, Say, Wait
from chatrobot.plan.primitives.turn import Arc, Face, Turn
from chatrobot.plan.primitives.twist import RawTwist

__all__ = (
    "MAX_EXPANDED_STEPS", "MAX_LINES", "MAX_NESTING", "MAX_REPEAT", "MAX_WAIT_S", "Arc", "Block", "Condition", "Drive",
    "Face", "Frame", "Go", "ObstacleWithin", "Plan", "RawTwist", "Remember", "Repeat", "Say", "Step", "Turn", "Wait",
    "count_steps",
)  # fmt: skip
