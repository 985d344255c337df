"""Keep Motion's accounts of the motion budget: what each text may drive, and what it has driven so far.

The budget comes from the profile and from the command line. While Motion runs, only the person at the local console
changes it. What an envelope, a plan, a model or a program says lowers it at most.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.core.reason import Reason
from chatrobot.execution.sensors import Sensors
from chatrobot.governor.lease import RELEASERS, Priority, priority_of
from chatrobot.plan.swept_path import Most
from chatrobot.robots.profile import OPEN_LOOP, Limits, MotionBudget, RobotProfile, read_limit

REACHED = frozenset(
    {"max_distance_reached", "max_time_reached", "open_loop_time_reached", "endless_program_stopped"}
)
"""The reasons of a motion that was stopped at its budget."""

KEPT_ACCOUNTS = 64
"""More turns than can be open at once."""

BRAKING_TICKS = 3
"""From the tick that asks for braking to the one that shows it."""

MEASURED_M, MEASURED_S = 0.01, 1.0
"""By how much more, besides that share, what was driven already may exceed what was planned for it."""

OLDEST_NEWS_S = 0.5
"""Odometry that is older ends the run."""

ROUNDING_M, ROUNDING_S = 1e-3, 1e-2
"""A rehearsed length that is longer by less is not longer."""

CEILING_LATE_S = 2.0 * TICK_S
"""What was rehearsed to end at the ceiling may end so much later: ticks do not come to the instant."""

TOLERANCE_SHARE, TOLERANCE_M, TOLERANCE_S = 0.02, 0.1, 5.0
"""How much more than it was rehearsed for a motion may drive and take: its rehearsal said that it fits."""


class Extent(NamedTuple):
    """How far and how long something drives, as far as that is certain; while it waits it does not drive."""

    length_m: float = 0.0
    driving_s: float = 0.0

    @property
    def planned(self) -> Extent:
        """Return what a plan for it was at least: odometry counts every correction, and each pause costs two ramps."""
        share = 1.0 - TOLERANCE_SHARE
        return Extent(
            max(0.0, share * self.length_m - MEASURED_M), max(0.0, share * self.driving_s - MEASURED_S)
        )

    def plus(self, other: Extent) -> Extent:
        """Return the sum of both."""
        return Extent(self.length_m + other.length_m, self.driving_s + other.driving_s)


class Account:
    """What one text has driven: every run of its turn is booked here; where it `is_shared`, those of all turns."""

    def __init__(self, budget: Callable[[], MotionBudget] = MotionBudget, *, is_shared: bool = False) -> None:
        self._budget = budget
        self._is_shared = is_shared
        self.driven = Extent()

    @property
    def budget(self) -> MotionBudget:
        """Return the budget that holds now."""
        return self._budget()

    def book(self, run: Extent) -> None:
        """Add what a run has driven."""
        self.driven = self.driven.plus(run)

    def renew(self) -> None:
        """Count anew: a person has ordered more."""
        self.driven = Extent()

    def refusal(self, extent: Extent) -> Reason | None:
        """Return why `extent` may not be driven on top of what has been driven."""
        total, budget, left = self.driven.planned.plus(extent), self.budget, self.left(Extent())
        if self._is_too_far(extent):
            if self._is_shared:
                values = {"distance_m": extent.length_m, "left_m": left.length_m, "max_m": budget.distance_m}
                return Reason("over_shared_distance", values)
            return Reason("over_max_distance", {"distance_m": total.length_m, "max_m": budget.distance_m})
        if total.driving_s > budget.time_s + ROUNDING_S:
            if self._is_shared and not budget.is_at_ceiling:
                values = {"driving_s": extent.driving_s, "left_s": left.driving_s, "max_s": budget.time_s}
                return Reason("over_shared_time", values)
            code = "over_open_loop_time" if budget.is_at_ceiling else "over_max_time"
            return Reason(code, {"driving_s": total.driving_s, "max_s": budget.time_s})
        return None

    def left(self, certain: Extent) -> Most:
        """Return what may be driven besides what has been driven, and `certain`."""
        used, budget = self.driven.planned.plus(certain), self.budget
        return Most(max(0.0, budget.distance_m - used.length_m), max(0.0, budget.time_s - used.driving_s))

    def notice(self, is_endless: bool) -> Reason | None:
        """Return when a program without an end will be stopped, for a person to know before it runs."""
        max_s = self.budget.endless_program_s
        if not is_endless or math.isinf(max_s):
            return None
        return Reason("endless_program_limit", {"max_s": max_s})

    def end(self, extent: Extent) -> Reason | None:
        """Return the `refusal` of what comes after a part that is driven already."""
        if self.refusal(extent) is None:
            return None
        return self.distance_reached() if self._is_too_far(extent) else self.time_reached()

    def _is_too_far(self, extent: Extent) -> bool:
        return self.driven.planned.plus(extent).length_m > self.budget.distance_m + ROUNDING_M

    def distance_reached(self) -> Reason:
        """Return the reason of a motion that was stopped at its distance."""
        return Reason("max_distance_reached", {"max_m": self.budget.distance_m})

    def time_reached(self) -> Reason:
        """Return the reason of a motion that was stopped at its time."""
        code = "open_loop_time_reached" if self.budget.is_at_ceiling else "max_time_reached"
        return Reason(code, {"max_s": self.budget.time_s})


class Meter:
    """Measures one run, and says when it has to brake so that its text stays within the budget.

    Args:
        known: what the run is certain to drive, asked each time: parts may be added. Empty where it is unknown.
        is_endless: it is a program whose rehearsal did not end.
    """

    def __init__(
        self,
        account: Account,
        known: Callable[[], Extent],
        sensors: Sensors,
        limits: Limits,
        now_s: float,
        *,
        is_endless: bool = False,
    ) -> None:
        self._account = account
        self._known = known
        self._sensors = sensors
        self._slowing_mps2 = min(limits.acceleration_mps2, limits.deceleration_mps2)
        self._latency_s = limits.latency_s + BRAKING_TICKS * TICK_S
        self._is_endless = is_endless
        self._began_s = self._now_s = now_s
        self._driving_s = 0.0
        self._start_path_m = self._path_m
        self._sent = ZERO_TWIST
        self.sent_m = self.sent_rad = 0.0
        """How far, and by how much to the left, it would have gone by what it was sent."""
        self._has_told = False

    @property
    def _path_m(self) -> float:
        return self._sensors.estimate.path_m if self._sensors.estimate is not None else 0.0

    @property
    def extent(self) -> Extent:
        """Return how far and how long this run has driven: as measured, or as sent where nothing is measured."""
        driven_m = self._path_m - self._start_path_m if self._sensors.has_odometry else self.sent_m
        return Extent(driven_m, self._driving_s)

    @property
    def least_s(self) -> float:
        """Return how long it was told to move at least: what was sent is held until something else is."""
        return 0.0 if self._sent.is_zero else TICK_S

    def note(self, sent: Twist, now_s: float) -> None:
        """Take in what was sent now."""
        elapsed_s = max(0.0, now_s - self._now_s)
        self.sent_m += self._sent.speed_mps * elapsed_s
        self.sent_rad += self._sent.wz_radps * elapsed_s
        self._driving_s += 0.0 if self._sent.is_zero else elapsed_s
        self._sent, self._now_s = sent, now_s

    def over(self) -> Reason | None:
        """Return why the robot has to brake now; once."""
        reason = None if self._has_told else self._over()
        self._has_told = self._has_told or reason is not None
        return reason

    def _over(self) -> Reason | None:
        account, budget = self._account, self._account.budget
        driven, known = account.driven.plus(self.extent), account.driven.planned.plus(self._known())
        estimate = self._sensors.estimate
        seen_mps = estimate.twist.speed_mps if estimate is not None else 0.0
        speed_mps = max(seen_mps, self._sent.speed_mps)
        braking_s = speed_mps / self._slowing_mps2
        unseen_s = min(self._sensors.odometry_age_s(), OLDEST_NEWS_S) if self._sensors.has_odometry else 0.0
        braking_m = speed_mps * (unseen_s + self._latency_s + braking_s / 2.0)
        most_m = _with_tolerance(budget.distance_m + ROUNDING_M, known.length_m, TOLERANCE_M)
        most_s = _with_tolerance(budget.time_s + ROUNDING_S, known.driving_s, TOLERANCE_S)
        most_s = min(most_s, budget.ceiling_s + CEILING_LATE_S)
        if driven.length_m + braking_m > most_m:
            return account.distance_reached()
        if self._is_endless and self._now_s - self._began_s + braking_s > budget.endless_program_s:
            return Reason("endless_program_stopped", {"max_s": budget.endless_program_s})
        if driven.driving_s + braking_s > most_s:
            return account.time_reached()
        return None

    def close(self) -> None:
        """Book the run, which is over."""
        self._account.book(self.extent)


def _with_tolerance(limit: float, known: float, tolerance: float) -> float:
    """`limit`, with what a motion that was rehearsed to fit into it may need besides."""
    return limit if known > limit else max(limit, known * (1.0 + TOLERANCE_SHARE) + tolerance)


class Budgets:
    """Keeps the budget that holds, and the accounts of the texts. Belongs to the control thread."""

    def __init__(self, budget: MotionBudget) -> None:
        self.current = budget
        self._accounts: OrderedDict[tuple[str, int], Account] = OrderedDict()

    def account_of(self, source: str, lease: str, turn: int) -> Account:
        """Return the account of that turn. Whoever is no person has one for all turns: only a person orders more."""
        priority = priority_of(source)
        if priority == Priority.FOREIGN and turn == 0:
            return Account(lambda: self.current)  # a line of text without a sender, and without a turn
        key = (lease, turn if priority >= Priority.PLAN else 0)
        is_shared = priority < Priority.PLAN
        account = self._accounts.setdefault(key, Account(lambda: self.current, is_shared=is_shared))
        self._accounts.move_to_end(key)
        while len(self._accounts) > KEPT_ACCOUNTS:
            self._accounts.popitem(last=False)
        return account

    def change(self, source: str, payload: Mapping[str, Any]) -> Iterator[Reason]:
        """Do what a `limit` envelope asks, and yield what is to be told; an empty one only asks what holds."""
        choice = MotionBudget(*(_chosen(payload, name) for name in ("max_distance_m", "max_time_s")))
        if payload and source not in RELEASERS:
            yield Reason("limit_refused", {"source": source})
            return
        self.current = self.current.changed(choice)
        yield from said(self.current)


def said(budget: MotionBudget) -> Iterator[Reason]:
    """Yield the budget in reasons, one for each of its two limits."""
    if math.isinf(budget.distance_m):
        yield Reason("limit_no_distance")
    else:
        yield Reason("limit_distance", {"max_m": budget.distance_m})
    if math.isinf(budget.time_s):
        yield Reason("limit_no_time")
    else:
        values = {"max_s": budget.time_s, "endless_s": budget.endless_program_s}
        yield Reason("limit_time", values)


def open_loop_notice(profile: RobotProfile) -> Reason | None:
    """Return what a person should know of a robot that is driven open loop; None for any other."""
    if not profile.open_loop:
        return None
    limits, budget = profile.limits, profile.safety.budget
    values = {"speed_mps": limits.max_speed_mps, "rate_radps": limits.max_rate_radps, "max_s": budget.time_s}
    return Reason(OPEN_LOOP, values)


def _chosen(payload: Mapping[str, Any], name: str) -> float | None:
    return read_limit(payload[name]) if name in payload else None
