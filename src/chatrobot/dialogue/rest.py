"""Whether the robot still stands where our last turn left it: what was done before can be undone only then."""

from __future__ import annotations

from chatrobot.core.events import Finished, Telemetry
from chatrobot.core.geometry import Pose
from chatrobot.link.motion_link import LAPSES_AFTER_M, LAPSES_AFTER_RAD

MOVED = "cannot_undo_moved"
ODOMETRY_ANEW = "cannot_undo_odometry_anew"


class RestWatch:
    """Watches whether the robot still stands where our last turn left it, and in the same odometry.

    Each method returns why what was done before cannot be undone any more: a code, empty while it can.
    """

    def __init__(self) -> None:
        self._rest: Pose | None = None
        self._odometry_epoch: int | None = None

    def hear(self, event: Telemetry, *, is_ours: bool) -> str:
        """Compare where the robot is. `is_ours`: a turn of ours moves it, or may."""
        before, self._odometry_epoch = self._odometry_epoch, event.odometry_epoch
        if before is not None and before != event.odometry_epoch:
            return ODOMETRY_ANEW
        return "" if is_ours else self._displaced(event.pose)

    def begin(self, finished: Finished) -> str:
        """Compare where the robot was when the turn that has ended began."""
        return self._displaced(finished.start)

    def end(self, finished: Finished) -> str:
        """Note where a turn has ended, and whether somebody else drives on."""
        self._rest = finished.pose
        handed_over = finished.reason is not None and finished.reason.code == "handed_over"
        return MOVED if handed_over else ""

    def _displaced(self, pose: Pose) -> str:
        rest = self._rest
        if rest is None:
            return ""
        off_rad = abs(pose.yaw_rad - rest.yaw_rad)
        return MOVED if pose.distance_to(rest) > LAPSES_AFTER_M or off_rad > LAPSES_AFTER_RAD else ""
