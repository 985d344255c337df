"""remember: give the place where the robot stands a name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.plan.base import Step, require
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.core_motion import Emit
from chatrobot.plan.primitive import Primitive
from chatrobot.plan.primitives.go import MAX_PLACE_CHARS
from chatrobot.plan.reader import LineReader, quote


@dataclass(frozen=True)
class Remember(Step):
    """Remember where the robot stands now under a name."""

    place: str
    kind: Literal["remember"] = "remember"

    def __post_init__(self) -> None:
        require(
            self.place.isprintable() and bool(self.place.strip()) and len(self.place) <= MAX_PLACE_CHARS,
            f"a place needs a printable name of at most {MAX_PLACE_CHARS} characters",
        )


class RememberPrimitive(Primitive[Remember]):
    kind = verb = "remember"
    step_type = Remember
    needs_pose = True
    usage = 'remember "PLACE"'
    help = "Remember where the robot stands now under a name."
    examples = ('remember "dock"',)

    def parse(self, line: LineReader) -> Remember:
        place = line.text('the name of the place, as in "dock"')
        line.finish("the end of the line")
        return Remember(place)

    def format(self, step: Remember) -> str:
        return f"remember {quote(step.place)}"

    def lower(self, step: Remember, context: LoweringContext) -> Lowered:  # noqa: ARG002
        return [Emit("remember", step.place)]


PRIMITIVE = RememberPrimitive()
