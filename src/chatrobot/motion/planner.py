"""Makes of plan text something that may run: read, rehearsed from where the robot stands, in the known world."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from chatrobot.core.errors import PlanTextError
from chatrobot.core.events import Event, FindingSeen, Rehearsed
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.governor.kernel import make_kernel
from chatrobot.governor.space_rules import fence_rules
from chatrobot.motion.budgets import Extent
from chatrobot.motion.remembered_obstacles import RememberedObstacles, RoutesAroundObstacles, seen_but_unknown
from chatrobot.plan.context import RoutePlanner
from chatrobot.plan.known_world import Floats
from chatrobot.plan.rehearsal import Rehearsal, RehearsedPath, rehearse
from chatrobot.plan.route import GridRoutePlanner
from chatrobot.plan.steps import Plan
from chatrobot.plan.swept_path import ANY_WAY, Most
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.robots.profile import Point, RobotProfile
from chatrobot.sim.world import Obstacle, World

DRAWN_POINTS = 400
"""The path an event carries is thinned to about this many points: enough for any screen."""


@dataclass(frozen=True)
class Offer:
    """What can be done of a plan that is refused, rehearsed itself. `limits`: what the motion budget left for it."""

    plan: Plan | None = None
    limits: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Planned:
    """A plan that was rehearsed, or the reason why it could not even be read."""

    turn: int
    rehearsal: Rehearsal | None
    unreadable: Reason | None = None
    offer: Offer = Offer()

    @property
    def ok(self) -> bool:
        """True where it may run."""
        return self.rehearsal is not None and self.rehearsal.ok

    @property
    def refusal(self) -> Reason | None:
        """Return why it may not run."""
        if self.rehearsal is None:
            return self.unreadable
        found = self.rehearsal.refusal
        if found is None:
            return None
        return Reason(found.reason.code, {**found.reason.values, **self.offer.limits})

    @property
    def possible(self) -> str:
        """Return plan text of what can be done of a refused plan; empty where nothing is worth a question."""
        return format_plan(self.offer.plan) if self.offer.plan is not None else ""

    @property
    def shown(self) -> RehearsedPath | None:
        """Return what its rehearsal shows, of a plan or a program; None where it could not be read."""
        return self.rehearsal

    @property
    def duration_s(self) -> float:
        """Return how long it was rehearsed to last."""
        return self.shown.duration_s if self.shown is not None else 0.0

    @property
    def length_m(self) -> float:
        """Return how far it was rehearsed to drive."""
        return self.shown.length_m if self.shown is not None else 0.0

    @property
    def is_endless(self) -> bool:
        """True where it does not end by itself."""
        return False

    @property
    def is_open_ended(self) -> bool:
        """True where its length and duration are only those of its rehearsal."""
        return self.is_endless or bool(self._unknown_lengths_m)

    @cached_property
    def certain(self) -> Extent:
        """Return what it drives at least. Asked with every tick."""
        if self.is_endless:
            return Extent()
        length_m = max(0.0, self.length_m - sum(self._unknown_lengths_m))
        if self.is_open_ended or self.shown is None:
            return Extent(length_m, 0.0)
        return Extent(length_m, driving_s(self.shown.path))

    @property
    def _unknown_lengths_m(self) -> list[float]:
        """The longest ways up to obstacles that nobody knows of."""
        findings = self.rehearsal.findings if self.rehearsal is not None else ()
        reasons = (finding.reason for finding in findings if finding.reason.code == "no_obstacle_known")
        return [float(reason.values["distance_m"]) for reason in reasons]

    @property
    def has_findings(self) -> bool:
        """True where a person should look at it before it runs."""
        return False

    def events(self, needs_approval: bool) -> tuple[Event, ...]:
        """Return all that is told of it."""
        return (self.event(needs_approval),)

    def part_event(self, steps_before: int) -> Rehearsed:
        """Return its `event` as a part that goes on after so many steps of the same turn."""
        event = self.event(False)
        findings = tuple(replace(found, step=_later(found.step, steps_before)) for found in event.findings)
        return replace(event, findings=findings)

    def event(self, needs_approval: bool) -> Rehearsed:
        """Return what the displays show of it."""
        shown = self.shown
        if shown is None:
            return Rehearsed(self.turn, False, 0.0, 0.0, Pose())
        findings = tuple(
            FindingSeen(self.turn, found.severity, found.reason, tuple(i + 1 for i in found.index), found.t_s)
            for found in shown.findings
        )
        return Rehearsed(
            self.turn,
            self.ok,
            shown.duration_s,
            shown.length_m,
            shown.end_pose,
            findings,
            drawn(shown.path),
            needs_approval,
            self.is_open_ended,
        )


def refused(event: Event, reason: Reason | None) -> Event:
    """Return the event; where it shows a plan that may not run for `reason`, with that finding."""
    if reason is None or not isinstance(event, Rehearsed) or not event.ok:
        return event
    found = FindingSeen(event.turn, "refuse", reason)
    return replace(event, ok=False, findings=(*event.findings, found), needs_approval=False)


def driving_s(path: Floats) -> float:
    """Return how long the robot moves on a path whose rows ([n, 4]) begin with a time."""
    steps = np.diff(path, axis=0)
    return float(steps[np.any(np.abs(steps[:, 1:]) > 1e-9, axis=1), 0].sum())


def drawn(path: Floats) -> tuple[tuple[float, float, float], ...]:
    """Return x_m, y_m, yaw_rad of a path whose rows ([n, 4]) begin with a time; thinned, but for its end."""
    stride = max(1, len(path) // DRAWN_POINTS)
    rows = [*path[:-1:stride].tolist(), path[-1].tolist()]
    return tuple((row[1], row[2], row[3]) for row in rows)


def _later(step: tuple[int, ...], steps_before: int) -> tuple[int, ...]:
    """The path of a step that comes after so many others."""
    return (step[0] + steps_before, *step[1:]) if step else ()


class Planner:
    """Plans for one robot in one world. The first call for a furnished world computes its distance field."""

    def __init__(self, profile: RobotProfile, world: World) -> None:
        self._profile = profile
        self._kernel = make_kernel(profile)
        self._fence_rule = fence_rules(profile)
        self._base = world
        self._base_routes = None if world.is_empty else GridRoutePlanner(world, profile)
        self._known = world, self._base_routes
        self.added: tuple[Obstacle, ...] = ()
        """What was put into the world while a simulation runs."""

    def add(self, added: tuple[Obstacle, ...]) -> None:
        """Plan in the world with these obstacles from now on, instead of those that were added before."""
        self.added = added
        world, before = self._base.with_added(added), self._base_routes
        self._known = world, GridRoutePlanner(world, self._profile, before) if added else before

    @property
    def world(self) -> World:
        """Return what is known of the surroundings."""
        return self._known[0]

    @property
    def allowed_area(self) -> Sequence[Point] | None:
        """Return the corners, in `odom`, of where the world lets a robot be; None where it says nothing."""
        area = self._base.allowed_area
        return area.points if area is not None else None

    def plan(
        self,
        turn: int,
        plan_text: str,
        start: Pose,
        plan_start: Pose | None = None,
        seen: RememberedObstacles | None = None,
        left: Most = ANY_WAY,
    ) -> Planned:
        """Read and rehearse `plan_text` from `start` (odom frame). Never raises for what a person or model wrote.

        Args:
            plan_start: where the whole began that this is a part of, if it did not begin here.
            seen: what the governor knows by its lidar.
            left: of the motion budget: what is offered instead of a refused plan drives no more.
        """
        try:
            plan = parse_plan(plan_text)
        except PlanTextError as error:
            return Planned(turn, None, Reason("plan_text", {"problem": str(error)}))
        world, routes = self._known
        rehearsing = partial(
            rehearse,
            profile=self._profile,
            world=world,
            start_pose=start,
            governor=self._kernel,
            route_planner=routes if seen is None else self._around(seen, world, routes),
            seen=seen,
            fence_rule=self._fence_rule,
        )
        rehearsal = rehearsing(plan, plan_start=plan_start)
        if rehearsal.possible is None:
            return Planned(turn, rehearsal)
        return Planned(turn, rehearsal, offer=_offer(rehearsal.possible, rehearsing, left))

    def _around(
        self, seen: RememberedObstacles, world: World, routes: RoutePlanner | None
    ) -> RoutePlanner | None:
        """Finds ways around what was seen, too."""
        unknown = seen_but_unknown(world, seen.points)
        if not len(unknown):
            return routes
        return RoutesAroundObstacles(self._profile, world, unknown, routes)


def _offer(plan: Plan, rehearsing: Callable[..., Rehearsal], left: Most) -> Offer:
    """The plan, or the part of it that the budget allows; nothing where its own rehearsal refuses it."""
    whole = rehearsing(plan, most=left)
    if not whole.ok or left.allows(whole.path):
        return Offer(plan if whole.ok else None)
    is_too_far = not Most(left.length_m).allows(whole.path)
    limits = {"limit_m": round(left.length_m, 2)} if is_too_far else {"limit_s": round(left.driving_s, 1)}
    part = whole.possible
    over_s = driving_s(rehearsing(part).path) - left.driving_s if part is not None else 0.0
    if over_s > 0.0:  # to stop earlier takes time, too
        part = rehearsing(plan, most=Most(left.length_m, left.driving_s - over_s)).possible
    return Offer(part, limits)
