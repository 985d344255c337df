"""Monitors the robot's connection: is the wire up, who else drives the same robot, and where is
odometry that does not come, or comes where there should be none?
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable

from chatrobot.core.errors import WireError
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import ODOM_TOPIC
from chatrobot.motion.hints import why_unheard
from chatrobot.motion.motion import Motion
from chatrobot.motion.safety.competing_controllers import BEAT_S, CompetingControllers
from chatrobot.motion.safety.connection import is_up
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.connect import Surveying, has_null_ranges, publishers_of, resolved
from chatrobot.wire.wire import Wire

LOOK_EVERY = 5
"""Who else is on the wire is looked up with every fifth beat: it costs a millisecond."""

SURVEY_EVERY = 20
"""All that is on the wire is looked through with every twentieth beat, and only while odometry was never heard."""


class ConnectionMonitor:
    """Tells Motion what keeps the robot from moving, and people what has changed. Belongs to a thread of its own.

    Args:
        notice: tells people something that ends nothing.
        accept_others: drive though another Motion is on the same robot.
    """

    def __init__(
        self,
        wire: Wire,
        competitors: CompetingControllers,
        motion: Motion,
        profile: RobotProfile,
        notice: Callable[[Reason], None],
        *,
        accept_others: bool,
    ) -> None:
        self._wire = wire
        self._competitors = competitors
        self._motion = motion
        self._profile = profile
        self._odometry: list[str] = []
        self._notice = notice
        self._accept_others = accept_others
        self._told_of_nulls = False
        self._was_up = True
        self._seen: list[str] = []
        self._named: list[str] = []
        self._motions: list[str] = []

    def watch(self) -> None:
        """For ever: say that we are here, and see who else is."""
        count = 0
        while True:
            with contextlib.suppress(WireError):  # gone: the control loop will see it, too
                self._mind_wire()
                self._competitors.beat()
                if count % LOOK_EVERY == 0:
                    self.look_around()
                if count % SURVEY_EVERY == 0:
                    self._look_for_odometry()
            count += 1
            time.sleep(BEAT_S)

    def look_around(self) -> None:
        """See who else drives, and whether scans come whole."""
        if not self._told_of_nulls and has_null_ranges(self._wire):
            self._told_of_nulls = True
            self._notice(Reason("open_space_unknown", {"speed_mps": self._profile.safety.blind_speed_mps}))
        motions = self._competitors.motions()
        others = sorted({*motions, *self._competitors.others()})
        is_settled, self._seen = others == self._seen, others  # a name from discovery alone soon gets better
        if is_settled and others != self._named:
            reason = Reason("not_alone", {"who": ", ".join(others)}) if others else Reason("alone_again")
            self._named = others
            self._notice(reason)
        self._motion.stop_confirmation.others = ", ".join(others)
        self._motions = motions
        if self._profile.open_loop:
            self._odometry = publishers_of(self._wire, ODOM_TOPIC)
        self._motion.interlock.obstruction = self._obstruction()

    def _look_for_odometry(self) -> None:
        """Why none comes, for who asks the robot to move."""
        if not self._profile.has_odometry or self._motion.sensors.estimate is not None:
            return
        if isinstance(self._wire, Surveying):
            self._motion.why_unheard = why_unheard(
                self._profile.wiring, self._wire.survey(), self._wire.resolve
            )

    def _mind_wire(self) -> None:
        """Wi-Fi is gone, or back: say so, and see the robot stand, which may have held its last command meanwhile."""
        is_there = is_up(self._wire)
        if is_there == self._was_up:
            return
        self._was_up = is_there
        self._motion.interlock.obstruction = self._obstruction()
        self._notice(Reason("wire_back" if is_there else "wire_gone"))
        if is_there:
            self._motion.post(self._motion.see_it_stand)

    def _obstruction(self) -> Reason | None:
        if not is_up(self._wire):
            return Reason("wire_gone")
        if self._motions and not self._accept_others:
            return Reason("another_motion", {"who": ", ".join(self._motions)})
        if self._odometry:  # it can be measured now; in the middle of a session is no moment to begin with it
            return Reason("odometry_there", {"topic": resolved(self._wire, ODOM_TOPIC)})
        return None
