"""Plan text as it is shown to people: rounded, and folded where something comes several times in a row.

`54 × drive 0.5 m`, `4 × (drive 1 m, turn left 90 deg)`. What runs, travels or is edited is the exact text, never this.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple, TypeVar

from chatrobot.core.reason import ANGLE_PLACES, LENGTH_PLACES, number

TYPED_PLACES = {"deg": 2}
"""Decimals that a person may well have typed are shown; one more, and it has been computed."""
_QUOTED_OR_NUMBER = re.compile(
    r'"(?:[^"\\]|\\.)*"|(?<![\w.])(?P<number>-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)(?![\w.])(?P<unit> *[a-z/]+)?'
)


def shown_plan(plan_text: str) -> str:
    """Return the plan with numbers to the millimetre and the tenth of a degree; quoted texts stay as they are."""
    return _QUOTED_OR_NUMBER.sub(_shown, plan_text)


def _shown(found: re.Match[str]) -> str:
    text, unit = found["number"], found["unit"] or ""
    if text is None:
        return found[0]
    kind = unit.strip().partition("/")[0]
    places = ANGLE_PLACES if kind == "deg" else LENGTH_PLACES
    typed = TYPED_PLACES.get(kind, places)
    is_typed = "e" not in text and len(text.partition(".")[2]) <= typed
    return found[0] if is_typed else f"{number(float(text), places)}{unit}"


Item = TypeVar("Item")
_LONGEST_GROUP = 24
"""Items of a group that is looked for."""
_LEAST_SAVED = 2
"""Items that must go; two equal ones are read as quickly as they are counted."""
_LINE_CHARS = 76
_INDENT = "  "


class FoldedLine(NamedTuple):
    """A line as it is shown, and which line of the plan it stands for, or begins with."""

    number: int
    text: str


def runs(
    items: Sequence[Item],
    *,
    longest_count: int = _LONGEST_GROUP,
    least_saved_count: int = _LEAST_SAVED,
    may_repeat: Callable[[Item], bool] = lambda _: True,
) -> Iterator[tuple[int, Sequence[Item]]]:
    """Yield `items` in order as groups, each with how often it comes in a row."""
    at = 0
    while at < len(items):
        best = (1, items[at : at + 1])
        for size in range(1, min(longest_count, (len(items) - at) // 2) + 1):
            group = items[at : at + size]
            if not may_repeat(group[-1]):
                break
            count = 1
            while items[at + count * size : at + (count + 1) * size] == group:
                count += 1
            if (count - 1) * size >= least_saved_count and count * size > best[0] * len(best[1]):
                best = (count, group)
        yield best
        at += best[0] * len(best[1])


def repeated(count: int, texts: Sequence[str], join: str) -> str:
    """Return a group in one text; what comes several times within it is counted, too."""
    parts = [repeated(times, group, join) for times, group in runs(texts)] if len(texts) > 1 else [*texts]
    text = join.join(parts)
    if count == 1:
        return text
    return f"{count} × {text}" if len(texts) == 1 else f"{count} × ({text})"


def folded_plan(plan_text: str) -> list[FoldedLine]:
    """Return the lines of a plan as they are shown to people."""
    return list(_folded(shown_plan(plan_text).splitlines(), 1, ""))


def _folded(lines: Sequence[str], number: int, indent: str) -> Iterator[FoldedLine]:
    for count, steps in runs(_steps(lines)):
        size = sum(map(len, steps))
        one_line = repeated(count, [step[0] for step in steps], ", ")
        if count > 1 and size == len(steps) and len(one_line) <= _LINE_CHARS:
            yield FoldedLine(number, indent + one_line)
        elif count > 1:
            yield FoldedLine(number, f"{indent}{count} ×")
            yield from _folded([line for step in steps for line in step], number, indent + _INDENT)
        else:
            yield from _step(steps[0], number, indent)
        number += count * size


def _step(lines: Sequence[str], number: int, indent: str) -> Iterator[FoldedLine]:
    """One step that comes once; what a block holds is folded by itself."""
    yield FoldedLine(number, indent + lines[0])
    if len(lines) > 1:
        inside = [line.removeprefix(_INDENT) for line in lines[1:-1]]
        yield from _folded(inside, number + 1, indent + _INDENT)
        yield FoldedLine(number + len(lines) - 1, indent + lines[-1])


def _steps(lines: Sequence[str]) -> list[tuple[str, ...]]:
    """The lines of each step: one, or those of a block with its end."""
    steps: list[list[str]] = []
    for line in lines:
        is_inside = line.startswith(_INDENT)
        if steps and (is_inside or (len(steps[-1]) > 1 and line == "end" and steps[-1][-1] != "end")):
            steps[-1].append(line)
        else:
            steps.append([line])
    return [tuple(step) for step in steps]
