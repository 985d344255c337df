"""Stops: out at once from whatever thread, booked afterwards by the control thread, and confirmed by odometry."""

from __future__ import annotations

import contextlib
import os
import socket
from collections.abc import Callable
from typing import Literal, Protocol

from chatrobot.core.clock import Clock
from chatrobot.core.governed import GovernedTwist, StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.execution.sensors import FRESH_S, STANDS_LATE_S, Sensors, is_seen_moving, is_seen_standing
from chatrobot.robots.profile import Wiring
from chatrobot.wire.messages import ZERO, TwistMessage
from chatrobot.wire.runtime_dir import stop_socket_path
from chatrobot.wire.wire import Wire

PATIENCE_S = STANDS_LATE_S
"""So long zeros are sent where nobody can see whether they help; a robot that moves on meanwhile does not obey."""

Sight = Literal["moving", "standing", "unseen"]


class StopConfirmation:
    """Sends zeros until the robot is seen standing: `begin` with every stop, `tick` while nothing of ours moves it.

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
        self._may_be_cut_short = False
        self.others = ""
        """Who else sends velocities, by name, as far as the wire tells; any thread may set it."""
        self.disobeyed: Reason | None = None
        """The robot moves on although it has been told to stand, and why that may be. Zeros go on."""

    @property
    def is_active(self) -> bool:
        """True while zeros are being sent."""
        return self._since_s is not None

    @property
    def has_lost_sight(self) -> bool:
        """True where nobody saw it stand after the last stop, and it has not been seen since."""
        return self._was_out_of_sight

    @property
    def sight(self) -> Sight:
        """Return what odometry shows of the robot just now."""
        estimate = self._sensors.estimate
        if estimate is None or not self._is_in_sight():
            return "unseen"
        return "standing" if estimate.is_standing else "moving"

    @property
    def is_watched(self) -> bool:
        """True while a robot that was told to stand is in sight and moves yet: what it measures still changes."""
        return self.is_active and self.disobeyed is None and self.sight != "unseen"

    @property
    def is_at_rest(self) -> bool:
        """True where it is seen standing, and nobody has told it to stand since."""
        return not self.is_active and self.sight == "standing"

    @property
    def bars_stick(self) -> bool:
        """True while the robot comes to rest for any other reason than that a stick was let go of."""
        return self.is_active and not (self._may_be_cut_short and self.disobeyed is None)

    def begin(self, now_s: float, *, may_be_cut_short: bool = False) -> None:
        """Begin to send zeros. `may_be_cut_short`: a stick was let go of, and may be held again before it stands."""
        self._may_be_cut_short = may_be_cut_short and not self.bars_stick
        self._since_s = now_s
        self._was_out_of_sight = False

    def cut_short(self) -> None:
        """Send no more zeros, where they were sent for a stick alone: it is held again."""
        if not self.bars_stick:
            self._end()

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
        if self.disobeyed is None:
            self.disobeyed = self.disobedience
            self._tell(self.disobeyed)

    def _is_in_sight(self) -> bool:
        return self._sensors.estimate is not None and self._sensors.odometry_age_s() < FRESH_S

    @property
    def disobedience(self) -> Reason:
        """Return what to say of a robot that moves though it has been told to stand."""
        return Reason("not_ours_alone", {"who": self.others}) if self.others else Reason("moves_on")

    @property
    def is_seen_moving(self) -> bool:
        """True where odometry shows clearly, and just now, that it moves."""
        return is_seen_moving(self._sensors)


PAUSED = "paused_by"
WAY_CHANGED = "way_changed"
"""Something was put in the way of what runs, which is rehearsed anew once the robot stands."""
KEEPING = frozenset({PAUSED, WAY_CHANGED})
"""The causes of a stop that keeps what was under way."""
"""The code of a stop that keeps what was under way."""


class Transport(Protocol):
    """Knows two things: to send what the governor minted, and to halt."""

    def send(self, twist: GovernedTwist) -> bool:
        """Send, unless a stop came after it was minted. True if it went out and stands."""

    def halt(self) -> None:
        """Zero, now, from any thread, past everything else; what was minted before is void."""


class WireTransport:
    """Sends to a robot on any wire.

    `halt` takes no lock. A `send` that a stop overtakes looks at the epoch again after it has sent and takes its
    own velocity back, so whatever the order of the two threads, the last thing on the wire is a zero.
    """

    def __init__(self, wire: Wire, wiring: Wiring, epoch: StopEpoch) -> None:
        self._wire = wire
        self._topic = wiring.cmd_vel_topic
        self._epoch = epoch

    def send(self, twist: GovernedTwist) -> bool:
        if twist.epoch != self._epoch.value:
            return False
        self._wire.publish(self._topic, TwistMessage(*twist.twist))
        if twist.epoch != self._epoch.value:
            self._wire.publish(self._topic, ZERO)
            return False
        return True

    def halt(self) -> None:
        self._epoch.stop()
        self._wire.publish(self._topic, ZERO)


class Stops:
    """Stops the robot from any thread with `halt`; the rest belongs to the control thread.

    Booking means that what ran and what waited is told its end, and that the robot is seen standing.
    """

    def __init__(
        self, epoch: StopEpoch, transport: Transport, stop_confirmation: StopConfirmation, clock: Clock
    ) -> None:
        self._epoch = epoch
        self._transport = transport
        self._stop_confirmation = stop_confirmation
        self._clock = clock
        self._booked = epoch.value
        self._asked = self._booked_ask = object()
        self._cleared = self._booked_clear = object()
        self.last_reason = self._clear_reason = Reason("cause_unknown")
        """Of the last stop, be it asked for or the end of a motion that failed."""

    def halt(self, why: Reason) -> None:
        """Stop now: the zero is out before this returns. It takes no lock and waits for nothing."""
        self._ask(why)
        self._transport.halt()

    def void(self, why: Reason) -> None:
        """Make worthless what has been minted; the zero goes out with the next tick.

        For a signal handler: it may have interrupted what sends in this very thread.
        """
        self._ask(why)
        self._epoch.stop()

    def _ask(self, why: Reason) -> None:
        self.last_reason = why
        if why.code not in KEEPING:
            self._clear_reason = why
            self._cleared = object()
        self._asked = object()

    @property
    def count(self) -> int:
        """Return a number that changes with every stop: what was asked before it does not count any more."""
        return self._epoch.value

    @property
    def is_unbooked(self) -> bool:
        """True where a stop has not been booked."""
        return self._booked != self._epoch.value

    def book(self) -> Reason | None:
        """Return why the robot was stopped since the last time, None where it was not; begin to send zeros.

        Of a pause and a stop that came together the stop counts.
        """
        if not self.is_unbooked:
            return None
        self._booked_ask = self._asked
        self._booked = self._epoch.value
        cleared, self._booked_clear = self._cleared is not self._booked_clear, self._cleared
        self._stop_confirmation.begin(self._clock.now_s())
        return self._clear_reason if cleared else self.last_reason

    def halt_and_book(self, why: Reason) -> None:
        """Stop at the end of a motion that failed or was broken off: what waits is not touched by it.

        One that came from elsewhere in the same moment is left to be booked, and does clear what waits.
        """
        self._transport.halt()
        count = self._epoch.value
        # Two at the same instant may share one value: the count alone does not tell.
        if self._asked is self._booked_ask:
            self._booked, self.last_reason = count, why
        self._stop_confirmation.begin(self._clock.now_s())


def serve_stop(stop: Callable[[], str]) -> None:
    """Stop the robot for whoever calls on this process's socket, and answer when the zero is out. Never returns.

    Args:
        stop: stops, and returns in a word what was found.
    """
    path = stop_socket_path(os.getpid())
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        with contextlib.suppress(FileNotFoundError):
            path.unlink()
        listener.bind(str(path))
        listener.listen(4)
        while True:
            caller, _ = listener.accept()
            with caller:
                found = stop()
                with contextlib.suppress(OSError):
                    caller.send(found.encode())


def remove_stop_socket() -> None:
    """Remove the socket that nobody serves any more."""
    with contextlib.suppress(OSError):
        stop_socket_path(os.getpid()).unlink()
