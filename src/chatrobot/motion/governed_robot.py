"""One robot as Motion has it: its sensors, the one way on which a velocity reaches it, and its telemetry."""

from __future__ import annotations

from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.core.governed import GovernedTwist
from chatrobot.core.reason import Reason
from chatrobot.execution.executor import RAMP_RULES
from chatrobot.execution.sensors import Sensors, freshness, sensor_fault, silence
from chatrobot.governor.governor import Governor, Verdict
from chatrobot.governor.rule import Sensed, silent_after_s
from chatrobot.motion.remembered_obstacles import RememberedObstacles, Sight
from chatrobot.motion.safety.stop import Transport
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import LaserScan

LATE_ODOMETRY = "odometry"
"""The rule in whose name we ask the governor for less than was wanted."""


class GovernedRobot:
    """Holds the robot's sensors and governor: whoever moves it begins, asks and sends through this."""

    def __init__(
        self, profile: RobotProfile, sensors: Sensors, governor: Governor, transport: Transport
    ) -> None:
        self.profile = profile
        self.sensors = sensors
        self.governor = governor
        self._transport = transport
        self._looked_at: LaserScan | None = None
        self.may_move = False
        """A velocity that is none has been sent since it was last seen standing."""

    @property
    def pose(self) -> Pose:
        """Return where it is in `odom`, as far as it is known: the origin before it has said so."""
        estimate = self.sensors.estimate
        return estimate.pose if estimate is not None else ORIGIN

    def seen(self) -> RememberedObstacles | None:
        """Return what the lidar sees now, for a rehearsal; None where it says nothing of any plan."""
        points, sight = self.governor.seen_points, self._sight()
        return RememberedObstacles(self.profile, points, sight) if sight is not None or len(points) else None

    def _sight(self) -> Sight | None:
        """Where the governor will slow the robot down; None where its lidar looks all around, or has just begun."""
        lidar, look = self.profile.lidar, self.governor.latest_view
        due_s = silent_after_s(self.profile, "scan")
        is_silent = self.sensors.ages_s()["scan"] > due_s
        if lidar is None or (is_silent and self.sensors.awaits_first_scan(due_s)):
            return None
        if not is_silent and (look is None or look.is_all_around):
            return None
        return Sight(self.profile, lidar, None if is_silent else look)

    def begin(self, lease: str, now_s: float) -> Reason | None:
        """Have that lease take command for a new motion; return why it may not."""
        return self.governor.begin(lease, now_s, self._sensed()).refusal

    def govern(self, asked: Twist, lease: str, now_s: float) -> Verdict:
        """Return what may be sent of `asked`, to a robot that is by now where odometry saw it going.

        With news that grows old it goes slower, and stands where nobody sees any more where it goes.
        """
        share = freshness(self.sensors)
        may_ask = asked.scaled(share) if share < 1.0 else asked
        verdict = self.governor.govern(may_ask, lease, now_s, self.sensors.pose_now(), self._sensed())
        if share == 1.0 or verdict.action == "refused" or verdict.rule not in RAMP_RULES:
            return verdict
        silent = silence(self.sensors)
        return verdict._replace(action="limited", rule=LATE_ODOMETRY, asked=asked, reason=silent)

    def fault(self) -> Reason | None:
        """Return why nobody sees any more where it goes."""
        return sensor_fault(self.sensors)

    def send(self, verdict: Verdict) -> None:
        """Send what was allowed, unless a stop came since."""
        self._send(verdict.sent)

    def send_zero(self, now_s: float) -> None:
        """Send a zero in nobody's name: it is exempt from every rule."""
        self._send(self.governor.govern(ZERO_TWIST, "", now_s).sent)

    def _send(self, governed: GovernedTwist) -> None:
        """What it is told counts as told from before it moves, and until after it was told to stand."""
        if not governed.twist.is_zero:
            self.may_move = True
            self.sensors.note_sent(governed.twist)
        self._transport.send(governed)
        if governed.twist.is_zero:
            self.sensors.note_sent(governed.twist)

    def look(self) -> None:
        """Show the governor what the lidar has seen since the last time."""
        scan = self.sensors.scan
        if scan is None or scan is self._looked_at:
            return
        self._looked_at = scan
        pose = self.sensors.estimator.pose_at(scan.stamp_s)
        if pose is not None:
            self.governor.take_scan(scan, pose)

    def _sensed(self) -> Sensed:
        """What the governor's rules want to know of the sensors."""
        return Sensed(self.sensors.ages_s(), self.sensors.battery_percent)
