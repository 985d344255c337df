"""Steps that move nothing themselves: `wait`, `say`, `remember`, and `repeat`, which does what it holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.plan.base import Block, Step, divide_extent, require, require_positive
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.primitive import BlockPrimitive, Primitive, StepParts, divided
from chatrobot.plan.primitives.drive import MAX_PLACE_CHARS
from chatrobot.plan.reader import LineReader, number_text, quote
from chatrobot.plan.trajectory import Emit, Pause

MAX_WAIT_S = 3600.0


@dataclass(frozen=True)
class Wait(Step):
    """Stand still."""

    duration_s: float
    kind: Literal["wait"] = "wait"

    def __post_init__(self) -> None:
        require_positive(self, "duration_s")
        require(self.duration_s <= MAX_WAIT_S, f"a wait is at most {MAX_WAIT_S:g} s, not {self.duration_s:g}")


class _WaitPrimitive(Primitive[Wait]):
    kind = verb = "wait"
    step_type = Wait
    usage = "wait TIME"
    help = "Stand still."
    examples = ("wait 3 s",)

    def parse(self, line: LineReader) -> Wait:
        line.accept("for")
        return Wait(line.duration_s())

    def format(self, step: Wait) -> str:
        return f"wait {number_text(step.duration_s)} s"

    def lower(self, step: Wait, context: LoweringContext) -> Lowered:  # noqa: ARG002
        return [Pause(step.duration_s)]

    def divide(self, step: Wait, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        return divided(step, "duration_s", divide_extent(step.duration_s, share))


MAX_SAY_CHARS = 380


@dataclass(frozen=True)
class Say(Step):
    """Say something to the person (an event; no motion). One line of text."""

    text: str
    kind: Literal["say"] = "say"

    def __post_init__(self) -> None:
        require(self.text.isprintable() and bool(self.text.strip()), "say needs one line of printable text")
        fits = len(quote(self.text)) <= MAX_SAY_CHARS
        require(fits, f"say takes at most {MAX_SAY_CHARS} characters with its quotes")


class _SayPrimitive(Primitive[Say]):
    kind = verb = "say"
    step_type = Say
    usage = 'say "TEXT"'
    help = 'Tell the person something; write \\" and \\\\ for a quotation mark and a backslash.'
    examples = ('say "hello"',)

    def parse(self, line: LineReader) -> Say:
        return Say(line.text('a text such as "hello"'))

    def format(self, step: Say) -> str:
        return f"say {quote(step.text)}"

    def lower(self, step: Say, context: LoweringContext) -> Lowered:  # noqa: ARG002
        return [Emit("say", step.text)]


@dataclass(frozen=True)
class Remember(Step):
    """Remember where the robot stands now under a name."""

    place: str
    kind: Literal["remember"] = "remember"

    def __post_init__(self) -> None:
        fits = self.place.isprintable() and bool(self.place.strip()) and len(self.place) <= MAX_PLACE_CHARS
        require(fits, f"a place needs a printable name of at most {MAX_PLACE_CHARS} characters")


class _RememberPrimitive(Primitive[Remember]):
    kind = verb = "remember"
    step_type = Remember
    needs_pose = True
    usage = 'remember "PLACE"'
    help = "Remember where the robot stands now under a name."
    examples = ('remember "dock"',)

    def parse(self, line: LineReader) -> Remember:
        return Remember(line.text('the name of the place, as in "dock"'))

    def format(self, step: Remember) -> str:
        return f"remember {quote(step.place)}"

    def lower(self, step: Remember, context: LoweringContext) -> Lowered:  # noqa: ARG002
        return [Emit("remember", step.place)]


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
        """Return `count`."""
        return self.count


class _RepeatPrimitive(BlockPrimitive[Repeat, int]):
    kind = verb = "repeat"
    step_type = Repeat
    usage = "repeat COUNT … end"
    help = "Do the lines up to 'end' several times; blocks may hold blocks."
    examples = ("repeat 4\n  drive 1 m\n  turn left 90 deg\nend",)

    def parse_header(self, line: LineReader) -> int:
        allowed = f"a whole number from 1 to {MAX_REPEAT}"
        count = line.whole_number(allowed)
        if not 1 <= count <= MAX_REPEAT:
            line.fail(f"{count} is not a number of repeats", allowed)
        line.accept("times")
        return count

    def close(self, header: int, steps: tuple[Step, ...]) -> Repeat:
        return Repeat(header, steps)

    def format_header(self, step: Repeat) -> str:
        return f"repeat {step.count}"


PRIMITIVES = (_WaitPrimitive(), _SayPrimitive(), _RememberPrimitive(), _RepeatPrimitive())
