"""The velocities that others ask for, in their order: a joystick or a stick before all goals, other programs after."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from chatrobot.core.clock import Clock
from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import CMD_VEL_INPUT_TOPIC, JOYSTICK_TOPIC
from chatrobot.governor.governor import Verdict
from chatrobot.link.envelope import Envelope
from chatrobot.motion.clients import Clients
from chatrobot.motion.goal_server import GoalServer
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.pausing import Pausing
from chatrobot.motion.safety.stop import StopConfirmation, Stops
from chatrobot.motion.safety.watchdog import Interlock
from chatrobot.motion.velocity_input import STICK_LET_GO_S, Stick, VelocityInput
from chatrobot.wire.messages import TwistMessage
from chatrobot.wire.wire import Wire

JOYSTICK = "joystick"
"""The source in whose name a joystick drives."""

STICK = "stick"
"""The source in whose name a person's stick over the link drives."""


class RelayedVelocities:
    """Drives by velocities of others. Belongs to the control thread.

    Args:
        tell: hears why the robot may not be driven so.
        note: hears what became of each velocity, and when.
    """

    def __init__(
        self,
        robot: GovernedRobot,
        clients: Clients,
        goals: GoalServer,
        pausing: Pausing,
        stops: Stops,
        stop_confirmation: StopConfirmation,
        interlock: Interlock,
        clock: Clock,
        tell: Callable[[Reason], None],
        note: Callable[[Verdict, float], None],
    ) -> None:
        self._robot = robot
        self._goals = goals
        self._stops = stops
        self._confirmation = stop_confirmation
        self._interlock = interlock
        self._clock = clock
        other_drove = Reason("other_drove", {"source": CMD_VEL_INPUT_TOPIC})
        self._programs = VelocityInput(
            CMD_VEL_INPUT_TOPIC, robot, lambda: pausing.drop(other_drove), self._see_it_stand, tell, note
        )
        self._joystick = VelocityInput(
            JOYSTICK, robot, lambda: goals.hand_over(JOYSTICK), self._see_it_stand, tell, note
        )
        self._stick = VelocityInput(
            STICK, robot, self._take_stick, self._let_stick_go, tell, note, STICK_LET_GO_S, rests_s=0.0
        )
        self._steering = Stick(self._stick, robot.governor.leases, clients.refusal, interlock.barrier, tell)

    def listen(self, wire: Wire) -> None:
        """Hear what comes on topics."""
        for topic, heard in ((CMD_VEL_INPUT_TOPIC, self._programs), (JOYSTICK_TOPIC, self._joystick)):
            wire.subscribe(topic, TwistMessage, partial(self._hear, heard))

    def steer(self, envelope: Envelope, came_s: float) -> None:
        """Take in a `steer` that came then."""
        self._steering.hear(envelope, came_s)

    def leave(self, lease: str) -> None:
        """Let the stick go where that client, which has left, holds it."""
        self._steering.leave(lease, self._clock.now_s())

    def stop(self) -> None:
        """Count nothing that was heard before: the robot has been stopped."""
        for heard in (self._programs, self._joystick, self._stick):
            heard.stop()

    @property
    def stick(self) -> str:
        """Return the source that drives before all goals, "" where none does."""
        return JOYSTICK if self._joystick.is_driving else STICK if self._stick.is_driving else ""

    @property
    def is_program_driving(self) -> bool:
        """True while another program drives, which comes after all goals."""
        return self._programs.is_driving

    @property
    def are_driving(self) -> bool:
        """True while any of them drives."""
        return bool(self.stick) or self._programs.is_driving

    def tick_sticks(self, now_s: float) -> None:
        """Do one period of what comes before all goals. One stick takes nothing from the other."""
        self._joystick.tick(now_s, lambda: self._is_clear() and not self._stick.is_driving)
        self._stick.tick(now_s, self._may_stick_drive)

    def tick_programs(self, now_s: float) -> None:
        """Do one period of what comes after them."""
        self._programs.tick(now_s, self._is_free)

    def _hear(self, heard: VelocityInput, message: TwistMessage) -> None:
        heard.hear(Twist(*message), self._clock.now_s())

    # --- what may drive ---

    def _is_free(self) -> bool:
        """Nothing of ours drives, waits or stops the robot, and nothing keeps it from moving."""
        return self._goals.let_others_drive and not self.stick and self._is_clear()

    def _is_clear(self) -> bool:
        """Nothing stops the robot, and nothing keeps it from moving."""
        return not self._confirmation.is_active and self._is_unbarred()

    def _may_stick_drive(self) -> bool:
        """Like `_is_clear`, but a stick that was let go of may be held again before the robot stands."""
        is_barred = self._confirmation.bars_stick or self._joystick.is_driving
        return not is_barred and self._is_unbarred()

    def _is_unbarred(self) -> bool:
        is_stopped = self._robot.sensors.bumped or self._stops.is_unbooked
        return not is_stopped and self._interlock.barrier() is None

    def _take_stick(self) -> None:
        self._confirmation.cut_short()
        self._goals.hand_over(STICK)

    def _let_stick_go(self) -> None:
        self._confirmation.begin(self._clock.now_s(), may_be_cut_short=True)

    def _see_it_stand(self) -> None:
        self._confirmation.begin(self._clock.now_s())
