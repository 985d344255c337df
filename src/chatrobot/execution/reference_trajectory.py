"""The reference trajectory: where the robot should be at every moment of a plan, and how far it has been driven."""

from __future__ import annotations

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.plan.lowering import PlannedMotion
from chatrobot.plan.split import Reached
from chatrobot.plan.trajectory import Pause, RampedTwist, Segment


class ReferenceTrajectory:
    """The motions of a plan on the clock, each from where the one before it should have ended.

    Args:
        reference: the pose the plan begins at; all poses are in its frame.
    """

    def __init__(self, reference: Pose) -> None:
        self.reference = reference
        """Where the robot should be between two motions."""
        self.segment: Segment | None = None
        self.began_s = 0.0
        """When the motion under way began."""
        self._last: tuple[Segment, float] | None = None

    @property
    def has_moved(self) -> bool:
        """Return True where a motion has been driven to its end."""
        return self._last is not None

    def begin(self, segment: Segment, now_s: float) -> None:
        """Set out on `segment`, right from the end of the last motion."""
        self.began_s = self.free_from_s(now_s)
        self.segment = segment

    def cut_short(self, segment: Segment) -> None:
        """End the motion under way earlier: from here on it is `segment`."""
        self.segment = segment

    def wait(self, duration_s: float, now_s: float, seen: Pose | None) -> None:
        """Wait for a robot that something slows; not where it is `seen` ahead, for it rolled on until it had braked."""
        self.began_s += duration_s
        if self.segment is not None and seen is not None:
            reached_s = self.segment.ramp.time_at(self.segment.progress_at(seen))
            self.began_s = min(self.began_s, now_s - reached_s)

    def end(self, *, is_planned: bool) -> None:
        """End the motion under way; `is_planned`: its ideal end is where what follows begins."""
        segment, self.segment = self.segment, None
        assert segment is not None
        self._last = (segment, self.began_s)
        if is_planned:
            self.reference = segment.end_pose

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

    def end(self, hold_s: float | None = None) -> None:
        """End the motion under way, after so many seconds of its full twist."""
        item = self._item
        if item is None:
            return
        motion = item.motion
        if hold_s is not None and isinstance(motion, RampedTwist) and motion.until is not None:
            self._early[item.number] = hold_s / motion.hold_s
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
