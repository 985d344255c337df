"""What can be done of a plan where one of its motions is blocked: all before it, the free part of that, or all of it
after a short drive away from what stands there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from chatrobot.core.geometry import Pose
from chatrobot.plan.base import Plan
from chatrobot.plan.context import Impossible, LoweringContext
from chatrobot.plan.known_world import Floats
from chatrobot.plan.lowering import PlannedMotion
from chatrobot.plan.split import Reached, split
from chatrobot.plan.steps import Drive
from chatrobot.plan.swept_path import STANDING
from chatrobot.plan.trajectory import CoreMotion, RampedTwist
from chatrobot.robots.profile import RobotProfile

SPARE_M = 0.01
"""What is offered ends so far before what is in the way, at least."""

STEP_M = 0.05
STEP_DEG = 5
"""Free amounts are rounded down to multiples of these."""

LEAST_M = 0.1
LEAST_DEG = 10
"""Less than this is not worth a question."""

ROOM_M = 0.2
"""Enough for the footprint of any profile to turn beside what it stood at."""


@dataclass(frozen=True)
class Leg:
    """Rows [n, 4] of a path that belong to one motion of one step."""

    item: PlannedMotion
    rows: Floats


def leg_at(legs: Sequence[Leg], row: int) -> tuple[Leg, int]:
    """Return the leg that this row of the whole path belongs to, and the first row of it."""
    ends = np.cumsum([len(leg.rows) for leg in legs])
    number = int(np.searchsorted(ends, row, side="right"))
    return legs[number], int(ends[number]) - len(legs[number].rows)


def part_up_to(
    plan: Plan, context: LoweringContext, legs: Sequence[Leg], row: int, most_m: float = math.inf
) -> tuple[Plan | None, dict[str, float]]:
    """Return the part of `plan` up to a row of its path, and how far the whole way is free, or how much of a turn.

    Args:
        context: from where the plan begins.
        most_m: nothing is in the way, but the whole path may lead no farther.

    Returns:
        None where nothing is worth a question; and `free_m` or `free_deg`, where there is some.
    """
    leg, first_row = leg_at(legs, row)
    rows = np.concatenate([leg.rows for leg in legs])[: row + 1]
    driven_m = float(np.hypot(*np.diff(rows[: first_row + 1, 1:3], axis=0).T).sum())
    of_step = [found.item for found in legs if found.item.number == leg.item.number]
    way = rows[first_row:]
    share, end_row, free = _free_share(leg.item.motion, way, most_m - driven_m)
    if "free_m" in free:
        free = {"free_m": round(driven_m + free["free_m"], 2)}
    here = Pose(*(float(value) for value in way[end_row, 1:]))
    if not free and here.distance_to(context.pose) < LEAST_M:
        return None, {}
    reached = Reached(leg.item.number - 1, True, of_step.index(leg.item), share, of_step[0].start)
    return split(plan.steps, reached, replace(context, pose=here)).executed, free


def with_room(plan: Plan, profile: RobotProfile, is_clear: Callable[[Plan], bool]) -> Plan | None:
    """Return `plan` after a drive of `ROOM_M`, backward first; None where no way is clear or it would be too long."""
    across = (math.pi / 2, -math.pi / 2) if profile.can_go_sideways else ()
    for direction_rad in (math.pi, 0.0, *across):
        try:
            roomier = Plan((Drive(ROOM_M, direction_rad=direction_rad), *plan.steps))
        except ValueError:  # it would be too long
            return None
        if is_clear(roomier):
            return roomier
    return None


def nearest_part(plan: Plan, context: LoweringContext, impossible: Impossible) -> Plan | None:
    """Return all that comes before an impossible step, and what can be done instead of it; None where nothing can."""
    if impossible.instead is None:
        return None
    before = split(plan.steps, Reached(impossible.number - 1), context).executed
    try:
        return Plan((*(before.steps if before is not None else ()), impossible.instead))
    except ValueError:  # it would be too long
        return None


def _free_share(motion: CoreMotion | None, way: Floats, most_m: float) -> tuple[float, int, dict[str, float]]:
    """Return the share of the motion that is free, the row of `way` where it ends, and the amount; 0 for too little."""
    if isinstance(motion, RampedTwist) and motion.twist.speed_mps > 0.0:
        driven_m = np.append(0.0, np.cumsum(np.hypot(*np.diff(way[:, 1:3], axis=0).T)))
        until_m = min(driven_m[-1] - SPARE_M if math.isinf(most_m) else driven_m[-1], most_m)
        steps = math.floor(until_m / STEP_M + STANDING)
        free_m = round(steps * STEP_M, 2)
        if free_m >= LEAST_M:
            share = min(1.0, free_m / (motion.twist.speed_mps * motion.hold_s))
            return share, int(np.searchsorted(driven_m, free_m, side="right")) - 1, {"free_m": free_m}
    elif isinstance(motion, RampedTwist):
        turned_deg = np.degrees(np.abs(way[:, 3] - way[0, 3]))
        free_deg = STEP_DEG * math.floor(float(turned_deg[-1]) / STEP_DEG)
        if free_deg >= LEAST_DEG:
            share = min(1.0, math.radians(free_deg) / (abs(motion.twist.wz_radps) * motion.hold_s))
            return share, int(np.searchsorted(turned_deg, free_deg, side="right")) - 1, {"free_deg": free_deg}
    return 0.0, 0, {}
