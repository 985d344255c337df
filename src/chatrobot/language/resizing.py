"""The steps of a motion with other amounts: `again with radius 1 m`, `the same but wait ten seconds`."""

from __future__ import annotations

import dataclasses

from chatrobot.language.edit_words import Edit
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn, Wait

TAKERS: dict[str, tuple[type[Step], ...]] = {
    "length": (Drive,), "angle": (Turn, Arc), "turns": (Turn, Arc), "time": (Drive, Turn, Wait),
    "radius": (Arc,), "speed": (Drive, Arc), "rate": (Turn,),
}  # fmt: skip
"""What a new amount may be for."""
_OF_ONE = frozenset({"length", "angle", "turns", "time"})
"""Amounts that are for one step, where nothing tells that they are of each."""


def resized(steps: list[Step], edit: Edit) -> list[Step] | None:
    """`Again with radius 1 m`, `the same but 50 cm sides`, `again, at 0.6 m/s`: where all that take it are alike.

    Raises:
        Unclear: for another pause where there was none.
    """
    out = list(steps)
    for size in edit.amounts:
        role = "radius" if {"radius", "diameter"} & edit.roles else size.value
        if role == "radius" and size.value in ("angle", "turns", "time"):
            return None  # `the same radius, one full circle`
        number = size.number / 2 if "diameter" in edit.roles else size.number
        takers = tuple(edit.kinds) if Wait in edit.kinds else TAKERS.get(role, ())  # none takes a count
        taken = [i for i, step in enumerate(out) if isinstance(step, takers)]
        lasting = [i for i in taken if getattr(out[i], "duration_s", None)]
        taken = lasting if role == "time" and lasting else taken  # of a pause before 1 m it is the pause
        each = "each" in edit.flags
        alike = each or role in ("speed", "rate") or len({_size(out[i]) for i in taken}) == 1
        if not taken and Wait in edit.kinds:
            raise Unclear("nothing_before", size.text)  # `the same but wait 2 s`, after what had no pause
        if not taken or not alike or (len(taken) > 1 and role in _OF_ONE and not (edit.roles or each)):
            return None
        for i in taken:
            out[i] = _changed_to(out[i], role, number)
    return out


def _size(step: Step) -> float:
    named = (getattr(step, name, None) for name in ("radius_m", "distance_m", "angle_rad", "duration_s"))
    return round(next((value for value in named if value), 0.0), 6)


def _changed_to(step: Step, role: str, number: float) -> Step:
    if role == "speed" and isinstance(step, (Drive, Arc)):
        return dataclasses.replace(step, speed_mps=number)
    if role == "rate" and isinstance(step, Turn):
        return dataclasses.replace(step, rate_radps=number)
    if role == "time" and isinstance(step, Drive):
        return dataclasses.replace(step, duration_s=number, distance_m=None)
    if role == "time" and isinstance(step, Turn):
        return dataclasses.replace(step, duration_s=number, angle_rad=None)
    if role in ("angle", "turns") and isinstance(step, Arc):
        return dataclasses.replace(step, angle_rad=number)
    if role == "radius" and isinstance(step, Arc):
        return dataclasses.replace(step, radius_m=number)
    return Wait(number) if isinstance(step, Wait) else with_value(step, number)


def with_value(step: Step, value: float) -> Step:
    """The step over that distance, or by that angle.

    Raises:
        Unclear: where that is no amount.
    """
    if value <= 0.0:
        raise Unclear("bad_number", f"{value:g}")
    if isinstance(step, Drive):
        return dataclasses.replace(step, distance_m=value, duration_s=None)
    return dataclasses.replace(step, angle_rad=value, duration_s=None) if isinstance(step, Turn) else step
