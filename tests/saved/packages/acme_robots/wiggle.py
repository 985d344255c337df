"""A primitive, as release 0.1 takes one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.core.geometry import Twist
from chatrobot.plan.base import Step
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.core_motion import RampedTwist
from chatrobot.plan.primitive import Primitive
from chatrobot.plan.reader import LineReader


@dataclass(frozen=True)
class Wiggle(Step):
    """Wag to both sides."""

    times: int = 2
    kind: Literal["wiggle"] = "wiggle"


class WigglePrimitive(Primitive[Wiggle]):
    kind = verb = "wiggle"
    step_type = Wiggle
    usage = "wiggle COUNT"
    help = "Wag to both sides."
    examples = ("wiggle 3",)

    def parse(self, line: LineReader) -> Wiggle:
        return Wiggle(line.whole_number("a count"))

    def format(self, step: Wiggle) -> str:
        return f"wiggle {step.times}"

    def lower(self, step: Wiggle, context: LoweringContext) -> Lowered:
        sides = (Twist(0, 0, 0.5), Twist(0, 0, -0.5))
        return [RampedTwist.within(context.profile.limits, side, 0.4) for side in sides * step.times]


PRIMITIVE = WigglePrimitive()
