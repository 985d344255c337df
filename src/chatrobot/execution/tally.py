"""How far a plan has been driven: counted as its motions begin and end, measured in the one that is under way."""

from __future__ import annotations

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.plan.core_motion import Pause, RampedTwist
from chatrobot.plan.lowering import PlannedMotion
from chatrobot.plan.split import Reached
from chatrobot.plan.trajectory import Segment


class Tally:
    """The executor tells it each motion of the plan as it begins and ends. Corrective motions do not count."""

    def __init__(self) -> None:
        self._item: PlannedMotion | None = None
        self._segment: Segment | None = None
        self._waited_s = 0.0
        self._steps_done = 0
        self._motions_done = 0
        self._early: dict[int, float] = {}
        self._step_start = ORIGIN

    def begin(self, item: PlannedMotion) -> None:
        """That motion comes next."""
        self._item = item
        self._waited_s = 0.0
        if item.first:
            self._motions_done = 0
            self._step_start = item.start
        motion = item.motion
        self._segment = Segment(motion, item.start) if isinstance(motion, RampedTwist) else None

    def wait(self, waited_s: float) -> None:
        """The pause under way has lasted so long."""
        self._waited_s = waited_s

    def end(self, hold_s: float | None = None) -> None:
        """The motion under way has come to its end, after so many seconds of its full twist."""
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
        """How far it is, the robot being at `pose`, as odometry measured it."""
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
