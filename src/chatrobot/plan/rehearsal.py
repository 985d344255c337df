"""Drives a plan in thought, before a wheel turns: the same walk, the same trajectory, the same governor.

What comes out is where the robot would be at every moment, how long it takes, and whether anything speaks against
it: something in the way of the swept footprint, a way out of the allowed area, a step this robot cannot do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason, Value
from chatrobot.plan.base import Plan
from chatrobot.plan.context import (
    MAX_DURATION_S,
    MAX_EXTENT_M,
    Finding,
    Impossible,
    LoweringContext,
    RoutePlanner,
    Severity,
    too_far,
    too_long,
)
from chatrobot.plan.fenced_path import Fence, FenceRuleOf, nothing_passes, outside_m, way_out
from chatrobot.plan.free_part import Leg, leg_at, nearest_part, part_up_to, with_room
from chatrobot.plan.known_world import Contact, Floats, GovernorKernel, KnownWorld, SeenWorld, obstacle_values
from chatrobot.plan.lowering import CoreWalk, PlannedMotion
from chatrobot.plan.rounding import Rounded, round_corners
from chatrobot.plan.steps import Drive
from chatrobot.plan.swept_path import (
    ANY_WAY,
    GovernorCheck,
    Most,
    first_contact,
    free_ahead_m,
    pose_of,
    sample_poses,
    sample_ramp,
    tick_times,
)
from chatrobot.plan.trajectory import Pause, RampedTwist, Segment
from chatrobot.robots.profile import RobotProfile

MARGIN_M = 0.04
"""A little more than the governor keeps from what the lidar sees, so that what was rehearsed is not stopped."""
PAUSE_SPACING_S = 0.05
STUCK_WITHIN_M = 0.01
"""What is so near lets a plan not even begin."""
KNOWN_WITHIN_M = 0.15
"""What was seen so near to a known obstacle is that obstacle."""


@dataclass(frozen=True, eq=False)
class RehearsedPath:
    """Predicts where a robot would be at every moment, and holds what was found about that.

    `path` is [n, 4] of t_s, x_m, y_m, yaw_rad in the odom frame, at most 50 ms apart.
    """

    path: Floats
    length_m: float
    findings: tuple[Finding, ...]

    @property
    def ok(self) -> bool:
        """Return True where nothing was found that refuses it."""
        return self.refusal is None

    @property
    def refusal(self) -> Finding | None:
        """Return the first finding that refuses it; None where none does."""
        return next((finding for finding in self.findings if finding.severity == "refuse"), None)

    @property
    def duration_s(self) -> float:
        """Return how long it takes, seconds."""
        return float(self.path[-1, 0])

    @property
    def end_pose(self) -> Pose:
        """Return the predicted pose at the end, in the odom frame."""
        return pose_of(self.path[-1])


@dataclass(frozen=True, eq=False)
class Rehearsal(RehearsedPath):
    """Predicts what a plan would do; its path ends where it ends, or at the first step that cannot be done.

    `plan` is the one to run (corners may have been rounded for a base that steers). `possible` is what can be done of
    a plan that is refused, or else drives more than it may, where that is worth a question; of one that cannot even
    begin to turn or to find a way, all of it after a short drive away from what stands there.
    """

    plan: Plan
    context: LoweringContext
    possible: Plan | None = None


def rehearse(
    plan: Plan,
    profile: RobotProfile,
    world: KnownWorld | None,
    start_pose: Pose,
    governor: GovernorKernel,
    *,
    plan_start: Pose | None = None,
    route_planner: RoutePlanner | None = None,
    seen: SeenWorld | None = None,
    most: Most = ANY_WAY,
    fence_rule: FenceRuleOf = nothing_passes,
) -> Rehearsal:
    """Rehearse `plan` from `start_pose` (odom frame).

    Args:
        world: what is known to stand around; None where nothing is.
        governor: what will stand between executor and robot; its kernel, made for this profile.
        plan_start: what the frame `start` means, if the plan is the continuation of one that began elsewhere.
        route_planner: for `go`; by default a grid search in `world`.
        seen: what the lidar has seen; None where there is none.
        most: how far and how long a plan may drive; what is `possible` of one that drives more is told.
        fence_rule: what the governor allows at a fence, for a robot that stands outside it.
    """
    if route_planner is None and world is not None and not world.is_empty:
        from chatrobot.plan.route import GridRoutePlanner

        route_planner = GridRoutePlanner(world, profile)
    context = LoweringContext(profile, start_pose, plan_start or start_pose, route_planner)
    rounded = Rounded(plan) if profile.can_turn_on_the_spot else round_corners(plan, profile)
    run = _Run(rounded.plan, context, world, governor, seen, most, fence_rule)
    run.findings += rounded.findings
    if not any(finding.severity == "refuse" for finding in run.findings):
        run.drive()
    found = run.result()
    if not run.is_stuck or isinstance(plan.steps[0], Drive):
        return found
    again = partial(
        rehearse, profile=profile, world=world, start_pose=start_pose, governor=governor,
        plan_start=plan_start, route_planner=route_planner, seen=seen, most=most, fence_rule=fence_rule,
    )  # fmt: skip
    return replace(found, possible=with_room(plan, profile, lambda roomier: again(roomier).ok))


class _Run:
    """One rehearsal: walks the plan, collects rows and findings, then sweeps the footprint along all of it."""

    def __init__(
        self,
        plan: Plan,
        context: LoweringContext,
        world: KnownWorld | None,
        governor: GovernorKernel,
        seen: SeenWorld | None,
        most: Most,
        fence_rule: FenceRuleOf,
    ) -> None:
        self.plan = plan
        self.context = context
        self.world = world if world is not None and not world.is_empty else None
        self.area = world.allowed_area if world is not None else None
        self.seen = seen
        self.most = most
        self.fence_rule = fence_rule
        self.governor = GovernorCheck(governor)
        self.findings: list[Finding] = []
        self.legs: list[Leg] = []
        self.t_s = 0.0
        self.possible: Plan | None = None
        self._blocked_row = math.inf
        self.is_stuck = False

    def drive(self) -> None:
        walk = CoreWalk(self.plan, self.context)
        for item in walk:
            if isinstance(item, Impossible):
                self._find("refuse", item.reason, item.index)
                self.possible = nearest_part(self.plan, self.context, item)
                break
            if not self._is_within_bounds(item):
                break
            if isinstance(item.motion, RampedTwist):
                self._move(walk, item, item.motion)
            elif isinstance(item.motion, Pause):
                times = self.t_s + tick_times(item.motion.duration_s, PAUSE_SPACING_S)
                self._add(item, np.column_stack((times, np.tile(item.start, (len(times), 1)))))
        self._sweep()

    def result(self) -> Rehearsal:
        rows = [np.array([[0.0, *self.context.pose]]), *(leg.rows for leg in self.legs)]
        path = np.concatenate(rows)
        length_m = float(np.hypot(*np.diff(path[:, 1:3], axis=0).T).sum())
        findings = tuple(sorted(self.findings, key=lambda finding: finding.t_s))
        return Rehearsal(path, length_m, findings, self.plan, self.context, self.possible)

    def _find(self, severity: Severity, reason: Reason, index: tuple[int, ...]) -> None:
        self.findings.append(Finding(severity, reason, index, self.t_s))

    def _is_within_bounds(self, item: PlannedMotion) -> bool:
        if isinstance(item.motion, RampedTwist):
            duration_s = Segment(item.motion, item.start).total_s
        else:
            duration_s = item.motion.duration_s if isinstance(item.motion, Pause) else 0.0
        if self.t_s + duration_s > MAX_DURATION_S:
            self._find("refuse", too_long(self.t_s + duration_s), item.index)
            return False
        distance_m = item.end.distance_to(self.context.pose)
        if distance_m > MAX_EXTENT_M:
            self._find("refuse", too_far(distance_m), item.index)
            return False
        return True

    def _add(self, item: PlannedMotion, rows: Floats) -> None:
        self.legs.append(Leg(item, rows))
        self.t_s = float(rows[-1, 0])

    def _move(self, walk: CoreWalk, item: PlannedMotion, motion: RampedTwist) -> None:
        segment = Segment(motion, item.start)
        if motion.until is not None:
            segment = self._until(segment, motion.until.distance_m, item)
            walk.ended_at(segment.end_pose)
        segment = self._slowed(segment)
        if motion.asked is not None:
            self._find("note", limited_reason(motion.asked, motion.twist), item.index)
        changed = self.governor.changed(segment)
        if changed is not None:
            sent, rows = changed
            self._find("note", limited_reason(motion.twist, sent), item.index)
            walk.ended_at(pose_of(rows[-1]))
        else:
            times = tick_times(segment.total_s, TICK_S)
            rows = np.column_stack((times, sample_poses(segment, sample_ramp(segment.ramp, times))))
        rows[:, 0] += self.t_s
        self._add(item, rows)

    def _slowed(self, segment: Segment) -> Segment:
        """Return the segment as slowly as the governor lets the robot go where its lidar does not see."""
        motion, share = segment.motion, 1.0
        if self.seen is not None:
            share = self.seen.allowed_share(motion.twist, segment.start)
        if not 0.0 < share < 1.0:
            return segment
        twist, hold_s = motion.twist.scaled(share), segment.ramp.hold_s / share
        slower = replace(motion, twist=twist, hold_s=hold_s, ramp_per_s=motion.ramp_per_s / share)
        return Segment(slower, segment.start)

    def _until(self, segment: Segment, distance_m: float, item: PlannedMotion) -> Segment:
        """Return the segment as it will be if the lidar sees what is known and what it saw, and nothing else."""
        twist, lidar = segment.motion.twist, self.context.profile.lidar
        if lidar is not None:
            distance_m = min(distance_m, lidar.max_range_m)
        most_m = twist.speed_mps * segment.ramp.hold_s
        reach_m, direction_rad = most_m + distance_m, math.atan2(twist.vy_mps, twist.vx_mps)
        free_m = math.inf
        if self.world is not None:
            footprint, clearance = self.context.profile.footprint, self.world.clearance_m
            free_m = free_ahead_m(segment.start, footprint, direction_rad, clearance, reach_m)
        if self.seen is not None:
            free_m = min(free_m, self.seen.free_ahead_m(segment.start, direction_rad))
        free_m = math.inf if free_m >= reach_m else free_m
        if math.isinf(free_m):
            self._find("note", Reason("no_obstacle_known", {"distance_m": most_m}), item.index)
            return segment
        hold_s = max(0.0, free_m - distance_m) / twist.speed_mps
        cut = RampedTwist(twist, min(hold_s, segment.ramp.hold_s), segment.motion.ramp_per_s)
        return Segment(cut, segment.start)

    def _sweep(self) -> None:
        """Find where the footprint first comes too close to what is known, to what was seen, or leaves its area."""
        if not self.legs:
            return
        rows = np.concatenate([leg.rows for leg in self.legs])
        poses, footprint = rows[:, 1:], self.context.profile.footprint
        solid = [self.seen.first_contact(poses)] if self.seen is not None else []
        if self.world is not None:
            solid.append(first_contact(poses, footprint, self.world.clearance_m, MARGIN_M))
        self._block(rows, "would_collide", solid)
        self._stay_inside(rows)
        row = self.most.first_row_over(rows)
        if row < len(rows) and not any(finding.severity == "refuse" for finding in self.findings):
            self.possible, _ = part_up_to(self.plan, self.context, self.legs, row, self.most.length_m)

    def _stay_inside(self, rows: Floats) -> None:
        """Find where it leaves its area, or gets farther out; say that it stands outside, even where it comes back."""
        fences: list[Fence] = [self.area.points] if self.area is not None else []
        if self.context.profile.safety.fence is not None:
            fences.append(self.context.profile.safety.fence)
        footprint = self.context.profile.footprint
        found = [way_out(rows, footprint, fence, self.fence_rule) for fence in fences]
        first = min((way for way in found if way is not None), key=lambda way: way.contact.row, default=None)
        out_m = max((outside_m(self.context.pose, footprint, fence) for fence in fences), default=0.0)
        if first is not None and first.is_outside:
            self._block(rows, "outside_area", [first.contact], outside_m=out_m)
            return
        if out_m > 0.0:
            self.findings.append(Finding("note", Reason("stands_outside", {"outside_m": out_m})))
        if first is not None:
            self._block(rows, "leaves_area", [first.contact])

    def _block(self, rows: Floats, code: str, contacts: Sequence[Contact | None], **about: Value) -> None:
        """Refuse the plan for the first of the contacts, if there is one; `about`: what else its reason tells."""
        contact = min((found for found in contacts if found is not None), key=lambda c: c.row, default=None)
        if contact is None:
            return
        leg, first_row = leg_at(self.legs, contact.row)
        driven = np.hypot(*np.diff(rows[: contact.row + 1, 1:3], axis=0).T)
        values: dict[str, float | int | str] = {
            "distance_m": float(driven[first_row:].sum()),
            "total_m": float(driven.sum()),
            **about,
        }
        if contact.row < self._blocked_row:
            self._blocked_row = contact.row
            self.possible, free = part_up_to(self.plan, self.context, self.legs, contact.row)
            values.update(free)
        if code == "would_collide":
            self.is_stuck = self.possible is None and driven.sum() < STUCK_WITHIN_M
            values["margin_m"] = MARGIN_M
            values.update(obstacle_values(self._names_of(contact)))
        row = rows[contact.row]
        self.findings.append(Finding("refuse", Reason(code, values), leg.item.index, float(row[0])))

    def _names_of(self, contact: Contact) -> tuple[str, ...]:
        """Return the names of what stands there, if it is known."""
        if self.world is None:
            return ()
        is_known = self.world.clearance_m(np.array([[contact.x_m, contact.y_m]]))[0] < KNOWN_WITHIN_M
        return self.world.obstacle_names_at(contact.x_m, contact.y_m) if is_known else ()


def limited_reason(asked: Twist, possible: Twist) -> Reason:
    """Return the reason for a twist of which only a part is possible."""
    values: dict[str, float | int | str] = {
        "asked_mps": asked.speed_mps,
        "possible_mps": possible.speed_mps,
        "asked_radps": abs(asked.wz_radps),
        "possible_radps": abs(possible.wz_radps),
    }
    return Reason("limited", values)
