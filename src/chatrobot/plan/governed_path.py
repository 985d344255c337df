"""Runs the governor's kernel over a reference, tick by tick, and integrates what it lets through if it changes any."""

from __future__ import annotations

import numpy as np

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.plan.known_world import Floats, GovernorKernel
from chatrobot.plan.trajectory import Segment

_SAME = 1e-6
_STOPPED_TICKS = 500  # ten seconds to come to rest after the reference has


class GovernorCheck:
    """Asks a kernel about motions, each kind of motion once: the kernel is pure and every motion starts from rest."""

    def __init__(self, kernel: GovernorKernel) -> None:
        self._kernel = kernel
        self._passed: set[tuple[Twist, float, float]] = set()

    def changed(self, segment: Segment) -> tuple[Twist, Floats] | None:
        """None if every reference twist passes unchanged, as it should.

        Otherwise the slowest share of it that got through at full speed, and the integrated rows [n, 4] (t_s from
        0, x_m, y_m, yaw_rad) of what the governor would really send.
        """
        key = (segment.motion.twist, segment.ramp.hold_s, segment.ramp.k)
        if key in self._passed:
            return None
        if self._passes(segment):
            self._passed.add(key)
            return None
        return self._integrated(segment)

    def _passes(self, segment: Segment) -> bool:
        twist, ramp = segment.motion.twist, segment.ramp
        previous = ZERO_TWIST
        tick = 0
        while tick * TICK_S < ramp.total_s:
            tick += 1
            asked = twist.scaled(ramp.at(tick * TICK_S)[1])
            if not _same(self._kernel(previous, asked, TICK_S), asked):
                return False
            if asked == previous:  # level: a pure kernel says the same until the ramp down begins
                tick = max(tick, int(ramp.down_start_s / TICK_S) - 1)
            previous = asked
        return True

    def _integrated(self, segment: Segment) -> tuple[Twist, Floats]:
        ramp, twist = segment.ramp, segment.motion.twist
        pose, sent, fastest = segment.start, ZERO_TWIST, ZERO_TWIST
        rows: list[tuple[float, float, float, float]] = [(0.0, *pose)]
        tick, last_tick = 0, int(ramp.total_s / TICK_S) + _STOPPED_TICKS
        while tick * TICK_S < ramp.total_s or (not sent.is_zero and tick < last_tick):
            tick += 1
            sent = self._kernel(sent, twist.scaled(ramp.at(tick * TICK_S)[1]), TICK_S)
            pose = pose.moved(sent, TICK_S)
            fastest = max(fastest, sent, key=_size)
            rows.append((tick * TICK_S, *pose))
        return fastest, np.array(rows)


def _size(twist: Twist) -> float:
    return twist.speed_mps + abs(twist.wz_radps)


def _same(one: Twist, other: Twist) -> bool:
    return (
        abs(one.vx_mps - other.vx_mps) < _SAME
        and abs(one.vy_mps - other.vy_mps) < _SAME
        and abs(one.wz_radps - other.wz_radps) < _SAME
    )


def pose_of(row: Floats) -> Pose:
    """The pose in a row (t_s, x_m, y_m, yaw_rad)."""
    return Pose(float(row[1]), float(row[2]), float(row[3]))
