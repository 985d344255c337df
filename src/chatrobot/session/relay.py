"""Velocities of other programs (a joystick, Nav2), let through the governor while nothing of ours drives.

Whoever publishes `cmd_vel` may be started with `-r cmd_vel:=chatrobot/cmd_vel`: then limits, obstacles, stop and guard
hold for it, too, and it no longer fights with us for the robot. It comes last: a plan takes its place, and after a stop
or a plan it has to let go (send zero, or nothing for a moment) before it drives again.
"""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.clock import Clock
from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import RELAY_TOPIC
from chatrobot.governor.lease import TERM_S
from chatrobot.session.governed_robot import GovernedRobot
from chatrobot.wire.messages import TwistMessage

_LEASE = "relay"
_NEVER = -1e9


class Relay:
    """`hear` comes from the wire's thread; the rest belongs to the control thread.

    Args:
        on_end: the robot was driven and is to stand now.
        tell: hears why it may not be driven.
    """

    def __init__(
        self,
        clock: Clock,
        robot: GovernedRobot,
        on_end: Callable[[], None],
        tell: Callable[[Reason], None],
    ) -> None:
        self._clock = clock
        self._robot = robot
        self._on_end = on_end
        self._tell = tell
        self._heard = (_NEVER, Twist())
        self._has_to_let_go = False
        self.is_driving = False

    def hear(self, message: TwistMessage) -> None:
        """A velocity somebody asks for. It is held for as long as a lease is, and governed anew with every tick."""
        now_s, twist = self._clock.now_s(), Twist(*message)
        if twist.is_zero or now_s - self._heard[0] > TERM_S:
            self._has_to_let_go = False
        self._heard = (now_s, twist)

    def tick(self, now_s: float, is_free: Callable[[], bool]) -> None:
        """One period; `is_free`: nothing of ours drives, waits or stops the robot."""
        at_s, twist = self._heard
        is_asked = now_s - at_s <= TERM_S
        if is_asked and not is_free():
            self._has_to_let_go = True
        may_drive = is_asked and not self._has_to_let_go
        if self.is_driving and not may_drive:
            self._end()
        elif not self.is_driving and may_drive and not twist.is_zero:
            self._begin(now_s, is_free)
        if self.is_driving:
            self._drive(twist, at_s, now_s)

    def _begin(self, now_s: float, is_free: Callable[[], bool]) -> None:
        self._robot.governor.leases.open(_LEASE, RELAY_TOPIC, TERM_S, now_s)
        refusal = self._robot.fault() or self._robot.begin(_LEASE, now_s)
        if refusal is not None:
            self._has_to_let_go = True
            self._tell(refusal)
        elif not is_free():  # stopped a moment ago, from another thread: the wheel was taken after it
            self._has_to_let_go = True
            self._robot.governor.end(_LEASE)
        self.is_driving = not self._has_to_let_go

    def _drive(self, twist: Twist, at_s: float, now_s: float) -> None:
        fault = self._robot.fault()
        if fault is not None:
            self._has_to_let_go = True
            self._tell(fault)
            self._end()
            return
        self._robot.governor.leases.beat(_LEASE, at_s)
        verdict = self._robot.govern(twist, _LEASE, now_s)
        if verdict.action == "refused":
            self._has_to_let_go = True
            self._end()
        else:
            self._robot.send(verdict)

    def _end(self) -> None:
        self.is_driving = False
        self._robot.governor.end(_LEASE)
        self._on_end()
