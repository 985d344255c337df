"""Which steps a word names: `the turns`, `the second leg`, `the slide`, 右转. The words are in `selections.toml`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from chatrobot.language.data_files import load_table
from chatrobot.language.inverse import is_sideways
from chatrobot.plan.steps import Arc, Drive, Step, Turn, Wait


def _goes(step: Step, left: bool) -> bool:
    """Whether it turns, bends or slides to that side."""
    if isinstance(step, Drive):
        return is_sideways(step) and (math.sin(step.direction_rad) > 0.0) == left
    return isinstance(step, (Turn, Arc)) and step.left == left


def _drives(step: Step, forward: bool) -> bool:
    if isinstance(step, Arc):
        return step.backward != forward
    return (
        isinstance(step, Drive) and not is_sideways(step) and (math.cos(step.direction_rad) > 0.0) == forward
    )


_KINDS: Mapping[str, Callable[[Step], bool]] = {
    **dict.fromkeys(("step", "said", "move"), lambda _: True),
    "turn": lambda step: isinstance(step, Turn),
    "leg": lambda step: isinstance(step, (Drive, Arc)),
    "wait": lambda step: isinstance(step, Wait),
    "slide": is_sideways,
    "left": lambda step: _goes(step, True),
    "right": lambda step: _goes(step, False),
    "ahead": lambda step: _drives(step, True),
    "back": lambda step: _drives(step, False),
}


def kind_named(word: str, language: str) -> str:
    """The kind that a word like `turns` or `leg` names; `step` for any other."""
    tables = [load_table(language, name).get("kinds", {}) for name in ("selections", "held")]
    return next((kind for table in tables for kind, words in table.items() if word in words), "step")


def is_of_kind(step: Step, kind: str) -> bool:
    """Whether a step is of such a kind."""
    return _KINDS[kind](step)


def places_of(steps: Sequence[Step], word: str, language: str) -> list[int]:
    """Where the steps stand that a word names."""
    kind = kind_named(word, language)
    return [i for i, step in enumerate(steps) if is_of_kind(step, kind)]
