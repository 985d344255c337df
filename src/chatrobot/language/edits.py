"""`Once more, but leave out the last turn`: the last motion read as a change of what was done, and changed.

An utterance is an edit if all of it is: what it keeps of the motion before, and what it changes. Anything that names a
motion of its own makes it none, and the clause reader has it.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from chatrobot.language.context import Dialogue
from chatrobot.language.edit_words import ROUND, SCALES, Edit, read_edit
from chatrobot.language.frames import DIRECTIONS, SIDES
from chatrobot.language.inverse import flipped, inverse, is_sideways, leaves_of
from chatrobot.language.last_motion import (
    motion_meant,
    said_unit_m,
    turned_rad,
    unit_driven_m,
    within_unit_before,
)
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.meant import is_correction
from chatrobot.language.numbers import is_chinese
from chatrobot.language.resizing import TAKERS, resized, with_value
from chatrobot.language.shape_sides import rest_of_shape
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn

_BACKWARDS = frozenset({"backward", "backwards"})
"""Words that name the way of the robot, and never the way that it came."""


def _to_edit(edit: Edit, dialogue: Dialogue) -> TurnRecord | None:
    """The motion that a text may change; None where several were undone at once: `forward 20 cm` means none of them."""
    if "overshot" in edit.flags:
        return dialogue.last_motion
    try:
        return motion_meant(dialogue)
    except Unclear:
        return None


def edited(atoms: Sequence[Atom], dialogue: Dialogue) -> list[Step] | None:
    """The steps of the last motion as they are to be now; None where `atoms` change none, or not for sure.

    Raises:
        Unclear: where two readings are as likely.
    """
    edit = read_edit(atoms)
    if edit is None:
        return None
    last = _to_edit(edit, dialogue)
    if last is None or last.plan is None or is_correction(last):
        return None
    steps = list(last.plan.steps)
    aslant = {f"back_{side}": side for side in SIDES if _came_from(steps, side)}
    if edit.way in aslant:  # `slide back right`, after a slide to the left
        edit.way, edit.returns = aslant[edit.way], True
    elif edit.way.startswith("back_") and "same_amount" in edit.flags:
        raise Unclear("which_way")
    elif edit.way == "back" and "same_amount" in edit.flags and any(map(is_sideways, steps)):
        said = {text.split()[-1] for atom in atoms if (text := atom.text)}
        if said & _BACKWARDS and len(steps) == 1 and not edit.amounts:
            return _resized_on_way(edit, steps[0])
        # `right 1 m`, then `back up as far`: where it came from, or backwards?
        if not _says_only_back(atoms):
            raise Unclear("which_way")
    if edit.returns and not _came_from(steps, edit.way):
        if "same_amount" not in edit.flags or any(is_chinese(atom.text) for atom in atoms):
            return None
        raise Unclear("which_way")  # `back right`: aslant, or back to the right?
    if "same_unit" in edit.flags:
        if len(steps) != 1:
            return None
        edit.flags.discard("same_unit")
        units = (unit_driven_m(turn) for turn in reversed(dialogue.turns))
        unit_m = next((unit for unit in units if unit), 0.0)
        edit.amounts = [within_unit_before(amount, steps[-1], unit_m, 10.0) for amount in edit.amounts]
        if edit.amount("number"):
            return None
        if edit.way or "other_way" in edit.flags:  # `now 45 the other way`
            return _resized_on_way(edit, steps[-1])
    if "overshot" in edit.flags:
        if edit.way and edit.amount("number"):
            return None
        unit_m = said_unit_m(last.text) or 0.0
        edit.amounts = [within_unit_before(amount, steps[-1], unit_m, 1.0) for amount in edit.amounts]
    whole_turn = _rest_of_turn(steps[-1], dialogue) if "complete" in edit.flags and len(steps) == 1 else None
    return whole_turn or (_applied(edit, steps) or []) * edit.times or None


def _rest_of_turn(step: Step, dialogue: Dialogue) -> list[Step] | None:
    """What is missing to a full turn, after turns on the spot one after another."""
    if not isinstance(step, Turn):
        return None
    missing = 2.0 * math.pi - turned_rad(dialogue, step.left)
    return [dataclasses.replace(step, angle_rad=missing)] if 0.0 < missing < 2.0 * math.pi else None


def _says_only_back(atoms: Sequence[Atom]) -> bool:
    """Whether it says `back`, and not `back up` or `reverse`."""
    said = [atom.text for atom in atoms if atom.kind in ("dir", "verb")]
    return any(is_chinese(text) or text.split()[-1:] == ["back"] for text in said)


def _came_from(steps: list[Step], side: str) -> bool:
    """Whether the motion went to the other side, so that it goes back to this one."""
    [step] = steps if len(steps) == 1 else [None]
    if isinstance(step, Turn):
        return step.left != (side == "left")
    return step is not None and is_sideways(step) and _heads_left(step) != (side == "left")


def _resized_on_way(edit: Edit, step: Step) -> list[Step] | None:
    """The motion before with another amount, the way that is named, or the opposite one."""
    flags, way = edit.flags - {"other_way"}, edit.way
    found = _applied(dataclasses.replace(edit, flags=flags, way=""), [step]) or []
    if not found or (way and flags != edit.flags):
        return None
    if not way:
        return inverse(found)
    [new] = found
    if isinstance(new, Drive) and way in DIRECTIONS:
        return [dataclasses.replace(new, direction_rad=DIRECTIONS[way])]
    return [dataclasses.replace(new, left=way == "left")] if isinstance(new, Turn) and way in SIDES else None


def _applied(edit: Edit, steps: list[Step]) -> list[Step] | None:
    flags, scale = edit.flags, edit.amount(*SCALES)
    if flags & ROUND:
        if flags != ROUND or edit.amounts or edit.way or Turn in edit.kinds:
            return None
        if not isinstance(steps[-1], Arc):
            raise Unclear("nothing_before")
        return rest_of_shape(steps, edit.nth)
    if "complete" in flags:
        return rest_of_shape(steps, edit.nth)
    if "leave_out" in flags:
        return _without(steps, edit)
    if "reversed" in flags:
        if len(steps) == 1:
            raise Unclear("nothing_before")  # the order of what?
        return None if flags - {"again", "reversed"} or edit.amounts or edit.way else steps[::-1]
    if "swapped" in flags:
        if "both" in flags and len(steps) > 2:
            raise Unclear("nothing_before")  # which two of them?
        return _swapped(steps)
    if "first" in flags:
        return _reordered(steps, edit)
    if edit.way in SIDES and not (flags - {"again", "instead"} or edit.amounts or edit.roles or edit.nth):
        if edit.kinds and not any(isinstance(step, tuple(edit.kinds)) for step in steps):
            return None  # `turn left again`, after a slide
        is_named = "again" in flags or edit.returns or (edit.is_named and not edit.kinds)
        if is_named or not edit.kinds:
            return _to_side(steps, edit.way == "left", is_named=is_named, goes_on=edit.goes_on)
        return None
    points_back = edit.way == "back" and bool(scale or edit.slides or edit.amount("angle"))
    if flags & {"same_amount", "overshot"} or points_back:
        return _at_its_pace(edit, steps, scale)
    if edit.instead is not None and "again" in flags:
        replaced = _replaced(steps, edit.amounts[0], edit.instead)
        if replaced is None:
            raise Unclear("nothing_before")  # nothing of it was so much
        return replaced
    if scale is not None and "amounts" in flags:
        return [scaled(step, scale.number) for step in steps]
    if flags == {"again", "more"} and len(edit.amounts) == 1 and not edit.way and scale is None:
        return _lengthened(steps, edit)
    measured = edit.roles and ("instead" in flags or edit.is_named)  # `make the radius 1 m`
    if not ("again" in flags or measured) or flags - {"again", "instead", "all", "each"} or scale is not None:
        return None
    return resized(steps, edit) if edit.amounts and not edit.way else None


def _at_its_pace(edit: Edit, steps: list[Step], scale: Atom | None) -> list[Step] | None:
    """`The same distance back at 0.1 m/s`: how far, then how fast."""
    how = [amount for amount in edit.amounts if amount.value in ("speed", "rate")]
    sizes = [amount for amount in edit.amounts if amount not in how]
    found = _one_way(dataclasses.replace(edit, amounts=sizes), steps, scale)
    return resized(found, Edit(amounts=how)) if found and how else found


def _one_way(edit: Edit, steps: list[Step], scale: Atom | None) -> list[Step] | None:
    """`The same distance in the opposite direction`, `half of that distance back`, `too much, slide back 25 cm`."""
    step, size = steps[-1], edit.amount("length", "angle")
    if not isinstance(step, (Drive, Turn)) or any(kind is not type(step) for kind in edit.kinds):
        return None
    if len(edit.amounts) > 1 or (len(steps) > 1 and len({type(step) for step in steps}) == 1):
        return None
    if scale is not None and len(steps) > 1:
        raise Unclear("unclear_motion", scale.text)  # half of which step?
    if edit.way in SIDES and (isinstance(step, Turn) or is_sideways(step)) and "same_amount" in edit.flags:
        return _to_side([step], edit.way == "left", is_named=True, goes_on=True)
    if edit.way not in ("", "back") or (edit.slides and not is_sideways(step)):
        return None
    if edit.way == "back" and getattr(step, "direction_rad", None) == DIRECTIONS["back"]:
        if not edit.goes_on:
            raise Unclear("which_way")  # backwards once more, or back to where it came from?
    elif "other_way" in edit.flags or edit.way == "back" or "overshot" in edit.flags:
        [step] = inverse([step])
    if size is not None and ("overshot" in edit.flags or edit.slides or edit.way == "back"):
        return [with_value(step, size.number)] if _takes(step, size) else None
    if "overshot" in edit.flags or (edit.slides and edit.way != "back"):
        return None
    return [scaled(step, scale.number if scale is not None else 1.0)] if size is None else None


def _reordered(steps: list[Step], edit: Edit) -> list[Step]:
    """`Now turn first and then drive`: the same steps in the order in which they are named now.

    Raises:
        Unclear: where these are others, or more is said.
    """
    kinds = [type(step) for step in steps]
    named = (
        edit.kinds
        if len(edit.kinds) > 1
        else [*edit.kinds, *(kind for kind in kinds if kind not in edit.kinds)]
    )
    alike = len(set(kinds)) == len(kinds) and set(kinds) == set(named) and len(named) == len(kinds)
    if not alike or edit.amounts or edit.way or edit.roles:
        raise Unclear("nothing_before")
    return [steps[kinds.index(kind)] for kind in named]


def scaled(step: Step, factor: float) -> Step:
    """A drive or a turn of so many times the size; an arc of so many times the radius; any other step as it is."""
    if isinstance(step, Drive):
        seconds = step.duration_s * factor if step.duration_s else None
        length = step.distance_m * factor if step.distance_m else None
        return dataclasses.replace(step, distance_m=length, duration_s=seconds)
    if isinstance(step, Turn):
        seconds = step.duration_s * factor if step.duration_s else None
        angle = step.angle_rad * factor if step.angle_rad else None
        return dataclasses.replace(step, angle_rad=angle, duration_s=seconds)
    return dataclasses.replace(step, radius_m=step.radius_m * factor) if isinstance(step, Arc) else step


def _takes(step: Step, size: Atom) -> bool:
    return isinstance(step, Drive if size.value == "length" else Turn)


def _to_side(steps: list[Step], left: bool, *, is_named: bool, goes_on: bool) -> list[Step] | None:
    """`Now to the right` after a slide, `now one to the right` after a figure: in the manner of the motion before."""
    if len(steps) == 1 and is_sideways(steps[0]):
        return steps if _heads_left(steps[0]) == left else [flipped(steps[0])]
    is_named |= len(steps) == 1 and (
        goes_on or isinstance(steps[0], Arc)
    )  # `and right`, after `turn left 30`
    return mirrored(steps, left) if is_named else None


def _heads_left(step: Step) -> bool:
    return isinstance(step, Drive) and math.sin(step.direction_rad) > 0.0


def _lengthened(steps: list[Step], edit: Edit) -> list[Step] | None:
    """`The same but 20 cm further`, `the same with the radius plus 20 cm`: as it was, and so much more or less.

    Raises:
        Unclear: where no amount or several could be meant, or nothing would be left.
    """
    [size] = edit.amounts
    round_ = bool({"radius", "diameter"} & edit.roles) and size.value == "length"
    names = {"length": "distance_m", "angle": "angle_rad", "turns": "angle_rad", "time": "duration_s"}
    name = "radius_m" if round_ else names.get(size.value, "")
    takers = TAKERS["radius"] if round_ else TAKERS.get(size.value, ())
    taken = [step for step in steps if isinstance(step, takers) and getattr(step, name, None)]
    values = {round(getattr(step, name), 6) for step in taken}
    of_all = len(values) == 1 and (len(taken) == 1 or bool(edit.roles) or "each" in edit.flags)
    if not of_all or any(kind is not type(taken[0]) for kind in edit.kinds):
        raise Unclear("unclear_motion", size.text)
    before = getattr(taken[0], name) * (2.0 if "diameter" in edit.roles else 1.0)
    value = before + edit.sign * size.number
    if value <= 0.0:
        raise Unclear("unclear_motion", size.text)
    whole = quantity(size.value, value, size.text, size.role)
    return resized(steps, dataclasses.replace(edit, amounts=[whole]))


def _replaced(steps: list[Step], new: Atom, old: Atom) -> list[Step] | None:
    """`Once more with 90 instead of 45`: wherever that amount was."""
    out, taken = list(steps), 0
    for i, step in enumerate(steps):
        turn = isinstance(step, Turn)
        value = getattr(step, "angle_rad" if turn else "distance_m", None)
        unit = math.radians(1.0) if turn and old.value == "number" else 1.0
        if (
            value is not None
            and abs(value - old.number * unit) < 1e-6
            and (old.value == "number" or _takes(step, old))
        ):
            out[i] = with_value(step, new.number * (unit if new.value == "number" else 1.0))
            taken += 1
    kinds = {type(new_step) for new_step, step in zip(out, steps) if new_step is not step}
    return out if taken and len(kinds) == 1 else None


def _without(steps: list[Step], edit: Edit) -> list[Step] | None:
    """`Leave out the last turn`, `without the second step`."""
    kind = edit.kinds[0] if edit.kinds else None
    at = [i for i, step in enumerate(steps) if kind is None or isinstance(step, kind)]
    n = edit.nth - 1 if edit.nth > 0 else len(at) - 1
    if edit.nth == 0 or not 0 <= n < len(at) or edit.amounts or len(edit.kinds) > 1 or len(steps) < 2:
        return None
    return [*steps[: at[n]], *steps[at[n] + 1 :]]


def _swapped(steps: list[Step]) -> list[Step] | None:
    """The two distances, or the two angles, one for the other."""
    for kind, name in ((Drive, "distance_m"), (Turn, "angle_rad")):
        at = [i for i, step in enumerate(steps) if isinstance(step, kind) and getattr(step, name)]
        if len(at) == 2:
            out, (one, two) = list(steps), at
            out[one] = with_value(steps[one], getattr(steps[two], name))
            out[two] = with_value(steps[two], getattr(steps[one], name))
            return out
    return None


def mirrored(steps: list[Step], left: bool) -> list[Step] | None:
    """`The same, but turning right`: where all that turned to one side, or slid to it, now does so to the other."""
    leaves = list(leaves_of(steps))
    turning = [step.left for step in leaves if isinstance(step, (Turn, Arc))]
    sides = turning or [_heads_left(step) for step in leaves if is_sideways(step)]
    if len(set(sides)) > 1:
        raise Unclear("nothing_before")  # they went to both sides: which is meant?
    if not sides:
        return None
    return [flipped(step) for step in steps] if sides[0] != left else list(steps)
