"""Rules about the space around the robot: brake before what the lidar sees, go slowly where it does not look, and stay
inside the fence."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.contact import (
    REACH_OF_CONTACT,
    SAMPLES,
    Floats,
    Footprint,
    comes_nearer,
    seconds_to_contact,
    seconds_until_below,
)
from chatrobot.governor.kernel import Braking
from chatrobot.governor.obstacle_memory import ObstacleMemory
from chatrobot.governor.rule import FREE, Ruling, Situation, silent_after_s
from chatrobot.plan.fenced_path import OUTSIDE_M, Fence, FenceRuleOf, FenceShare
from chatrobot.plan.swept_path import fence_clearance, outline_points, transformed
from chatrobot.robots.profile import Point, RobotProfile

MARGIN_M = 0.03
RELEASE_M = 0.03
"""A barred way must show this much more room than the margin before it counts as free again: lidars are noisy."""

AWAY_MPS = 0.05
"""A robot that is within the margin of something goes no faster than this, no corner of it."""

NEARER_M = 0.0002
"""And nothing comes nearer than the nearest thing is, but for this much on the way that it takes to brake."""


class ObstacleRule:
    """Scales a twist by what the lidar has seen in its way, in `odom`; what it never saw is `blind`'s business.

    A robot that is in contact, within the margin of something, may move away from it, slowly.
    """

    name = "obstacle"

    def __init__(self, profile: RobotProfile, seen: ObstacleMemory) -> None:
        self._limits = profile.limits
        self._footprint = Footprint(profile.footprint)
        self._obstacle_memory = seen
        self._barred = False

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        """Scale `asked` so that the robot can brake before what was seen."""
        if situation.begins:
            self._barred = False  # another motion: the way that was barred need not be its way
        pose = situation.pose
        if pose is None or asked.is_zero:
            return FREE
        braking, radius_m = Braking(self._limits, asked), self._footprint.radius_m
        reach_m = radius_m + MARGIN_M + RELEASE_M + asked.speed_mps * braking.horizon_s
        points = self._obstacle_memory.near(pose.x_m, pose.y_m, max(reach_m, REACH_OF_CONTACT * radius_m))
        if not len(points):
            self._barred = False
            return FREE
        cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        away = points - np.array([pose.x_m, pose.y_m])
        local = away @ np.array([[cos, -sin], [sin, cos]])
        nearest_m = self._footprint.nearest_m(local, MARGIN_M)
        if nearest_m <= MARGIN_M:
            return self._away(asked, local, nearest_m)
        margin_m = MARGIN_M + RELEASE_M if self._barred else MARGIN_M
        free_s = seconds_to_contact(self._footprint, local, asked, braking.horizon_s, margin_m)
        factor = braking.factor_within(free_s)
        self._barred = factor == 0.0
        if factor == 1.0:
            return FREE
        return Ruling(factor, Reason("obstacle_ahead", {"distance_m": round(free_s * asked.speed_mps, 2)}))

    def _away(self, asked: Twist, local: Floats, nearest_m: float) -> Ruling:
        """In contact: slowly, where the distance to what was seen does not shrink; else not at all.

        A wall is many points: along it those ahead come nearer, but no nearer than those beside the robot are.
        """
        fastest_mps = asked.speed_mps + abs(asked.wz_radps) * self._footprint.radius_m
        share = AWAY_MPS / fastest_mps if fastest_mps > AWAY_MPS else 1.0
        slow = asked.scaled(share)
        horizon_s = Braking(self._limits, slow).horizon_s
        self._barred = comes_nearer(self._footprint, local, slow, horizon_s, nearest_m, NEARER_M)
        if self._barred:
            return Ruling(0.0, Reason("obstacle_ahead", {"distance_m": 0.0}))
        if share == 1.0:
            return FREE
        return Ruling(share, Reason("in_contact", {"distance_m": round(nearest_m, 2), "speed_mps": AWAY_MPS}))


LOOK_AHEAD_S = 0.5
LOOK_AHEAD_M = 0.2
"""How far before the moving parts of the outline the lidar has to look: this long at their speed, and at least this."""

SHARES = np.linspace(0.2, 1.0, 5)
"""Of the way there, dimensionless, where it must have looked: what swings out may come by what was never seen."""

OUTWARDS_MPS = 0.02
OUTWARDS_M = 0.03
"""A side that comes out slower, or less far, needs no look: feedback swings the tail a little on any straight way."""


class BlindRule:
    """Slows a twist whose way lies, even in part, in a sector without beams, or whose lidar has fallen silent."""

    name = "blind"

    def __init__(self, profile: RobotProfile, seen: ObstacleMemory) -> None:
        self._speed_mps = profile.safety.blind_speed_mps
        points, normals = zip(*_outline(profile.footprint))
        self._x, self._y = np.array(points).T
        self._out_x, self._out_y = np.array(normals).T
        self._radius_m = profile.footprint_radius_m
        self._silent_s = silent_after_s(profile, "scan")
        self._obstacle_memory = seen

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        """Scale `asked` to the blind speed where its way was not seen."""
        fastest_mps = asked.speed_mps + abs(asked.wz_radps) * self._radius_m
        if fastest_mps <= self._speed_mps:
            return FREE
        # A scan says nothing without the pose it was made at.
        is_fresh = situation.sensed.ages_s.get("scan", math.inf) <= self._silent_s
        if is_fresh and situation.pose is not None and self._is_seen(asked, situation.pose):
            return FREE
        return Ruling(self._speed_mps / fastest_mps, Reason("not_seen", {"speed_mps": self._speed_mps}))

    def _is_seen(self, asked: Twist, pose: Pose) -> bool:
        """Return True where the lidar looks at the floor before every corner and every side that moves outwards.

        Where it leads to it must look now; at what lies before that it may have looked a moment ago.
        """
        coverage = self._obstacle_memory.coverage
        if coverage.latest is not None and coverage.latest.is_all_around:
            return True
        vx, vy = asked.vx_mps - asked.wz_radps * self._y, asked.vy_mps + asked.wz_radps * self._x
        out_mps = vx * self._out_x + vy * self._out_y
        moves = out_mps > OUTWARDS_MPS
        ahead_s = np.maximum(LOOK_AHEAD_S, LOOK_AHEAD_M / np.hypot(vx, vy)[moves])
        in_s = ahead_s[:, None] * SHARES
        x, y = self._x[moves, None] + vx[moves, None] * in_s, self._y[moves, None] + vy[moves, None] * in_s
        cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        ways = np.stack([pose.x_m + cos * x - sin * y, pose.y_m + sin * x + cos * y], axis=-1)
        comes_out = out_mps[moves, None] * in_s > OUTWARDS_M
        ends, before = ways[:, -1][comes_out[:, -1]], ways[:, :-1][comes_out[:, :-1]]
        return bool(coverage.covers_now(ends).all() and coverage.covered_lately(before).all())


def _outline(corners: Sequence[Point]) -> list[tuple[Point, Point]]:
    """Of every side its ends and its middle, each with the side's normal (of length 1) that looks outwards."""
    found = []
    for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]]):
        length = math.hypot(bx - ax, by - ay)
        normal = ((by - ay) / length, (ax - bx) / length)
        found += [(point, normal) for point in ((ax, ay), ((ax + bx) / 2.0, (ay + by) / 2.0), (bx, by))]
    return found


class FenceRule:
    """Keeps the robot inside; one that stands outside may only come nearer.

    Args:
        fence: a circle, or the corners of a polygon, in `odom`. It means nothing once odometry begins anew.
    """

    name = "fence"

    def __init__(self, profile: RobotProfile, fence: Fence) -> None:
        self._limits = profile.limits
        self._outline = outline_points(profile.footprint)
        self._radius_m = profile.footprint_radius_m
        self._clearance = fence_clearance(fence)
        self._known = (0.0, 0.0, -math.inf)
        """A point, x and y, and its clearance: a metre away from there it is at most a metre less."""

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        """Scale `asked` so that the robot can brake before the edge; refuse it without a pose."""
        pose = situation.pose
        if asked.is_zero:
            return FREE
        if pose is None:
            return Ruling(0.0, Reason("sensor_silent", {"sensor": "odom"}))
        braking = Braking(self._limits, asked)
        reach_m = asked.speed_mps * braking.horizon_s  # of its middle; however it turns, no corner is farther
        x_m, y_m, clear_m = self._known
        if clear_m - math.hypot(pose.x_m - x_m, pose.y_m - y_m) > self._radius_m + reach_m:
            return FREE
        clear_m = float(self._clearance(np.array([pose[:2]]))[0])
        self._known = (pose.x_m, pose.y_m, clear_m)
        if clear_m > self._radius_m + reach_m:
            return FREE
        times = np.linspace(0.0, braking.horizon_s, SAMPLES)
        poses = np.array([pose.moved(asked, time_s) for time_s in times.tolist()])
        placed = transformed(self._outline, poses).reshape(-1, 2)
        spare = self._clearance(placed).reshape(SAMPLES, -1).min(axis=1, keepdims=True)
        factor = braking.factor_within(seconds_until_below(spare, times, 0.0))
        return FREE if factor == 1.0 else Ruling(factor, _at_the_fence(float(spare[0, 0])))


def fence_rules(profile: RobotProfile) -> FenceRuleOf:
    """Return what makes the rule for a fence, as rehearsals of that robot ask it."""

    def rule_of(fence: Fence) -> FenceShare:
        rule = FenceRule(profile, fence)
        return lambda asked, pose: rule.judge(asked, Situation(pose)).factor

    return rule_of


def _at_the_fence(spare_m: float) -> Reason:
    """Why a robot that has so much to spare, or stands so far outside, may not go on."""
    if spare_m < -OUTSIDE_M:
        return Reason("outside_fence", {"distance_m": round(-spare_m, 2)})
    return Reason("leaves_fence", {"distance_m": round(max(0.0, spare_m), 2)})
