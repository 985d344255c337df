"""Whether the robot's own process has left the wire, so that nobody is left to hear a zero."""

from __future__ import annotations

from chatrobot.wire.wire import Wire

LOOK_S = 0.05

GONE_S = 0.3
"""A robot whose process has left the wire for this long hears no zero any more, and drives no motor over it."""


class Departure:
    """Since when the wire has listed no robot: nobody takes velocities, or nobody publishes the odometry.

    That proves something only where no network lies between, for a network that fails hides a robot that drives on; and
    only on a wire that discovers the others by itself. Elsewhere no departure is ever seen.

    Args:
        cmd_vel_topic: where the robot listens.
        odom_topic: where it publishes; empty where it has no odometry.
        is_near: the robot's process is on this machine.
    """

    def __init__(self, wire: Wire, cmd_vel_topic: str, odom_topic: str, *, is_near: bool) -> None:
        self._wire = wire if is_near and wire.sees_others_leave else None
        self._cmd_vel_topic = cmd_vel_topic
        self._odom_topic = odom_topic
        self._since_s: float | None = None
        self._next_look_s = 0.0

    def is_over(self, now_s: float) -> bool:
        """The robot has been gone for `GONE_S`, as far as it was looked for; False where that cannot be known."""
        if now_s >= self._next_look_s:
            self._next_look_s = now_s + LOOK_S
            self._look(now_s)
        return self._since_s is not None and now_s - self._since_s > GONE_S

    def _look(self, now_s: float) -> None:
        if self._wire is None or self._is_there(self._wire):
            self._since_s = None
        elif self._since_s is None:
            self._since_s = now_s

    def _is_there(self, wire: Wire) -> bool:
        ends = {(end.topic, end.role) for end in wire.survey()}
        if (wire.resolve(self._cmd_vel_topic), "listens") not in ends:
            return False
        return not self._odom_topic or (wire.resolve(self._odom_topic), "publishes") in ends
