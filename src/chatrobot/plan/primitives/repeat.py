"""repeat: do what is inside, up to `end`, several times."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.plan.base import Block, Step, require
from chatrobot.plan.primitive import BlockPrimitive
from chatrobot.plan.reader import LineReader

MAX_REPEAT = 1000


@dataclass(frozen=True)
class Repeat(Block):
    """Do the steps inside `count` times."""

    count: int
    steps: tuple[Step, ...]
    kind: Literal["repeat"] = "repeat"

    def __post_init__(self) -> None:
        require(1 <= self.count <= MAX_REPEAT, f"a repeat count is 1 to {MAX_REPEAT}, not {self.count}")
        require(len(self.steps) > 0, "a repeat needs at least one step inside")

    @property
    def times(self) -> int:
        return self.count


class RepeatPrimitive(BlockPrimitive[Repeat, int]):
    kind = verb = "repeat"
    step_type = Repeat
    usage = "repeat COUNT … end"
    help = "Do the lines up to 'end' several times; blocks may hold blocks."
    examples = ("repeat 4\n  drive 1 m\n  turn left 90 deg\nend",)

    def parse_header(self, line: LineReader) -> int:
        count = line.whole_number(f"a whole number from 1 to {MAX_REPEAT}")
        if not 1 <= count <= MAX_REPEAT:
            line.fail(f"{count} is no count to repeat", f"a whole number from 1 to {MAX_REPEAT}")
        line.accept("times")
        line.finish("the end of the line")
        return count

    def close(self, header: int, steps: tuple[Step, ...]) -> Repeat:
        return Repeat(header, steps)

    def format_header(self, step: Repeat) -> str:
        return f"repeat {step.count}"


PRIMITIVE = RepeatPrimitive()
