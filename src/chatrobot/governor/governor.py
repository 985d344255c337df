"""The governor: the one place where velocities become fit to be sent."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import Literal, NamedTuple

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.core.governed import GovernedTwist, Mint, StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.governor.kernel import JerkLimit, bounded, make_kernel
from chatrobot.governor.lease import RELEASERS, CommandArbiter, Handover, Leases
from chatrobot.governor.obstacle_memory import NO_POINTS, Floats, LidarView, ObstacleMemory
from chatrobot.governor.rule import (
    NOTHING_SENSED,
    BatteryRule,
    Composed,
    NarrowedRule,
    Rule,
    Sensed,
    SensorRule,
    Situation,
    compose,
)
from chatrobot.governor.space_rules import BlindRule, FenceRule, ObstacleRule
from chatrobot.robots.open_loop import OPEN_LOOP_MPS, OPEN_LOOP_RADPS
from chatrobot.robots.profile import Point, RobotProfile
from chatrobot.wire.messages import LaserScan

LONGEST_STEP_S = 2.0 * TICK_S
"""A late tick may not buy a bigger jump in velocity than this much time."""

LATE_MPS = 0.05
LATE_RADPS = 0.1
"""A ramp that is still this much above what the way allows is too late."""

FARTHEST = 1e6
"""Metres, and radians: a pose beyond it (or one of no numbers) is as good as none."""

LATE_BEAT = "late_beat"
"""The rule in whose name a source whose heartbeat is late is slowed."""

VOID_EPOCH = -1
"""No stop epoch has this number: what carries it is never sent."""


class Verdict(NamedTuple):
    """Tells what the governor made of a request. `asked` and `sent` differ where `action` is not `passed`.

    `allowed` is what the rules leave of `asked`; `sent` is on its way there as fast as the ramps allow. A refusal
    carries a zero to send, but for `outranked`: another drives, and nothing is to be sent.
    """

    action: Literal["passed", "limited", "refused"]
    rule: str
    asked: Twist
    sent: GovernedTwist
    allowed: Twist
    reason: Reason | None = None


def make_rules(
    profile: RobotProfile, seen: ObstacleMemory | None = None, area: Sequence[Point] | None = None
) -> list[Rule]:
    """Return the rules that apply to one robot; a new rule is added here.

    Args:
        area: the corners of the area that the world allows, in `odom`.
    """
    safety = profile.safety
    rules: list[Rule] = []
    if safety.requires:
        rules.append(SensorRule(profile))
    if seen is not None:
        rules += [ObstacleRule(profile, seen), BlindRule(profile, seen)]
    if safety.fence is not None:
        rules.append(FenceRule(profile, safety.fence))
    if area:
        rules.append(FenceRule(profile, area))
    if safety.battery_low_percent is not None:
        rules.append(BatteryRule(profile, safety.battery_low_percent))
    return rules


class Governor:
    """Holds every velocity to the profile. Not thread-safe but for `latch`, which only ever stops.

    A source opens a lease, begins its motion, asks for velocities, and ends its motion. After a stop it has to
    begin again.

    Args:
        profile: the limits; they come from a file a person wrote and are never widened here.
        epoch: the stop epoch shared with the transport.
        area: corners, in `odom`, of the area that the world allows; None where it says nothing.
        releasers: the sources that may release an emergency stop.
    """

    def __init__(
        self,
        profile: RobotProfile,
        epoch: StopEpoch,
        area: Sequence[Point] | None = None,
        releasers: Collection[str] = RELEASERS,
    ) -> None:
        self.leases = Leases()
        self._profile = profile
        self._kernel = make_kernel(profile)
        self._jerk = JerkLimit(profile.limits)
        self._epoch = epoch
        self._mint = Mint()
        self._command_arbiter = CommandArbiter(self.leases, epoch)
        self._releasers = frozenset(releasers)
        self._sent = ZERO_TWIST
        self._sent_at_s = -math.inf
        self._sent_epoch = epoch.value
        self._latch: Reason | None = None
        self._obstacle_memory = ObstacleMemory(profile.lidar) if profile.lidar is not None else None
        self._narrowed = NarrowedRule()
        self._rules = [self._narrowed, *make_rules(profile, self._obstacle_memory, area)]
        if profile.open_loop:
            self.narrow(OPEN_LOOP_MPS, OPEN_LOOP_RADPS)

    # --- emergency stop ---

    @property
    def latched(self) -> Reason | None:
        """Return why and by whom the emergency stop is set; None where it is not."""
        return self._latch

    def latch(self, source: str, why: str) -> None:
        """Emergency stop: nothing moves until `release`. The first of several keeps its name on it."""
        if self._latch is None:
            self._latch = Reason("emergency_stop", {"source": source, "why": why})

    def release(self, source: str) -> bool:
        """Lift the emergency stop; False, and it stays, where `source` is not one of those who may."""
        if source not in self._releasers:
            return False
        self._latch = None
        return True

    # --- who drives ---

    def begin(self, lease_id: str, now_s: float, sensed: Sensed = NOTHING_SENSED) -> Handover:
        """Take command for a new motion: from nobody, or from a source of lower priority."""
        if self._latch is not None:
            return Handover(self._latch)
        if not (self._profile.has_odometry or self._profile.open_loop):
            return Handover(Reason("needs_open_loop"))
        if not self.leases.is_valid(lease_id, now_s):
            return Handover(Reason("lease_lapsed", {"source": self.leases.source_of(lease_id)}))
        barred = compose(self._rules, ZERO_TWIST, Situation(None, sensed, begins=True))
        if barred.ruling.factor < 1.0:
            return Handover(barred.ruling.reason)
        return self._command_arbiter.take(lease_id, now_s)

    def end(self, lease_id: str) -> None:
        """End that source's motion; nobody is in command."""
        self._command_arbiter.leave(lease_id)

    def narrow(self, speed_mps: float = math.inf, rate_radps: float = math.inf) -> None:
        """Allow at most these from now on. There is no way back: a limit can only shrink. Raises ValueError."""
        self._narrowed.narrow(speed_mps, rate_radps)

    # --- every tick ---

    @property
    def seen_points(self) -> Floats:
        """Return what the lidar sees around the robot and remembers, [n, 2] in `odom`."""
        return self._obstacle_memory.points if self._obstacle_memory is not None else NO_POINTS

    @property
    def latest_view(self) -> LidarView | None:
        """Return where the lidar looked with its latest scan."""
        return self._obstacle_memory.coverage.latest if self._obstacle_memory is not None else None

    def take_scan(self, scan: LaserScan, pose: Pose) -> None:
        """Take what the lidar saw when the robot stood at `pose` (of `odom`)."""
        if self._obstacle_memory is not None:
            self._obstacle_memory.take(scan, pose)

    def govern(
        self,
        asked: Twist,
        lease_id: str,
        now_s: float,
        pose: Pose | None = None,
        sensed: Sensed = NOTHING_SENSED,
    ) -> Verdict:
        """Return what may be sent at `now_s` for `asked` under that lease, by a robot at `pose` (of `odom`, if known).

        After a stop, or after a pause, ramps begin at zero again. With a heartbeat that is late it goes slower.
        """
        share = self.leases.share(lease_id, now_s)
        may_ask = asked.scaled(share) if 0.0 < share < 1.0 else asked
        verdict = self._judge(may_ask, lease_id, now_s, pose, sensed)
        if share == 1.0 or verdict.action == "refused":
            return verdict
        late = self.leases.lateness(lease_id, now_s)
        if share == 0.0:  # at once, as where the lease is over
            epoch = verdict.sent.epoch
            return self._verdict("limited", LATE_BEAT, asked, ZERO_TWIST, ZERO_TWIST, epoch, now_s, late)
        if verdict.reason is not None:  # a rule that allows even less
            return verdict
        return verdict._replace(action="limited", rule=LATE_BEAT, asked=asked, reason=late)

    def _judge(self, asked: Twist, lease_id: str, now_s: float, pose: Pose | None, sensed: Sensed) -> Verdict:
        epoch = self._epoch.value
        refusal = self._refusal(asked, lease_id, now_s)
        if refusal == "outranked":
            void = self._mint.twist(ZERO_TWIST, VOID_EPOCH)
            return Verdict("refused", refusal, asked, void, ZERO_TWIST)
        if refusal:
            return self._verdict("refused", refusal, asked, ZERO_TWIST, ZERO_TWIST, epoch, now_s)
        if pose is not None and not all(abs(number) <= FARTHEST for number in pose):
            pose = None
        if epoch != self._sent_epoch:  # a stop came since
            self._sent = ZERO_TWIST
            self._jerk.rest()
        target = bounded(self._profile, asked)
        ruled = compose(self._rules, target, Situation(pose, sensed))
        if ruled.rule:
            allowed = target.scaled(ruled.ruling.factor)
            slowed = self._brake(target, ruled, now_s)
            return self._verdict(
                "limited", ruled.rule, asked, slowed, allowed, epoch, now_s, ruled.ruling.reason
            )
        sent = self._ramped(target, now_s, urgent=False)
        if sent == asked:
            return self._verdict("passed", "", asked, sent, target, epoch, now_s)
        rule = "speed" if not _close(target, asked) else "acceleration"
        return self._verdict("limited", rule, asked, sent, target, epoch, now_s)

    def _brake(self, target: Twist, ruled: Composed, now_s: float) -> Twist:
        """Ramp to what is allowed; where that is urgent and comes too late, zero at once (exempt from the ramp)."""
        is_urgent = ruled.urgent_factor < 1.0
        sent = self._ramped(target.scaled(ruled.ruling.factor), now_s, urgent=is_urgent)
        if not is_urgent:
            return sent
        urgent = target.scaled(ruled.urgent_factor)
        too_fast = sent.speed_mps > urgent.speed_mps + LATE_MPS
        turns_too_fast = abs(sent.wz_radps) > abs(urgent.wz_radps) + LATE_RADPS
        return ZERO_TWIST if too_fast or turns_too_fast else sent

    def _ramped(self, target: Twist, now_s: float, *, urgent: bool) -> Twist:
        """As far from what was sent last to `target` (bounded) as acceleration and jerk allow by now."""
        previous, step_s = self._sent, self._step_s(now_s)
        wanted = self._kernel(previous, target, step_s)
        sent = self._jerk.eased(previous, wanted, target, step_s, urgent=urgent)
        self._jerk.note(previous, sent, step_s)
        return sent

    def _refusal(self, asked: Twist, lease_id: str, now_s: float) -> str:
        if self._latch is not None:
            return "emergency_stop"
        holder = self._command_arbiter.holder(now_s)
        if holder not in ("", lease_id):
            return "outranked"
        if not self.leases.is_valid(lease_id, now_s):
            return "lease_lapsed"
        if not asked.is_finite:
            return "not_finite"
        if holder != lease_id:
            return "not_begun"
        if not (math.isfinite(now_s) and self._sent_at_s <= now_s):
            return "clock_went_back"
        return ""

    def _step_s(self, now_s: float) -> float:
        """Seconds to ramp over. The first tick after standing counts as a whole period: it is driven by an event."""
        if self._sent.is_zero:
            return TICK_S
        return min(now_s - self._sent_at_s, LONGEST_STEP_S)

    def _verdict(
        self,
        action: Literal["passed", "limited", "refused"],
        rule: str,
        asked: Twist,
        sent: Twist,
        allowed: Twist,
        epoch: int,
        now_s: float,
        reason: Reason | None = None,
    ) -> Verdict:
        self._sent, self._sent_at_s, self._sent_epoch = sent, now_s, epoch
        if sent.is_zero:
            self._jerk.rest()
        return Verdict(action, rule, asked, self._mint.twist(sent, epoch), allowed, reason)


def _close(a: Twist, b: Twist) -> bool:
    return all(math.isclose(p, q, rel_tol=1e-6, abs_tol=1e-9) for p, q in zip(a, b))
