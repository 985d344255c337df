"""Where a path leads out of the area that a robot has to stay in: over its edge, or farther out from outside.

A robot that stands outside may come back. How it may is the governor's to say: its rule is asked along the path.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Union

import numpy as np

from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.plan.known_world import Contact, Floats
from chatrobot.plan.swept_path import closest, fence_clearance, first_contact, outline_points
from chatrobot.robots.profile import Circle, Point

Fence = Union[Circle, Sequence[Point]]
"""A circle, or the corners of a polygon, in the odom frame."""

FenceShare = Callable[[Twist, Pose], float]
"""(what is asked, in the robot's frame; its pose, in odom) -> the share of that, 0 to 1, that one fence allows."""

FenceRuleOf = Callable[[Fence], FenceShare]
"""Makes the governor's rule for one fence."""

OUTSIDE_M = 0.005
"""A robot that reaches less far over the edge stands at the edge, by all that odometry knows."""
SHRINKS_BY_M = 0.0005
"""The rule is asked where the path gets so much farther out; it minds a little more than that."""
AHEAD_ROWS = 150
"""And does so within so many rows: three seconds, farther than it takes to brake."""
_CHUNK_ROWS = 2000
_LEAST_S = 1e-6


class WayOut(NamedTuple):
    """Says where a path leads out; `is_outside`: it never came in before, and would get farther out."""

    contact: Contact
    is_outside: bool


def nothing_passes(_fence: Fence) -> FenceShare:
    """Return the rule of a governor that nobody knows: where it would have to be asked, a robot does not go."""
    return lambda _asked, _pose: 0.0


def outside_m(pose: Pose, footprint: Sequence[Point], fence: Fence) -> float:
    """Return how far the footprint reaches over the edge of a fence, metres; 0 inside and at the edge."""
    _, spare = closest(np.array([pose]), outline_points(footprint), fence_clearance(fence))
    return max(0.0, -float(spare[0])) if spare[0] < -OUTSIDE_M else 0.0


def way_out(rows: Floats, footprint: Sequence[Point], fence: Fence, rule_of: FenceRuleOf) -> WayOut | None:
    """Return the first of the rows [n, 4] of a path (t_s, x_m, y_m, yaw_rad, in odom) that leads out of a fence.

    Args:
        rule_of: how much the governor allows at a fence. Asked where a path that begins outside gets farther out, or
            comes nearer to the edge from inside.
    """
    poses, outline, clearance = rows[:, 1:], outline_points(footprint), fence_clearance(fence)
    if closest(poses[:1], outline, clearance)[1][0] > 0.0:
        contact = first_contact(poses, footprint, clearance, 0.0)
        return WayOut(contact, False) if contact is not None else None
    chunks = (poses[begin : begin + _CHUNK_ROWS] for begin in range(0, len(poses), _CHUNK_ROWS))
    spare = np.concatenate([closest(chunk, outline, clearance)[1] for chunk in chunks])
    row = _first_barred(rows, spare, rule_of(fence))
    if row is None:
        return None
    x_m, y_m = closest(poses[row : row + 1], outline, clearance)[0][0].tolist()
    return WayOut(Contact(row, x_m, y_m), bool(spare[: row + 1].max() < -OUTSIDE_M))


def _first_barred(rows: Floats, spare: Floats, share: FenceShare) -> int | None:
    """The first row at which nothing is allowed of the twist that leads on from there; `spare`: [n], at each row."""
    coming = np.append(spare, np.full(AHEAD_ROWS, np.inf))
    least = np.lib.stride_tricks.sliding_window_view(coming, AHEAD_ROWS + 1).min(axis=1)
    twists = _twists(rows)
    for row in np.flatnonzero(least < spare - SHRINKS_BY_M).tolist():
        asked = Twist(*twists[row].tolist())
        if asked != ZERO_TWIST and not share(asked, Pose(*rows[row, 1:].tolist())) > 0.0:
            return int(row)
    return None


def _twists(rows: Floats) -> Floats:
    """[n, 3]: from each row to the next, in the robot's frame; zero where no time passes, and at the end.

    On a curve the chord points along the mean of the headings at both ends.
    """
    steps = np.diff(rows, axis=0)
    lasts = steps[:, 0] > _LEAST_S
    yaw = rows[:-1, 3] + 0.5 * steps[:, 3]
    cos, sin, x, y = np.cos(yaw), np.sin(yaw), steps[:, 1], steps[:, 2]
    moved = np.stack([cos * x + sin * y, cos * y - sin * x, steps[:, 3]], axis=1)
    twists = np.zeros((len(rows), 3))
    twists[:-1][lasts] = moved[lasts] / steps[lasts, :1]
    return twists
