"""Confirms a stop: sends zeros until the robot is seen standing, and again when one that was lost sight of
turns up moving."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from chatrobot.core.reason import Reason
from chatrobot.execution.sensors import FRESH_S, STANDS_LATE_S, Sensors, is_seen_moving, is_seen_standing

PATIENCE_S = STANDS_LATE_S
"""So long zeros are sent where nobody can see whether they help; a robot that moves on meanwhile does not obey."""

Sight = Literal["moving", "standing", "unseen"]


class StopConfirmation:
    """Belongs to the control thread: `begin` with every stop, `tick` while nothing of ours moves the robot.

    Args:
        send_zero: puts one on the wire.
        tell: hears once a stop that the robot does not obey.
    """

    def __init__(
        self, sensors: Sensors, send_zero: Callable[[float], None], tell: Callable[[Reason], None]
    ) -> None:
        self._sensors = sensors
        self._send_zero = send_zero
        self._tell = tell
        self._since_s: float | None = None
        self._was_out_of_sight = False
        self.others = ""
        """Who else sends velocities, by name, as far as the wire tells; any thread may set it."""
        self.disobeyed: Reason | None = None
        """The robot moves on although it has been told to stand, and why that may be. Zeros go on."""

    @property
    def is_active(self) -> bool:
        """Zeros are being sent."""
        return self._since_s is not None

    @property
    def has_lost_sight(self) -> bool:
        """Nobody saw it stand after the last stop, and it has not been seen since."""
        return self._was_out_of_sight

    @property
    def sight(self) -> Sight:
        """What odometry shows of the robot just now."""
        estimate = self._sensors.estimate
        if estimate is None or not self._is_in_sight():
            return "unseen"
        return "standing" if estimate.is_standing else "moving"

    @property
    def is_watched(self) -> bool:
        """A robot that was told to stand is in sight, and not seen standing yet: what it measures still changes."""
        return self.is_active and self.disobeyed is None and self.sight != "unseen"

    @property
    def is_at_rest(self) -> bool:
        """It is seen standing, and nobody has told it to stand since."""
        return not self.is_active and self.sight == "standing"

    def begin(self, now_s: float) -> None:
        self._since_s = now_s
        self._was_out_of_sight = False

    def tick(self, now_s: float) -> None:
        """Send what is due."""
        if self._since_s is None:
            self._look_for_the_lost(now_s)
        elif is_seen_standing(self._sensors, self._since_s):
            self._end()
        elif now_s - self._since_s <= PATIENCE_S:
            self._send_zero(now_s)
        elif self.is_seen_moving:
            self._send_zero(now_s)
            self._complain()
        else:
            self._end()
            self._was_out_of_sight = self._sensors.has_odometry and not self._is_in_sight()

    def _end(self) -> None:
        self._since_s = None
        self.disobeyed = None

    def _look_for_the_lost(self, now_s: float) -> None:
        """Our last zeros may never have reached it: a base that holds its last command would drive on."""
        if not self._was_out_of_sight or not self._is_in_sight():
            return
        self._was_out_of_sight = False
        if self.is_seen_moving:
            self.begin(now_s)
            self._send_zero(now_s)

    def _complain(self) -> None:
        if self.disobeyed is not None:
            return
        self.disobeyed = self.disobedience
        self._tell(self.disobeyed)

    def _is_in_sight(self) -> bool:
        return self._sensors.estimate is not None and self._sensors.odometry_age_s() < FRESH_S

    @property
    def disobedience(self) -> Reason:
        """What to say of a robot that moves though it has been told to stand."""
        return Reason("not_ours_alone", {"who": self.others}) if self.others else Reason("moves_on")

    @property
    def is_seen_moving(self) -> bool:
        """Odometry shows clearly, and just now, that it moves."""
        return is_seen_moving(self._sensors)
