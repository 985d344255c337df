"""What the last motion leaves for the next turn: its steps, its direction, its amounts and their unit."""

from __future__ import annotations

import math

from chatrobot.language.context import Context, TurnRecord
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import DIRECTIONS
from chatrobot.language.inverse import inverse
from chatrobot.language.lexicon import cut, lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.rephrase import plain_text
from chatrobot.language.tokens import quantity, tokenise
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Drive, Step, Turn


def steps_of(record: TurnRecord | None) -> tuple[Step, ...]:
    """The steps of an earlier turn.

    Raises:
        Unclear: where there was none that moved.
    """
    if record is None or record.plan is None:
        raise Unclear("nothing_before")
    return record.plan.steps


def last_steps(context: Context) -> tuple[Step, ...]:
    """The steps of the last turn that moved; of one that corrected the turn before, what it did in its stead.

    Raises:
        Unclear: where there was none that moved.
    """
    moved = [turn for turn in context.dialogue.turns if turn.plan is not None]
    steps = steps_of(moved[-1] if moved else None)
    if len(moved) < 2 or not _corrects(moved[-1].text):
        return steps
    try:
        undone = tuple(inverse(list(steps_of(moved[-2]))))
    except Unclear:
        return steps
    return steps[len(undone) :] if len(steps) > len(undone) and steps[: len(undone)] == undone else steps


def _corrects(text: str) -> bool:
    """Whether an earlier turn began with a correction."""
    said = (a for a in tokenise(plain_text(text), lexicon(), {}) if a.kind not in ("filler", "sep", "glue"))
    first = next(said, None)
    return first is not None and (first.kind == "correction" or text.casefold().startswith(("no", "不")))


def _said_unit_m(text: str) -> float | None:
    """The last unit of length in what was said: `another 30` after `50 cm` are centimetres."""
    words = lexicon().words
    units = [
        float(value)
        for unit in cut(normalise(text))
        for kind, value in words.get((unit,), ())
        if kind == "unit_length"
    ]
    return units[-1] if units else None


def state_after(context: Context) -> State:
    """What the last motion leaves for an ellipsis like `thirty more`."""
    last = context.dialogue.last_motion
    state = State(home=context.dialogue.start_pose if last is not None else None)
    if last is None or last.plan is None:
        return state
    for step in reversed(last.plan.steps):
        if isinstance(step, Drive):
            state.last = "drive"
            if step.distance_m:
                state.length = quantity("length", step.distance_m, f"{step.distance_m:g} m")
                said = (_said_unit_m(turn.text) for turn in reversed(context.dialogue.turns))
                state.unit_m = next((unit for unit in said if unit), None)
            state.direction = _name_of(step.direction_rad)
            break
        if isinstance(step, Turn):
            state.last, state.left = "turn", step.left
            if step.angle_rad:
                state.angle = quantity("angle", step.angle_rad, f"{math.degrees(step.angle_rad):g}°")
            break
    return state


def _name_of(direction_rad: float) -> str:
    named = (n for n, a in DIRECTIONS.items() if abs(math.remainder(a - direction_rad, 2 * math.pi)) < 1e-6)
    return next(named, "forward")
