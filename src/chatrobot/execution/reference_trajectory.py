"""The reference trajectory: where the robot should be at every moment of a plan, on the motion under way, or at
the end of the last one."""

from __future__ import annotations

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Pose
from chatrobot.plan.trajectory import Segment


class ReferenceTrajectory:
    """The motions of a plan on the clock, each from where the one before it should have ended.

    Args:
        reference: the pose the plan begins at; all poses are in its frame.
    """

    def __init__(self, reference: Pose) -> None:
        self.reference = reference
        """Where the robot should be between two motions."""
        self.segment: Segment | None = None
        self._began_s = 0.0
        self._last: tuple[Segment, float] | None = None

    @property
    def has_moved(self) -> bool:
        """A motion has been driven to its end."""
        return self._last is not None

    @property
    def began_s(self) -> float:
        """When the motion under way began."""
        return self._began_s

    def begin(self, segment: Segment, now_s: float) -> None:
        """Set out on `segment`, right from the end of the last motion."""
        self._began_s = self.free_from_s(now_s)
        self.segment = segment

    def cut_short(self, segment: Segment) -> None:
        """The motion under way ends earlier: from here on it is `segment`."""
        self.segment = segment

    def wait(self, duration_s: float) -> None:
        """Something slows the robot: the reference waits for it."""
        self._began_s += duration_s

    def end(self, *, is_planned: bool) -> None:
        """The motion under way is over; `is_planned`: its ideal end is where what follows begins."""
        segment, self.segment = self.segment, None
        assert segment is not None
        self._last = (segment, self._began_s)
        if is_planned:
            self.reference = segment.end_pose

    def free_from_s(self, now_s: float) -> float:
        """When the last motion ended, if that was within this tick: so that no time is lost between steps."""
        if self._last is None:
            return now_s
        segment, began_s = self._last
        ended_s = began_s + segment.total_s
        return ended_s if 0.0 <= now_s - ended_s < TICK_S else now_s

    def at(self, stamp_s: float) -> Pose:
        """Where the robot should have been at `stamp_s`, in the motion under way or the one before it."""
        if self.segment is not None and stamp_s >= self._began_s:
            return self.segment.at(stamp_s - self._began_s)[0]
        if self._last is not None:
            segment, began_s = self._last
            return segment.at(stamp_s - began_s)[0] if stamp_s - began_s < segment.total_s else self.reference
        return self.segment.start if self.segment is not None else self.reference
