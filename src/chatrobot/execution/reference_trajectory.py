"""The reference trajectory: where the robot should be at every moment of a plan, and how far it has been driven."""

from __future__ import annotations

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.plan.lowering import PlannedMotion
from chatrobot.plan.speed_scaling import SpeedScaling
from chatrobot.plan.split import Reached
from chatrobot.plan.trajectory import Pause, RampedTwist, Segment
from chatrobot.robots.profile import Limits


class ReferenceTrajectory:
    """The motions of a plan on the clock, each from where the one before it should have ended.

    Args:
        reference: the pose the plan begins at; all poses are in its frame.
    """

    def __init__(self, reference: Pose) -> None:
        self.reference = reference
        """Where the robot should be between two motions."""
        self.segment: Segment | None = None
        self.scaling: SpeedScaling | None = None
        """How much faster or slower than planned; None as planned."""
        self.began_s = 0.0
        """When the motion under way began."""
        self.is_correcting = False
        """Whether the motion under way, or the last one, leads back to the reference, and is no part of the plan."""
        self._done_m = self._done_rad = 0.0
        self._last: tuple[Segment, float] | None = None

    @property
    def has_moved(self) -> bool:
        """Return True where a motion has been driven to its end."""
        return self._last is not None

    @property
    def planned(self) -> tuple[float, float]:
        """Return metres and radians, counter-clockwise positive, of all planned motions up to the one under way."""
        segment = None if self.is_correcting else self.segment
        under_way_m, under_way_rad = _extent(segment) if segment is not None else (0.0, 0.0)
        return self._done_m + under_way_m, self._done_rad + under_way_rad

    def begin(self, segment: Segment, now_s: float, *, is_correcting: bool = False) -> None:
        """Set out on `segment`, right from the end of the last motion."""
        self.is_correcting = is_correcting
        self.began_s = self.free_from_s(now_s)
        self.segment = segment

    def change(self, segment: Segment) -> None:
        """Go on otherwise: from here on the motion under way is `segment`, which was the same until now."""
        self.segment = segment

    def rescale(self, scaling: SpeedScaling, now_s: float, limits: Limits) -> None:
        """Be faster or slower with what comes, and from `now_s` on with the motion under way."""
        self.scaling = scaling if self.scaling is None else self.scaling.times(scaling)
        if self.segment is not None and not self.is_correcting:
            self.segment = scaling.segment(self.segment, now_s - self.began_s, limits)

    def wait(self, duration_s: float, now_s: float, seen: Pose | None) -> None:
        """Wait for a robot that something slows; not where it is `seen` ahead, for it rolled on until it had braked."""
        self.began_s += duration_s
        if self.segment is not None and seen is not None:
            reached_s = self.segment.ramp.time_at(self.segment.progress_at(seen))
            self.began_s = min(self.began_s, now_s - reached_s)

    def end(self) -> None:
        """End the motion under way: where it would ideally end, what follows begins, unless it was a correction."""
        planned, segment = self.planned, self.segment
        assert segment is not None
        self._last = (segment, self.began_s)
        if not self.is_correcting:
            self.reference = segment.end_pose
        (self._done_m, self._done_rad), self.segment = planned, None

    def free_from_s(self, now_s: float) -> float:
        """Return when the last motion ended, if that was within this tick: so that no time is lost between steps."""
        if self._last is None:
            return now_s
        segment, began_s = self._last
        ended_s = began_s + segment.total_s
        return ended_s if 0.0 <= now_s - ended_s < TICK_S else now_s

    def at(self, stamp_s: float) -> Pose:
        """Return where the robot should have been at `stamp_s`, in the motion under way or the one before it."""
        if self.segment is not None and stamp_s >= self.began_s:
            return self.segment.at(stamp_s - self.began_s)[0]
        if self._last is not None:
            segment, began_s = self._last
            return segment.at(stamp_s - began_s)[0] if stamp_s - began_s < segment.total_s else self.reference
        return self.segment.start if self.segment is not None else self.reference


def _extent(segment: Segment) -> tuple[float, float]:
    twist, hold_s = segment.motion.twist, segment.ramp.hold_s
    return twist.speed_mps * hold_s, twist.wz_radps * hold_s


class Tally:
    """Counts how far a plan has been driven, as its motions begin and end, and measures the one under way.

    Corrective motions do not count.
    """

    def __init__(self) -> None:
        self._item: PlannedMotion | None = None
        self._segment: Segment | None = None
        self._waited_s = 0.0
        self._steps_done = 0
        self._motions_done = 0
        self._early: dict[int, float] = {}
        self._step_start = ORIGIN

    def begin(self, item: PlannedMotion) -> None:
        """Begin that motion."""
        self._item = item
        self._waited_s = 0.0
        if item.first:
            self._motions_done = 0
            self._step_start = item.start
        motion = item.motion
        self._segment = Segment(motion, item.start) if isinstance(motion, RampedTwist) else None

    def wait(self, waited_s: float) -> None:
        """Note how long the pause under way has lasted."""
        self._waited_s = waited_s

    def end(self, share: float | None = None) -> None:
        """End the motion under way, after that share of it, 0 to 1, where something may have ended it early."""
        item = self._item
        if item is None:
            return
        motion = item.motion
        if share is not None and isinstance(motion, RampedTwist) and motion.until is not None:
            self._early[item.number] = share
        self._motions_done += 1
        if item.last:
            self._steps_done = item.number
        self._item = self._segment = None

    def reached(self, pose: Pose) -> Reached:
        """Return how far it is, the robot being at `pose`, as odometry measured it."""
        item = self._item
        number = item.number if item is not None else 0
        is_under_way = number > self._steps_done or (self._motions_done > 0 and item is None)
        return Reached(
            self._steps_done,
            is_under_way,
            self._motions_done,
            self._share(pose),
            self._step_start,
            dict(self._early),
        )

    def _share(self, pose: Pose) -> float:
        motion = self._item.motion if self._item is not None else None
        if self._segment is not None:
            share = self._segment.progress_at(pose) / self._segment.motion.hold_s
        elif isinstance(motion, Pause):
            share = self._waited_s / motion.duration_s
        else:
            return 0.0
        return max(0.0, min(1.0, share))
