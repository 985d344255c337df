"""The governor: the one place where velocities become fit to be sent."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.core.governed import GovernedTwist, Mint, StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.governor.kernel import bounded, make_kernel
from chatrobot.governor.lease import Leases
from chatrobot.governor.obstacles import FREE, ObstacleRule
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import LaserScan

TICK_S = 0.02
"""The control period: 50 Hz."""

LONGEST_STEP_S = 2.0 * TICK_S
"""A late tick may not buy a bigger jump in velocity than this much time."""

LATE_MPS = 0.05
LATE_RADPS = 0.1
"""A ramp that is still this much above what the way allows is too late."""


@dataclass(frozen=True)
class Verdict:
    """What the governor made of a request. `asked` and `sent` differ where `action` is not `passed`.

    `allowed` is what the rules leave of `asked`; `sent` is on its way there as fast as the ramps allow.
    """

    action: Literal["passed", "limited", "refused"]
    rule: str
    asked: Twist
    sent: GovernedTwist
    allowed: Twist
    reason: Reason | None = None


class Governor:
    """Holds every velocity to the profile. Not thread-safe but for `latch`, which only ever stops.

    Args:
        profile: the limits; they come from a file a person wrote and are never widened here.
        epoch: the stop epoch shared with the transport.
    """

    def __init__(self, profile: RobotProfile, epoch: StopEpoch) -> None:
        self.leases = Leases()
        self._profile = profile
        self._kernel = make_kernel(profile)
        self._epoch = epoch
        self._mint = Mint()
        self._sent = ZERO_TWIST
        self._sent_at_s = -math.inf
        self._sent_epoch = epoch.value
        self._latch: Reason | None = None
        self._obstacles = ObstacleRule(profile)

    @property
    def latched(self) -> Reason | None:
        """Why and by whom the emergency stop is set; None where it is not."""
        return self._latch

    def latch(self, source: str, why: str) -> None:
        """Emergency stop: nothing moves until `release`."""
        self._latch = Reason("emergency_stop", {"source": source, "why": why})

    def release(self) -> None:
        self._latch = None

    def take_scan(self, scan: LaserScan, pose: Pose) -> None:
        """What the lidar saw when the robot stood at `pose` (of `odom`)."""
        self._obstacles.take(scan, pose)

    def govern(self, asked: Twist, lease_id: str, now_s: float, pose: Pose | None = None) -> Verdict:
        """What may be sent at `now_s` for `asked` under that lease, by a robot at `pose` (of `odom`, if known).

        After a stop, or after a pause, ramps begin at zero again.
        """
        epoch = self._epoch.value
        refusal = self._refusal(asked, lease_id, now_s)
        if refusal:
            return self._verdict("refused", refusal, asked, ZERO_TWIST, ZERO_TWIST, epoch, now_s)
        previous = self._sent if epoch == self._sent_epoch else ZERO_TWIST
        target = bounded(self._profile, asked)
        ruling = self._obstacles.judge(target, pose) if pose is not None else FREE
        if ruling.factor < 1.0:
            allowed = target.scaled(ruling.factor)
            slowed = self._brake(previous, allowed, now_s)
            return self._verdict("limited", "obstacle", asked, slowed, allowed, epoch, now_s, ruling.reason)
        sent = self._kernel(previous, asked, self._step_s(now_s))
        if sent == asked:
            return self._verdict("passed", "", asked, sent, target, epoch, now_s)
        rule = "speed" if not _close(target, asked) else "acceleration"
        return self._verdict("limited", rule, asked, sent, target, epoch, now_s)

    def _brake(self, previous: Twist, target: Twist, now_s: float) -> Twist:
        """Ramp to `target`; where the ramp would come too late, zero at once (zero is exempt from the ramp)."""
        sent = self._kernel(previous, target, self._step_s(now_s))
        too_fast = sent.speed_mps > target.speed_mps + LATE_MPS
        turns_too_fast = abs(sent.wz_radps) > abs(target.wz_radps) + LATE_RADPS
        return ZERO_TWIST if too_fast or turns_too_fast else sent

    def _refusal(self, asked: Twist, lease_id: str, now_s: float) -> str:
        if self._latch is not None:
            return "emergency_stop"
        if not asked.is_finite:
            return "not_finite"
        if not self.leases.is_valid(lease_id, now_s):
            return "lease_lapsed"
        return ""

    def _step_s(self, now_s: float) -> float:
        """Seconds to ramp over. The first tick after standing counts as a whole period: it is driven by an event."""
        if self._sent.is_zero:
            return TICK_S
        return max(0.0, min(now_s - self._sent_at_s, LONGEST_STEP_S))

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
        return Verdict(action, rule, asked, self._mint.twist(sent, epoch), allowed, reason)


def _close(a: Twist, b: Twist) -> bool:
    return all(math.isclose(p, q, rel_tol=1e-6, abs_tol=1e-9) for p, q in zip(a, b))
