"""What the guard decides, on any clock, so that real time and simulated time run the same rule.

States: `idle` until Motion shakes hands, `watching` while beats come, `tripped` from a missed beat until Motion
shakes hands again. Only a trip sends anything. Once Motion is gone, it looks whether the robot is gone, too.
"""

from __future__ import annotations

from typing import Literal

from chatrobot.core.clock import TICK_S
from chatrobot.wire.wire import Wire

MISSED_S = 0.17
"""This long without a beat is a trip: a tick may come 0.11 s after the last where three times as many threads as there
are processors want to run, and 80 ms of the promised 250 ms are left for everything else."""

ECHO_LOST_S = 0.15
"""Motion takes a guard that does not echo for this long as dead, and does not move without one."""

ECHO_LATE_S = 2.0
"""What has not begun to move waits for a guard that has been silent for less than this: a busy machine holds it up."""

HANDSHAKE, BEAT, GOODBYE = b"H", b"B", b"G"
"""What Motion says to the guard, one byte each. The guard echoes them; a handshake among beats is what it echoes."""

TRIPPED = b"T"
"""What the guard answers to a beat that comes too late."""


class Watch:
    """The guard's rule."""

    def __init__(self) -> None:
        self.state: Literal["idle", "watching", "tripped"] = "idle"
        self._last_beat_s = 0.0

    def hear(self, word: bytes, now_s: float) -> None:
        """A word from Motion. After a trip, beats alone do not help: Motion must know that it was tripped."""
        if word == HANDSHAKE:
            self.state = "watching"
        if self.state == "watching":
            self._last_beat_s = now_s

    def lose(self) -> None:
        """Motion's end of the line is gone without a goodbye."""
        if self.state == "watching":
            self.state = "tripped"

    def must_halt(self, now_s: float) -> bool:
        """True while zeros are to be sent; trips where a beat is overdue."""
        if self.state == "watching" and now_s - self._last_beat_s > MISSED_S:
            self.state = "tripped"
        return self.state == "tripped"

    def seconds_left(self, now_s: float) -> float:
        """Return how long until something may have to be done."""
        if self.state == "idle":
            return MISSED_S
        if self.state == "tripped":
            return TICK_S  # Motion beats with every tick of its control loop
        return max(0.0, self._last_beat_s + MISSED_S - now_s)


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
