"""say: tell the person something. No motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.plan.base import Step, require
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.core_motion import Emit
from chatrobot.plan.primitive import Primitive
from chatrobot.plan.reader import LineReader, quote

MAX_SAY_CHARS = 380


@dataclass(frozen=True)
class Say(Step):
    """Say something to the person (an event; no motion). One line of text."""

    text: str
    kind: Literal["say"] = "say"

    def __post_init__(self) -> None:
        require(self.text.isprintable() and bool(self.text.strip()), "say needs one line of printable text")
        require(
            len(quote(self.text)) <= MAX_SAY_CHARS,
            f"say takes at most {MAX_SAY_CHARS} characters with its quotes",
        )


class SayPrimitive(Primitive[Say]):
    kind = verb = "say"
    step_type = Say
    usage = 'say "TEXT"'
    help = 'Tell the person something; write \\" and \\\\ for a quotation mark and a backslash.'
    examples = ('say "hello"',)

    def parse(self, line: LineReader) -> Say:
        text = line.text('a text such as "hello"')
        line.finish("the end of the line")
        return Say(text)

    def format(self, step: Say) -> str:
        return f"say {quote(step.text)}"

    def lower(self, step: Say, context: LoweringContext) -> Lowered:  # noqa: ARG002
        return [Emit("say", step.text)]


PRIMITIVE = SayPrimitive()
