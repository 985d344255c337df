"""The steps a plan is made of, in one place to import from. Each lives in its module of `plan/primitives`.

A `Plan` round-trips through plan text (`chatrobot.plan.text`) and JSON (`chatrobot.plan.json_form`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from chatrobot.plan.base import Block, Condition, Frame, ObstacleWithin, Step, require
from chatrobot.plan.primitives.arc import Arc
from chatrobot.plan.primitives.drive import Drive
from chatrobot.plan.primitives.face import Face
from chatrobot.plan.primitives.go import Go
from chatrobot.plan.primitives.remember import Remember
from chatrobot.plan.primitives.repeat import MAX_REPEAT, Repeat
from chatrobot.plan.primitives.say import Say
from chatrobot.plan.primitives.turn import Turn
from chatrobot.plan.primitives.twist import RawTwist
from chatrobot.plan.primitives.wait import MAX_WAIT_S, Wait

__all__ = [
    "MAX_EXPANDED_STEPS",
    "MAX_LINES",
    "MAX_NESTING",
    "MAX_REPEAT",
    "MAX_WAIT_S",
    "Arc",
    "Block",
    "Condition",
    "Drive",
    "Face",
    "Frame",
    "Go",
    "ObstacleWithin",
    "Plan",
    "RawTwist",
    "Remember",
    "Repeat",
    "Say",
    "Step",
    "Turn",
    "Wait",
    "count_steps",
]

MAX_LINES = 1000
MAX_NESTING = 8
MAX_EXPANDED_STEPS = 10_000


@dataclass(frozen=True)
class Plan:
    """What the robot is to do, in order: at most 1000 lines, 8 blocks deep, 10 000 steps with repeats done."""

    steps: tuple[Step, ...]

    def __post_init__(self) -> None:
        require(len(self.steps) > 0, "a plan needs at least one step")
        require(_nesting(self.steps) <= MAX_NESTING, f"blocks are nested at most {MAX_NESTING} deep")
        require(_lines(self.steps) <= MAX_LINES, f"a plan has at most {MAX_LINES} lines")
        count = count_steps(self.steps)
        require(
            count <= MAX_EXPANDED_STEPS, f"a plan does at most {MAX_EXPANDED_STEPS} steps in all, not {count}"
        )


def count_steps(steps: Iterable[Step]) -> int:
    """How many steps are done in all, repeats counted out."""
    return sum(step.times * count_steps(step.steps) if isinstance(step, Block) else 1 for step in steps)


def _lines(steps: Iterable[Step]) -> int:
    return sum(2 + _lines(step.steps) if isinstance(step, Block) else 1 for step in steps)


def _nesting(steps: Iterable[Step]) -> int:
    return max((1 + _nesting(step.steps) if isinstance(step, Block) else 0 for step in steps), default=0)
