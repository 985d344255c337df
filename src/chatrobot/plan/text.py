"""Plan text: one short line a step, written by a model, read and edited by a person, run while it streams in.

`format_plan` writes one canonical form; `parse_plan(format_plan(plan)) == plan` for every valid plan. Reading is
more tolerant than writing. The grammar lies with the primitives (`plan/primitives`); docs/plan-language.md shows it.
The tutorial's form of a velocity, `linear.x = 1,linear.y = 0,…,angular.z = 0`, is read here, too: it counts only where
a line consists wholly of its assignments, never inside prose.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from chatrobot.core.errors import PlanTextError
from chatrobot.plan.base import MAX_EXPANDED_STEPS, MAX_LINES, MAX_NESTING, Block, Plan, Step, count_steps
from chatrobot.plan.primitive import AnyPrimitive, BlockPrimitive, for_step, for_verb, primitives
from chatrobot.plan.primitives.twist import RawTwist
from chatrobot.plan.reader import LineReader

MAX_LINE_CHARS = 400
_INDENT = "  "


def parse_plan(text: str) -> Plan:
    """Read a whole plan.

    Raises:
        PlanTextError: names the line and what is allowed there.
    """
    parser = StreamParser()
    steps = [*parser.feed(text), *parser.finish()]
    if not steps:
        raise PlanTextError("there is no step in this plan", allowed="one step a line, such as: drive 1 m")
    return Plan(tuple(steps))


def format_plan(plan: Plan) -> str:
    """Return the canonical text: a line a step, no newline at the end."""
    return "\n".join(_lines(plan.steps, ""))


def format_step(step: Step) -> str:
    """Return the canonical text of one step, with all its lines if it is a block."""
    return "\n".join(_lines((step,), ""))


def _lines(steps: tuple[Step, ...], indent: str) -> Iterator[str]:
    for step in steps:
        primitive = for_step(step)
        if isinstance(step, Block) and isinstance(primitive, BlockPrimitive):
            yield indent + primitive.format_header(step)
            yield from _lines(step.steps, indent + _INDENT)
            yield indent + "end"
        elif not isinstance(primitive, BlockPrimitive):
            yield indent + primitive.format(step)


@dataclass
class _OpenBlock:
    primitive: AnyPrimitive
    header: object
    line_number: int
    line: str
    steps: list[Step] = field(default_factory=list)


class StreamParser:
    """Reads plan text as it arrives, in pieces of any size.

    A step comes out when its line is complete, a block when its `end` is. A bad line is reported after all steps
    before it came out: by the same call if there are none in it, else by the next `feed` or `finish`; from then on
    by every call.
    """

    def __init__(self) -> None:
        self._rest = ""
        self._line_number = 0
        self._open: list[_OpenBlock] = []
        self._steps_done = 0
        self._error: PlanTextError | None = None

    @property
    def in_block(self) -> bool:
        """Return True where a block is open: its `end` has not been read."""
        return bool(self._open)

    def feed(self, chunk: str) -> list[Step]:
        """Return the top-level steps that this piece of text completed.

        Raises:
            PlanTextError: a line cannot be read, or the plan is too large.
        """
        *lines, self._rest = (self._rest + chunk).split("\n")
        done = self._read(lines)
        if self._error is None and len(self._rest.strip()) > MAX_LINE_CHARS:
            self._error = _too_long(self._line_number + 1, self._rest)
        return self._deliver(done)

    def finish(self) -> list[Step]:
        """End the text: read a last line without a newline.

        Raises:
            PlanTextError: as `feed`, or a block was not closed.
        """
        lines, self._rest = [self._rest], ""
        done = self._read(lines)
        if self._error is None and self._open:
            block = self._open[-1]
            self._error = PlanTextError(
                "this block is not closed",
                line_number=block.line_number,
                line=block.line,
                allowed="a line 'end'",
            )
        return self._deliver(done)

    def _deliver(self, done: list[Step]) -> list[Step]:
        if self._error is not None and not done:
            raise self._error
        return done

    def _read(self, lines: list[str]) -> list[Step]:
        done: list[Step] = []
        for line in lines:
            if self._error is not None:
                break
            self._line_number += 1
            try:
                step = self._read_line(line)
                if step is not None:
                    self._count(step, line)
                    done.append(step)
            except PlanTextError as error:
                self._error = error
        return done

    def _count(self, step: Step, line: str) -> None:
        self._steps_done += count_steps((step,))
        if self._steps_done > MAX_EXPANDED_STEPS:
            self._fail(f"the plan would do more than {MAX_EXPANDED_STEPS} steps", line)

    def _fail(self, problem: str, line: str) -> None:
        raise PlanTextError(problem, line_number=self._line_number, line=line)

    def _read_line(self, line: str) -> Step | None:
        """Return the top-level step that this line completes, if it does."""
        if len(line.strip()) > MAX_LINE_CHARS:
            raise _too_long(self._line_number, line)
        if self._line_number > MAX_LINES:
            self._fail(f"a plan has at most {MAX_LINES} lines", line)
        reader = LineReader(line, self._line_number)
        if reader.at_end():
            return None
        verb = reader.accept(reader.peek_word())
        if verb == "end":
            return self._close_block(reader)
        primitive = for_verb(verb) if verb else None
        if primitive is None:
            verbs = sorted(known.verb for known in primitives())
            reader.fail("no step begins like this", f"one of: {', '.join(verbs)}, end")
        if isinstance(primitive, BlockPrimitive):
            self._open_block(primitive, reader)
            return None
        try:
            step = primitive.parse(reader)
            reader.finish("the end of the line")
            return self._place(step)
        except ValueError as error:
            reader.fail(str(error), primitive.usage)

    def _open_block(self, primitive: AnyPrimitive, reader: LineReader) -> None:
        assert isinstance(primitive, BlockPrimitive)
        if len(self._open) >= MAX_NESTING:
            reader.fail(f"blocks are nested at most {MAX_NESTING} deep")
        header = primitive.parse_header(reader)
        reader.finish("the end of the line")
        self._open.append(_OpenBlock(primitive, header, self._line_number, reader.line))

    def _close_block(self, reader: LineReader) -> Step | None:
        reader.finish("the end of the line")
        if not self._open:
            reader.fail("there is no block to close here")
        block = self._open.pop()
        assert isinstance(block.primitive, BlockPrimitive)
        try:
            step: Step = block.primitive.close(block.header, tuple(block.steps))
        except ValueError as error:
            reader.fail(str(error), "steps between the opening line and 'end'")
        return self._place(step)

    def _place(self, step: Step) -> Step | None:
        """Put a step into the open block, or return it as a top-level one."""
        if not self._open:
            return step
        self._open[-1].steps.append(step)
        return None


def _too_long(line_number: int, line: str) -> PlanTextError:
    return PlanTextError(
        f"a line has at most {MAX_LINE_CHARS} characters",
        line_number=line_number,
        line=f"{line.strip()[:40]}…",
    )


DURATION_S = 1.0
"""How long a line moves the robot."""

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
_ASSIGNMENT = rf"(linear|angular)\s*\.\s*([xyz])\s*=\s*({NUMBER}|[-+]?(?:inf|nan)\w*)"
_FIND = re.compile(_ASSIGNMENT)
_LINE = re.compile(rf"\s*[\"'“]?\s*{_ASSIGNMENT}(?:\s*[,，;]\s*{_ASSIGNMENT})*\s*[.,;，]?\s*[\"'”]?\s*")


class ImpossibleTwistError(ValueError):
    """Raised for a velocity that cannot be. `code`: `bad_number` (not finite) or `not_planar`."""

    def __init__(self, code: str) -> None:
        super().__init__(code)
        self.code = code


def read_tutorial_line(line: str) -> RawTwist | None:
    """Return the velocity that `line` assigns, None where it is anything else.

    Raises:
        ImpossibleTwistError: it is of that form, and no planar robot can do it.
    """
    line = line.lower()
    if "\n" in line.strip() or not _LINE.fullmatch(line):
        return None
    found = {f"{group}.{axis}": _number(value) for group, axis, value in _FIND.findall(line)}
    return twist_from(found, DURATION_S)


def twist_from(values: dict[str, float], duration_s: float) -> RawTwist:
    """Return the raw velocity of assignments by name (`linear.x`, m/s; `angular.z`, rad/s); what is missing is zero.

    Raises:
        ImpossibleTwistError: see there.
    """
    if not all(math.isfinite(value) for value in values.values()):
        raise ImpossibleTwistError("bad_number")
    if any(values.get(name) for name in ("linear.z", "angular.x", "angular.y")):
        raise ImpossibleTwistError("not_planar")
    return RawTwist(
        values.get("linear.x", 0.0), values.get("linear.y", 0.0), values.get("angular.z", 0.0), duration_s
    )


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan  # `infinitely` and the like
