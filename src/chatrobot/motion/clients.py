"""Who may command the robot: clients by envelopes, under leases; other programs by velocities on a topic.

Whoever publishes `cmd_vel` (Nav2) may be started with `-r cmd_vel:=chatrobot/cmd_vel`: then limits, obstacles, stop and
guard hold for it, too. It comes last: a plan takes its place, and after a stop or a plan it has to let go (send zero,
or nothing for a moment) before it drives again. A joystick has a topic of its own: it comes first, takes command from
whatever drives, and lets go by itself once it has asked for nothing for a moment.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import islice

from chatrobot.core.clock import LOCAL_TERM_S, TERM_S, Clock
from chatrobot.core.geometry import Twist
from chatrobot.core.process import watch_process
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import Leases
from chatrobot.link.envelope import PROTOCOL, Envelope, other_protocol, protocol_of, seconds
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.wire.messages import TwistMessage

LONGEST_TERM_S = 1.0
"""No source may be silent for longer than this, whatever term it asks for."""
MANY_SOURCES = 256
"""With more the longest-silent that are gone are forgotten."""
MOST_SOURCES = 4 * MANY_SOURCES
"""So many that are there at once are a flood: no further one may move the robot. A stop needs no lease."""
_LOOKED_AT = 32
"""So many of the longest-silent are looked at: where none of them is gone, hardly any is."""


class Clients:
    """Belongs to the control thread, but for `lose`.

    Args:
        is_engaged: whether something is driven or waits in that lease's name; such a one is never forgotten.
        forget: hears of each lease that is.
    """

    def __init__(
        self, leases: Leases, is_engaged: Callable[[str], bool], forget: Callable[[str], None]
    ) -> None:
        self._leases = leases
        self._is_engaged = is_engaged
        self._forget = forget
        self._known: dict[str, None] = {}
        self._leaving: set[str] = set()
        self._strangers: dict[str, int] = {}
        """The protocol of each lease whose half speaks another than we do."""
        self._some_have_left = False

    def note(self, lease: str, now_s: float) -> None:
        """Something came in its name. With one too many those that are gone are forgotten."""
        is_new = lease not in self._known
        self._known.pop(lease, None)
        if is_new and len(self._known) >= MANY_SOURCES:
            self._make_room(now_s)
        self._known[lease] = None  # the longest-silent stand first

    def _make_room(self, now_s: float) -> None:
        gone = [one for one in islice(self._known, _LOOKED_AT) if self._is_gone(one, now_s)]
        if not gone and len(self._known) >= MOST_SOURCES:
            gone = [next(one for one in self._known if not self._is_engaged(one))]
        for lease in gone:
            del self._known[lease]
            self._strangers.pop(lease, None)
            if lease in self._leaving:
                self._leases.end(lease)  # it was entrusted with what it had said, and that is done
                self._leaving.discard(lease)
            self._forget(lease)
        if len(self._leaving) > MOST_SOURCES:  # lost after they had been forgotten; their leases have ended
            self._leaving.intersection_update(self._known)

    def _is_gone(self, lease: str, now_s: float) -> bool:
        is_there = lease not in self._leaving and self._leases.is_valid(lease, now_s)
        return not is_there and not self._is_engaged(lease)

    def hear(self, envelope: Envelope, now_s: float) -> None:
        """Whatever a source says keeps its lease; a hello opens it.

        Args:
            now_s: when the envelope came.
        """
        self._leases.beat(envelope.lease, now_s - seconds(envelope.payload.get("age_s", 0.0), math.inf))
        if self.has_left(envelope.lease):
            return
        if len(self._known) >= MOST_SOURCES and not self._leases.is_known(envelope.lease):
            return
        if envelope.word == "hello" or self._was_there_before_us(envelope):
            term_s = min(seconds(envelope.payload.get("term_s"), LOCAL_TERM_S), LONGEST_TERM_S)
            self._strangers.pop(envelope.lease, None)
            if (protocol := protocol_of(envelope.payload)) != PROTOCOL:
                self._strangers[envelope.lease] = protocol
            is_stopped = watch_process(str(envelope.payload.get("process", "")))
            self._leases.open(envelope.lease, envelope.source, term_s, now_s, is_stopped)

    def leave(self, lease: str) -> None:
        """A goodbye: what is queued is still done, without beats."""
        self._leases.entrust(lease)
        self._leaving.add(lease)
        self._some_have_left = True

    def lose(self, lease: str) -> None:
        """Gone without one: nothing more is done in its name. From any thread."""
        self._leases.end(lease)
        self._leaving.add(lease)
        self._some_have_left = True

    def has_left(self, lease: str) -> bool:
        """No beat of it is waited for any more: what it says now could never lapse."""
        return lease in self._leaving

    def refusal(self, envelope: Envelope) -> Reason | None:
        """Say why nothing is driven for that source: it has left, or its half misunderstands ours. Stops are heeded."""
        if self.has_left(envelope.lease):
            return Reason("lease_lapsed", {"source": envelope.source})
        protocol = self._strangers.get(envelope.lease, PROTOCOL)
        return None if protocol == PROTOCOL else other_protocol(motion=PROTOCOL, dialogue=protocol)

    @property
    def some_have_left(self) -> bool:
        return self._some_have_left

    def _was_there_before_us(self, envelope: Envelope) -> bool:
        """Its hello went by before we listened; it names its term with what it says."""
        return "term_s" in envelope.payload and not self._leases.is_known(envelope.lease)


_NEVER = -1e9


class CmdVelInput:
    """Lets velocities from a topic through the governor. All but `hear` belongs to the control thread.

    Args:
        source: in whose name it drives, which is also its lease; it decides before whom it goes.
        takes_over: called before it takes command.
        on_end: called when the robot was driven and is to stand now.
        tell: hears why it may not be driven.
    """

    def __init__(
        self,
        source: str,
        clock: Clock,
        robot: GovernedRobot,
        takes_over: Callable[[], None],
        on_end: Callable[[], None],
        tell: Callable[[Reason], None],
    ) -> None:
        self._lease = source
        self._takes_over = takes_over
        self._clock = clock
        self._robot = robot
        self._on_end = on_end
        self._tell = tell
        self._heard = (_NEVER, Twist())
        self._moved_at_s = _NEVER
        self._has_to_let_go = False
        self.is_driving = False

    def hear(self, message: TwistMessage) -> None:
        """A velocity somebody asks for. It is held for as long as a lease is, and governed anew with every tick."""
        now_s, twist = self._clock.now_s(), Twist(*message)
        if twist.is_zero or now_s - self._heard[0] > TERM_S:
            self._has_to_let_go = False
        self._heard = (now_s, twist)

    def stop(self) -> None:
        """The robot has been stopped: what was heard before counts no more."""
        self._has_to_let_go = True

    def tick(self, now_s: float, is_free: Callable[[], bool]) -> None:
        """One period; `is_free`: nothing of ours drives, waits or stops the robot."""
        at_s, twist = self._heard
        is_asked = now_s - at_s <= TERM_S
        if is_asked and not is_free():
            self._has_to_let_go = True
        if not twist.is_zero:
            self._moved_at_s = at_s
        may_drive = is_asked and not self._has_to_let_go and now_s - self._moved_at_s <= TERM_S
        if self.is_driving and not may_drive:
            self._end()
        elif not self.is_driving and may_drive and not twist.is_zero:
            self._begin(now_s, is_free)
        if self.is_driving:
            self._drive(twist, at_s, now_s)

    def _begin(self, now_s: float, is_free: Callable[[], bool]) -> None:
        self._robot.governor.leases.open(self._lease, self._lease, TERM_S, now_s)
        refusal = self._robot.fault()
        if refusal is None:
            self._takes_over()
            refusal = self._robot.begin(self._lease, now_s)
        if refusal is not None:
            self._has_to_let_go = True
            self._tell(refusal)
            self._on_end()  # whoever drove until now has been told that it is over
        elif not is_free():  # stopped a moment ago, from another thread: command was taken after it
            self._has_to_let_go = True
            self._robot.governor.end(self._lease)
        self.is_driving = not self._has_to_let_go

    def _drive(self, twist: Twist, at_s: float, now_s: float) -> None:
        fault = self._robot.fault()
        if fault is not None:
            self._has_to_let_go = True
            self._tell(fault)
            self._end()
            return
        self._robot.governor.leases.beat(self._lease, at_s)
        verdict = self._robot.govern(twist, self._lease, now_s)
        if verdict.action == "refused":
            self._has_to_let_go = True
            self._end()
        else:
            self._robot.send(verdict)

    def _end(self) -> None:
        self.is_driving = False
        self._robot.governor.end(self._lease)
        self._on_end()
