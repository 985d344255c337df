"""A heading or a place told by an earlier one: `40 to the right of where you looked`, `1 m behind the start`."""

from __future__ import annotations

import math

from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.language.context import Context, Dialogue
from chatrobot.language.frames import SIDES
from chatrobot.language.last_motion import in_unit_before
from chatrobot.language.slots_said import HEADINGS, PLACES, SUMS, Said
from chatrobot.plan.steps import Arc, Drive, Face, Go, Step, Turn

_SIDES_RAD = dict(zip(PLACES, (0.0, math.pi, math.pi / 2, -math.pi / 2)))
_SPOTS = ("first_spot", "before_spot")
"""`Where you were at the start` is a heading where it is turned to, else a place."""
_OF_HEADING = (
    *("idle", "facing", "turning", "back", "shortest", "opposite", "left", "right", "amount"),
    *("oops", "want", "wish", "weak", "standing", "anew", *HEADINGS),
)
_NEAR_M, _NEAR_RAD = 0.02, math.radians(2.0)
"""What is within this of a line, or of a heading, is on it."""


def told_heading(said: Said, context: Context) -> list[Step] | None:
    """`Forty to the right of where you were looking before`, `the heading you had before any of that`."""
    sides, angle = [side for side in SIDES if said.has(side)], said.amount("amount")
    base_rad = _base_rad(said, context.dialogue)
    if base_rad is None or said.factors or not said.within(*_OF_HEADING) or not said.only("amount"):
        return None
    if len(sides) != (angle is not None):
        return None
    if angle is None and not said.has("opposite"):
        looks = said.has("turning", "facing", "shortest")
        looks |= said.has("back", "anew") and not said.has(*_SPOTS)
        return [Face(wrap_angle(base_rad), frame="odom")] if looks else None
    off_rad = math.pi
    if angle is not None:
        turn = in_unit_before(angle, Turn(1.0), 0.0)
        if turn.value not in ("angle", "turns") or said.has("opposite"):
            return None
        off_rad = turn.number if said.has("left") else -turn.number
    by_rad = wrap_angle(base_rad + off_rad - context.state.pose.yaw_rad)
    is_half = abs(abs(by_rad) - math.pi) < _NEAR_RAD
    left = said.has("left") if is_half else by_rad > 0
    turned = Turn(math.radians(round(math.degrees(abs(by_rad)), 1)), left=left)
    return [turned] if abs(by_rad) > _NEAR_RAD else None


def _base_rad(said: Said, dialogue: Dialogue) -> float | None:
    """The heading of the start, or that before the last turn; None where not one of them is said, or nothing turned."""
    named = [heading for heading in HEADINGS if said.has(heading)]
    if len(named) != 1:
        return None
    if named[0].startswith("first"):
        return dialogue.start_pose.yaw_rad
    turned = (
        entry.before.yaw_rad
        for entry in reversed(dialogue.ledger.done)
        if any(isinstance(step, (Turn, Arc, Face)) for step in entry.way or ())
    )
    return next(turned, None)


def told_place(said: Said, context: Context, unit_m: float) -> list[Step] | None:
    """`You should be 80 cm in front of the start, not behind it`: straight, where that leads there."""
    named, far = [place for place in PLACES if said.has(place)], said.amount("amount")
    if len(named) != 1 or far is None or not said.only("amount") or said.factors or said.has(*SUMS):
        return None
    length = in_unit_before(far, Drive(1.0), unit_m)
    if length.value != "length" or not said.has("want", "wish", "standing", "there", "driving", "going"):
        return None
    along, start, here = _SIDES_RAD[named[0]], context.dialogue.start_pose, context.state.pose
    goal = start.compose(Pose(length.number * math.cos(along), length.number * math.sin(along)))
    seen = goal.relative_to(here)
    is_on_line = abs(seen.y_m) < _NEAR_M and abs(wrap_angle(here.yaw_rad - start.yaw_rad)) < _NEAR_RAD
    if is_on_line and abs(seen.x_m) > _NEAR_M:
        return [Drive(round(abs(seen.x_m), 3), direction_rad=0.0 if seen.x_m > 0 else math.pi)]
    return [Go(round(goal.x_m, 3) + 0.0, round(goal.y_m, 3) + 0.0, frame="odom")]  # no -0
