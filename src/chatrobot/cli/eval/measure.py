"""A plan in numbers: what the true poses would show if it were driven perfectly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from chatrobot.core.geometry import ORIGIN, Twist
from chatrobot.plan.base import Step, expanded
from chatrobot.plan.context import Impossible, LoweringContext
from chatrobot.plan.lowering import CoreWalk, PlannedMotion
from chatrobot.plan.steps import Arc, Drive, Go, Plan, Turn
from chatrobot.plan.trajectory import Pause, Ramp, RampedTwist
from chatrobot.robots.profile import RobotProfile


@dataclass(frozen=True)
class Ideal:
    """A plan in numbers. A top speed or rate is None where no step tells one.

    `free_heading`: the plan does not say where the robot looks at the end. `routed`: how far the robot turns on its
    way is left to it.
    """

    x: float = 0.0
    y: float = 0.0
    turned_deg: float = 0.0
    rotation_deg: float = 0.0
    path_m: float = 0.0
    pause_s: float = 0.0
    max_speed: float | None = None
    max_turn_rate: float | None = None
    free_heading: bool = False
    routed: bool = False


def ideal(steps: Sequence[Step], profile: RobotProfile) -> Ideal | None:
    """Return the numbers of `steps` from the origin; None where this robot cannot do them."""
    if not steps:
        return Ideal()
    items: list[PlannedMotion] = []
    for item in CoreWalk(Plan(tuple(steps)), LoweringContext(profile, ORIGIN, ORIGIN, None)):
        if isinstance(item, Impossible):
            return None
        items.append(item)
    moves = [(item.motion, item.step) for item in items if isinstance(item.motion, RampedTwist)]
    tops = [(_top(motion), step) for motion, step in moves]
    last = next((item.step for item in reversed(items) if isinstance(item.motion, RampedTwist)), None)
    end = items[-1].end if items else ORIGIN
    tells_speed = any(getattr(step, "speed_mps", None) is not None for _, step in moves)
    tells_rate = any(getattr(step, "rate_radps", None) is not None for _, step in moves)
    return Ideal(
        x=end.x_m,
        y=end.y_m,
        turned_deg=math.degrees(end.yaw_rad),
        rotation_deg=math.degrees(sum(abs(motion.twist.wz_radps) * motion.hold_s for motion, _ in moves)),
        path_m=sum(motion.twist.speed_mps * motion.hold_s for motion, _ in moves),
        pause_s=_pauses_s(items),
        max_speed=max(top.speed_mps for top, _ in tops) if tells_speed else None,
        max_turn_rate=max(abs(top.wz_radps) for top, _ in tops) if tells_rate else None,
        free_heading=isinstance(last, Go) and last.yaw_rad is None,
        routed=any(isinstance(step, Go) for _, step in moves),
    )


def _top(motion: RampedTwist) -> Twist:
    return motion.twist.scaled(Ramp(motion.hold_s, motion.ramp_per_s).peak)


def _pauses_s(items: Sequence[PlannedMotion]) -> float:
    """Waits between motions: what comes before the first or after the last is no pause."""
    moving = [i for i, item in enumerate(items) if isinstance(item.motion, RampedTwist)]
    between = items[moving[0] : moving[-1]] if moving else []
    return sum(item.motion.duration_s for item in between if isinstance(item.motion, Pause))


def without_last_turn(steps: Sequence[Step]) -> list[Step] | None:
    """Return a shape without the turn back to its first heading; None where it ends on something else."""
    listed = list(expanded(steps))
    drawn = any(isinstance(step, (Drive, Arc)) for step in listed)
    return listed[:-1] if drawn and isinstance(listed[-1], Turn) else None
