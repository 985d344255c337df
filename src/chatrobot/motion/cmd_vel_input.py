"""Velocities of other programs (a joystick, Nav2), let through the governor while nothing of ours drives.

Whoever publishes `cmd_vel` may be started with `-r cmd_vel:=chatrobot/cmd_vel`: then limits, obstacles, stop and guard
hold for it, too, and it no longer fights with us for the robot. It comes last: a plan takes its place, and after a stop
or a plan it has to let go (send zero, or nothing for a moment) before it drives again.

A joystick has a topic and an input of its own: it comes first, takes command from whatever drives, and lets go by
itself once it has asked for nothing for a moment, so that one that sends zeros at rest keeps nobody from driving.
"""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.clock import TERM_S, Clock
from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import CMD_VEL_INPUT_TOPIC
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.wire.messages import TwistMessage

_NEVER = -1e9


class CmdVelInput:
    """`hear` comes from the wire's thread; the rest belongs to the control thread.

    Args:
        source: in whose name it drives, which is also its lease; it decides before whom it goes.
        takes_over: called before it takes command.
        on_end: the robot was driven and is to stand now.
        tell: hears why it may not be driven.
    """

    def __init__(
        self,
        clock: Clock,
        robot: GovernedRobot,
        on_end: Callable[[], None],
        tell: Callable[[Reason], None],
        source: str = CMD_VEL_INPUT_TOPIC,
        takes_over: Callable[[], None] = lambda: None,
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
