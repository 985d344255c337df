"""Looks out for what is about the robot on its wire: whether the wire is up, and who else drives the same robot."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable

from chatrobot.core.errors import WireError
from chatrobot.core.reason import Reason
from chatrobot.session.link import is_up
from chatrobot.session.motion import Motion
from chatrobot.session.rivals import BEAT_S, Rivals
from chatrobot.wire.connect import has_null_ranges
from chatrobot.wire.wire import Wire

LOOK_EVERY = 5
"""Who else is on the wire is looked up with every fifth beat: it costs a millisecond."""


class Lookout:
    """Tells Motion what keeps the robot from moving, and people what has changed. Belongs to a thread of its own.

    Args:
        notice: tells people something that ends nothing.
        blind_mps: how fast the robot goes where its lidar sees nothing.
        accept_others: drive though another Motion is on the same robot.
    """

    def __init__(
        self,
        wire: Wire,
        rivals: Rivals,
        motion: Motion,
        notice: Callable[[Reason], None],
        *,
        blind_mps: float,
        accept_others: bool,
    ) -> None:
        self._wire = wire
        self._rivals = rivals
        self._motion = motion
        self._notice = notice
        self._blind_mps = blind_mps
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
                self._rivals.beat()
                if count % LOOK_EVERY == 0:
                    self.look_around()
            count += 1
            time.sleep(BEAT_S)

    def look_around(self) -> None:
        """See who else drives, and whether scans come whole."""
        if not self._told_of_nulls and has_null_ranges(self._wire):
            self._told_of_nulls = True
            self._notice(Reason("open_space_unknown", {"speed_mps": self._blind_mps}))
        motions = self._rivals.motions()
        others = sorted({*motions, *self._rivals.others()})
        is_settled, self._seen = others == self._seen, others  # a name from discovery alone soon gets better
        if is_settled and others != self._named:
            reason = Reason("not_alone", {"who": ", ".join(others)}) if others else Reason("alone_again")
            self._named = others
            self._notice(reason)
        self._motion.zeroing.others = ", ".join(others)
        self._motions = motions
        self._motion.clearance.obstruction = self._obstruction()

    def _mind_wire(self) -> None:
        """Wi-Fi is gone, or back: say so, and see the robot stand, which may have held its last command meanwhile."""
        is_there = is_up(self._wire)
        if is_there == self._was_up:
            return
        self._was_up = is_there
        self._motion.clearance.obstruction = self._obstruction()
        self._notice(Reason("wire_back" if is_there else "wire_gone"))
        if is_there:
            self._motion.post(self._motion.see_it_stand)

    def _obstruction(self) -> Reason | None:
        if not is_up(self._wire):
            return Reason("wire_gone")
        if self._motions and not self._accept_others:
            return Reason("another_motion", {"who": ", ".join(self._motions)})
        return None
