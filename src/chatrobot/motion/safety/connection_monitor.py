"""The wire to a robot that may be gone for a while: opened patiently, outlived, and watched for who else drives."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from typing import NamedTuple

from chatrobot.core.errors import WireError
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import ODOM_TOPIC, Wiring
from chatrobot.motion.motion import Motion
from chatrobot.motion.safety.competing_controllers import CompetingControllers
from chatrobot.motion.topic_discovery import fit, is_complete, why_unheard
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.connect import Connect
from chatrobot.wire.messages import Message, TwistMessage
from chatrobot.wire.wire import Endpoint, M, Wire

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
        self._count = 0
        self._seen: list[str] = []
        self._named: list[str] = []
        self._motions: list[str] = []

    def look_out(self) -> None:
        """Say that we are here, and see who else is; every `PRESENCE_S`, in one thread."""
        count, self._count = self._count, self._count + 1
        with contextlib.suppress(WireError):  # gone: the control loop will see it, too
            self._mind_wire()
            self._competitors.beat()
            if count % LOOK_EVERY == 0:
                self.look_around()
            if count % SURVEY_EVERY == 0:
                self._look_for_odometry()

    def look_around(self) -> None:
        """See who else drives, and whether scans come whole."""
        if not self._told_of_nulls and self._wire.has_null_ranges:
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
            self._odometry = self._wire.publishers_of(ODOM_TOPIC)
        self._motion.interlock.obstruction = self._obstruction()

    def _look_for_odometry(self) -> None:
        """Why none comes, for who asks the robot to move."""
        if not self._profile.has_odometry or self._motion.sensors.estimate is not None:
            return
        if self._wire.knows_others:
            found = self._wire.survey()
            self._motion.goals.why_unheard = why_unheard(self._profile.wiring, found, self._wire.resolve)

    def _mind_wire(self) -> None:
        """Wi-Fi is gone, or back: say so, and see the robot stand, which may have held its last command meanwhile."""
        is_there = self._wire.is_connected
        if is_there == self._was_up:
            return
        self._was_up = is_there
        self._motion.interlock.obstruction = self._obstruction()
        self._notice(Reason("wire_back" if is_there else "wire_gone"))
        if is_there:
            self._motion.post(self._motion.see_it_stand)

    def _obstruction(self) -> Reason | None:
        if not self._wire.is_connected:
            return Reason("wire_gone")
        if self._motions and not self._accept_others:
            return Reason("another_motion", {"who": ", ".join(self._motions)})
        if self._odometry:  # it can be measured now; in the middle of a session is no moment to begin with it
            return Reason("odometry_there", {"topic": self._wire.resolve(ODOM_TOPIC)})
        return None


CONNECT_S = 20.0
SURVEY_S = 0.8
"""A robot that is there is found within this time; one that comes later is taken to be as its profile says."""
LOOK_S = 0.05


class ReconnectingWire(Wire):
    """A wire whose other end may return: what cannot be sent meanwhile is dropped, as on every other wire.

    `on_gone` is called once for each time that it goes, by whatever thread finds out.
    """

    comes_back = True

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self.knows_others, self.namespace = wire.knows_others, wire.namespace
        self._is_gone = False
        self.on_gone: Callable[[], None] = lambda: None

    def publish(self, topic: str, message: Message) -> None:
        try:
            self._wire.publish(topic, message)
        except WireError:
            was_gone, self._is_gone = self._is_gone, True
            if not was_gone:
                self.on_gone()
        else:
            self._is_gone = False

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        self._wire.subscribe(topic, kind, callback)

    def close(self) -> None:
        self._wire.close()

    @property
    def is_connected(self) -> bool:
        return self._wire.is_connected

    @property
    def has_null_ranges(self) -> bool:
        return self._wire.has_null_ranges

    def resolve(self, topic: str) -> str:
        return self._wire.resolve(topic)

    def publishers_of(self, topic: str) -> list[str]:
        return self._wire.publishers_of(topic)

    def survey(self) -> list[Endpoint]:
        return self._wire.survey()

    def rewire(self, wiring: Wiring) -> None:
        self._wire.rewire(wiring)


class Reached(NamedTuple):
    """A robot's wire, its wiring as the wire shows it, and what a person should know of the differences."""

    wire: Wire
    wiring: Wiring
    said: list[Reason]


def reach(connect: Connect, address: str, wiring: Wiring, node: str) -> Reached:
    """The robot's wire; it may still be starting.

    Raises:
        WireError: nobody answers for `CONNECT_S`.
    """
    wire = _connect_patiently(connect, address, wiring, node)
    fitted, said = _survey(wire, wiring)
    wire.advertise(fitted.cmd_vel_topic, TwistMessage)
    return Reached(ReconnectingWire(wire) if wire.comes_back else wire, fitted, said)


def _connect_patiently(connect: Connect, address: str, wiring: Wiring, node: str) -> Wire:
    deadline_s = time.monotonic() + CONNECT_S
    while True:
        try:
            return connect(address, wiring, node)
        except WireError:
            if time.monotonic() > deadline_s:
                raise
            time.sleep(0.01)


def _survey(wire: Wire, wiring: Wiring) -> tuple[Wiring, list[Reason]]:
    """How the robot is wired, where the wire can tell."""
    if not wire.knows_others:
        return wiring, []
    deadline_s = time.monotonic() + SURVEY_S
    while time.monotonic() < deadline_s:
        if is_complete(wiring, wire.survey(), wire.resolve):
            return wiring, []
        time.sleep(LOOK_S)
    fitted, said = fit(wiring, wire.survey(), wire.resolve)
    wire.rewire(fitted)
    return fitted, said
