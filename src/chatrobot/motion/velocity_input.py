"""Velocities that others ask for: other programs and joysticks on a topic, and a person's stick over the link.

Whoever publishes `cmd_vel` (Nav2) may be started with `-r cmd_vel:=chatrobot/cmd_vel`: then limits, obstacles, stop and
guard hold for it, too. It comes last: a plan takes its place, and after a stop or a plan it has to let go (send zero,
or nothing for a moment) before it drives again. A joystick has a topic of its own: it comes first, takes command from
whatever drives, and lets go by itself once it has asked for nothing for a moment. A stick comes over the link, from a
person's page or window: it ranks with the joystick.
"""

from __future__ import annotations

import uuid
from collections.abc import Callable

from chatrobot.core.clock import TERM_S
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.governor import Verdict
from chatrobot.governor.lease import Leases, may_steer
from chatrobot.link.envelope import Envelope
from chatrobot.motion.governed_robot import GovernedRobot

_NEVER = -1e9


class VelocityInput:
    """Lets velocities through the governor. All but `hear` belongs to the control thread.

    Args:
        source: in whose name it drives; it decides before whom it goes.
        takes_over: called before it takes command.
        on_end: called when the robot was driven and is to stand now.
        tell: hears why it may not be driven.
        note: hears what became of each velocity, and when.
        let_go_s: after a stop, silence for so long counts as having let go.
        rests_s: so long it keeps command once it asks for zero.
    """

    def __init__(
        self,
        source: str,
        robot: GovernedRobot,
        takes_over: Callable[[], None],
        on_end: Callable[[], None],
        tell: Callable[[Reason], None],
        note: Callable[[Verdict, float], None],
        let_go_s: float = TERM_S,
        rests_s: float = TERM_S,
    ) -> None:
        self._source = source
        self._lease = uuid.uuid4().hex  # nobody else can name it, and so none can keep it alive
        self._takes_over = takes_over
        self._robot = robot
        self._on_end = on_end
        self._tell, self._note = tell, note
        self._let_go_s = let_go_s
        self._rests_s = rests_s
        self._heard = (_NEVER, ZERO_TWIST)
        self._moved_at_s = _NEVER
        self._has_to_let_go = False
        self.term_s = TERM_S
        """A velocity is held for so long, governed anew with every tick."""
        self.is_driving = False

    def hear(self, twist: Twist, now_s: float) -> None:
        """Take a velocity that somebody asks for."""
        if twist.is_zero or now_s - self._heard[0] > self._let_go_s:
            self._has_to_let_go = False
        self._heard = (now_s, twist)

    def is_held(self, now_s: float) -> bool:
        """Return whether it asks for motion."""
        at_s, twist = self._heard
        return not twist.is_zero and now_s - at_s <= self.term_s

    def stop(self) -> None:
        """Count nothing that was heard before: the robot has been stopped."""
        self._has_to_let_go = True

    def tick(self, now_s: float, is_free: Callable[[], bool]) -> None:
        """Do one period; `is_free`: nothing of ours drives, waits or stops the robot."""
        at_s, twist = self._heard
        is_asked = now_s - at_s <= self.term_s
        if is_asked and not is_free():
            self._has_to_let_go = True
        if not twist.is_zero:
            self._moved_at_s = at_s
        is_held = self.is_held(now_s) or now_s - self._moved_at_s < self._rests_s
        may_drive = is_asked and not self._has_to_let_go and is_held
        if self.is_driving and not may_drive:
            self._end()
        elif not self.is_driving and may_drive and not twist.is_zero:
            self._begin(now_s, is_free)
        if self.is_driving:
            self._drive(twist, at_s, now_s)

    def _begin(self, now_s: float, is_free: Callable[[], bool]) -> None:
        self._robot.governor.leases.open(self._lease, self._source, self.term_s, now_s)
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
            self._note(verdict, now_s)

    def _end(self) -> None:
        self.is_driving = False
        self._robot.governor.end(self._lease)
        self._on_end()


STICK_LET_GO_S = 1.0
"""A network that stutters is no hand that lets go: after a stop, only a zero or a long silence is."""


class Stick:
    """A person's stick over the link: `steer` words, which alone keep it. Belongs to the control thread.

    One client steers at a time; it lets go with a zero, or by saying nothing for as long as its lease may be silent.

    Args:
        refuses: why that client may not drive at all.
        barrier: why nothing may move just now.
    """

    def __init__(
        self,
        velocities: VelocityInput,
        leases: Leases,
        refuses: Callable[[Envelope], Reason | None],
        barrier: Callable[[], Reason | None],
        tell: Callable[[Reason], None],
    ) -> None:
        self._velocities = velocities
        self._leases = leases
        self._refuses = refuses
        self._barrier = barrier
        self._tell = tell
        self._steerer = ""
        self._refused_at_s = _NEVER

    def hear(self, envelope: Envelope, came_s: float) -> None:
        """Take in a `steer` that came then."""
        twist = Twist(*(float(envelope.payload.get(axis, 0.0)) for axis in ("vx_mps", "vy_mps", "wz_radps")))
        refusal = self._refusal(envelope, came_s)
        if refusal is not None:
            if not twist.is_zero:
                self._refuse(refusal, came_s)
            return
        self._steerer = envelope.lease
        velocities = self._velocities
        is_pressed = not twist.is_zero and not velocities.is_held(came_s)
        velocities.term_s = min(self._leases.term_s_of(envelope.lease), TERM_S)
        velocities.hear(twist, came_s)
        barrier = self._barrier() if is_pressed else None
        if barrier is not None:
            self._tell(barrier)

    def leave(self, lease: str, now_s: float) -> None:
        """Let go where that client steers: it has left."""
        if lease == self._steerer:
            self._velocities.hear(ZERO_TWIST, now_s)

    def _refusal(self, envelope: Envelope, now_s: float) -> Reason | None:
        lease, leases = envelope.lease, self._leases
        source = leases.source_of(lease)
        if not may_steer(source):
            return Reason("may_not_steer", {"source": source})
        if lease != self._steerer and self._velocities.is_held(now_s):
            return Reason("outranked", {"source": leases.source_of(self._steerer)})
        return self._refuses(envelope)

    def _refuse(self, why: Reason, now_s: float) -> None:
        """Tell it once, not with each of many messages a second."""
        is_new = now_s - self._refused_at_s > STICK_LET_GO_S
        self._refused_at_s = now_s
        if is_new:
            self._tell(why)
