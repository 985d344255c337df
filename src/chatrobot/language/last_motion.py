"""What the last motion leaves for the next turn: its steps, its direction, its amounts and their unit."""

from __future__ import annotations

import math
from functools import lru_cache

from chatrobot.language.context import Context, Dialogue
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import DIRECTIONS
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.lexicon import lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.quantities import read_quantities
from chatrobot.language.tokens import quantity, tokenise
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn

_LEAST_SIDES = 3
"""Fewer drives than that draw no shape."""


def steps_of(record: TurnRecord | None) -> tuple[Step, ...]:
    """The steps of an earlier turn.

    Raises:
        Unclear: where there was none that moved.
    """
    if record is None or record.plan is None:
        raise Unclear("nothing_before")
    return record.plan.steps


@lru_cache(maxsize=128)
def said_unit_m(text: str) -> float | None:
    """The last unit of length in what was said: `another 30` after `50 cm` are centimetres."""
    atoms = read_quantities(tokenise(normalise(text), lexicon(), {}))
    units = [float(atom.role) for atom in atoms if atom.value == "length" and atom.role]
    return units[-1] if units else None


def unit_after(context: Context) -> str:
    """The unit that a bare number most likely has after the last motion; an empty string where that tells none."""
    state, last = state_after(context), context.dialogue.last_motion
    if last is not None and last.plan is not None and getattr(last.plan.steps[-1], "duration_s", None):
        return "s"
    if state.last == "turn":
        return "deg"
    return {0.01: "cm", 0.0254: "in", 0.3048: "ft", 1.0: "m"}.get(state.unit_m or 0.0, "")


def _last_told(dialogue: Dialogue) -> TurnRecord | None:
    """The last motion; after `undo that` what was undone: `now 1.5 m` is to go its way, and not the way back."""
    last = dialogue.last_motion
    if last is None or last.walk is None or last.walk.kind != "undo":
        return last
    return next((turn for turn in reversed(dialogue.turns) if turn.plan and turn.walk is None), last)


def state_after(context: Context) -> State:
    """What the last motion leaves for an ellipsis like `thirty more`."""
    last = _last_told(context.dialogue)
    state = State(home=context.dialogue.start_pose if last is not None else None)
    if last is None or last.plan is None:
        return state
    sides = [step.distance_m for step in last.plan.steps if isinstance(step, Drive) and step.distance_m]
    radii = [step.radius_m for step in last.plan.steps if isinstance(step, Arc)]
    drawn = ("side", sides, _LEAST_SIDES), ("radius", radii, 1)
    state.sizes = {name: of[0] for name, of, least in drawn if len(set(of)) == 1 and len(of) >= least}
    for step in reversed(last.plan.steps):
        if isinstance(step, Drive):
            state.last = "drive"
            if step.distance_m:
                state.length = quantity("length", step.distance_m, f"{step.distance_m:g} m")
                said = (said_unit_m(turn.text) for turn in reversed(context.dialogue.turns))
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
