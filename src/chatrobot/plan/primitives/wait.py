"""wait: stand still for a time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.plan.base import Step, divide_extent, require, require_positive
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.core_motion import Pause
from chatrobot.plan.primitive import Primitive, StepParts, step_parts
from chatrobot.plan.reader import LineReader
from chatrobot.plan.units import number_text

MAX_WAIT_S = 3600.0


@dataclass(frozen=True)
class Wait(Step):
    """Stand still."""

    duration_s: float
    kind: Literal["wait"] = "wait"

    def __post_init__(self) -> None:
        require_positive("duration_s", self.duration_s)
        require(self.duration_s <= MAX_WAIT_S, f"a wait is at most {MAX_WAIT_S:g} s, not {self.duration_s:g}")


class WaitPrimitive(Primitive[Wait]):
    kind = verb = "wait"
    step_type = Wait
    usage = "wait TIME"
    help = "Stand still."
    examples = ("wait 3 s",)

    def parse(self, line: LineReader) -> Wait:
        line.accept("for")
        duration = line.duration_s()
        line.finish("the end of the line")
        return Wait(duration)

    def format(self, step: Wait) -> str:
        return f"wait {number_text(step.duration_s)} s"

    def lower(self, step: Wait, context: LoweringContext) -> Lowered:  # noqa: ARG002
        return [Pause(step.duration_s)]

    def divide(self, step: Wait, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        times = divide_extent(step.duration_s, share)
        return step_parts(times, lambda part: replace(step, duration_s=part))


PRIMITIVE = WaitPrimitive()
