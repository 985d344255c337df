"""Reads what a model says as it comes in: plan text, the tutorial's lines or our JSON; all else is an error.

The model is not trusted: what is read here is rehearsed, governed and, where asked for, approved like any other plan.
"""

from __future__ import annotations

from chatrobot.core.errors import PlanTextError
from chatrobot.plan.base import Step
from chatrobot.plan.reader import LineReader
from chatrobot.plan.text import ImpossibleTwistError, StreamParser, read_tutorial_line

LOOKS = ("scan", "pose", "places", "outcome", "camera")
"""What a model may ask to see with a line `look …` at the end of its reply."""

REST = "# rest"
"""The first line of a corrected reply that holds only what is left to do."""

_FENCE = "```"
_THOUGHTS = ("<think>", "</think>")
_LEAST_ASSIGNMENT = "linear."


class ReplyReader:
    """One reply. `feed` it pieces of any size, then `finish` it; both give the top-level steps that became complete.

    The first line that cannot be read ends it: it is kept as `error`, and what came before it counts. A reply may
    stand in one code fence as a whole. `looks` is what it asks to see, `text` all that was said.
    """

    def __init__(self) -> None:
        self.error: PlanTextError | None = None
        self.looks: tuple[str, ...] = ()
        self.text = ""
        self._parser = StreamParser()
        self._rest = ""
        self._line_number = 0
        self._json: list[str] | None = None
        self._has_content = self._is_fenced = self._is_over = self._is_thinking = False

    @property
    def names_rest(self) -> bool:
        """True where it says that it holds only what is left to do."""
        first = next((line.strip() for line in self.text.splitlines() if _is_content(line)), "")
        return first.casefold() == REST

    def feed(self, piece: str) -> list[Step]:
        """Return the steps that the piece completes."""
        self.text += piece
        *lines, self._rest = (self._rest + piece).split("\n")
        return [step for line in lines for step in self._read(line)]

    def finish(self) -> list[Step]:
        """Return the steps that are complete only now that the reply is over."""
        last, self._rest = self._rest, ""
        steps = self._read(last)
        if self.error is not None:
            return steps
        try:
            if self._json is not None:
                from chatrobot.plan.json_form import plan_from_json

                return list(plan_from_json("\n".join(self._json)).steps)
            return [*steps, *self._parser.finish()]
        except PlanTextError as error:
            self.error = error
            return steps

    def _read(self, line: str) -> list[Step]:
        self._line_number += 1
        if self.error is not None:
            return []
        if self._skips(line):
            self._pass_over()
            return []
        if self._json is not None:
            self._json.append(line)
            return []
        try:
            return self._read_line(line)
        except PlanTextError as error:
            self.error = error
            return []

    def _skips(self, line: str) -> bool:
        """Pass over thoughts before the reply, and the fence around it."""
        stripped = line.strip()
        if self._is_thinking or (not self._has_content and stripped.startswith(_THOUGHTS[0])):
            self._is_thinking = _THOUGHTS[1] not in stripped
            return True
        if stripped and not self._has_content and not self._is_fenced and stripped.startswith(_FENCE):
            self._is_fenced = True
            return True
        if self._is_fenced and stripped == _FENCE:
            self._is_fenced, self._is_over = False, True
            return True
        if stripped and not self._has_content:
            self._has_content = True
            if stripped[0] in "{[":
                self._json = []
        return False

    def _read_line(self, line: str) -> list[Step]:
        reader = LineReader(line, self._line_number)
        if reader.at_end():
            return []
        if self._is_over:
            reader.fail("something follows the end of the reply", "nothing")
        if not self._parser.in_block:
            if reader.accept("look"):
                self._take_looks(reader)
                self._pass_over()
                return []
            step = _tutorial_step(reader)
            if step is not None:
                self._pass_over()
                return [step]
        if self.looks:
            reader.fail("something follows what is to be looked at", "the end of the reply")
        return self._parser.feed(line + "\n")

    def _pass_over(self) -> None:
        """Let the parser count the line: its errors name lines."""
        self._parser.feed("\n")

    def _take_looks(self, reader: LineReader) -> None:
        asked = [reader.accept(*LOOKS)]
        while not reader.at_end():
            asked.append(reader.accept(*LOOKS) or reader.fail_here(", ".join(LOOKS)))
        if not asked[0]:
            reader.fail_here(", ".join(LOOKS))
        self.looks = tuple(dict.fromkeys((*self.looks, *asked)))


def _tutorial_step(reader: LineReader) -> Step | None:
    """Return the step of a line that consists wholly of the tutorial's form."""
    if _LEAST_ASSIGNMENT not in reader.line.casefold() and "angular." not in reader.line.casefold():
        return None
    try:
        return read_tutorial_line(reader.line)
    except ImpossibleTwistError as error:
        allowed = "finite numbers; linear.z, angular.x and angular.y are 0"
        reader.fail(f"no robot on wheels can do that ({error.code})", allowed)


def _is_content(line: str) -> bool:
    return bool(line.strip()) and not line.strip().startswith((_FENCE, _THOUGHTS[0]))
