"""Runs Motion with its robot, its guard and its planner's thread, whatever carries the link.

It is ticked by a `ControlLoop` (the caller's thread), of its own or that of many robots. The planner has a thread, so
that a rehearsal never delays a tick. The carrier's reader hands envelopes to `receive` in its own thread, where a stop
is out before it returns.
"""

from __future__ import annotations

import contextlib
import queue
import threading
import time
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace

from chatrobot.core.clock import PRESENCE_S, RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.events import Event, Notice
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.governor.lease import RELEASERS
from chatrobot.guard.watch import Departure
from chatrobot.link.envelope import STOP_COMMAND, Envelope
from chatrobot.link.topic_link import STOP, USER_INPUT
from chatrobot.motion.budgets import open_loop_notice
from chatrobot.motion.control_loop import ControlLoop
from chatrobot.motion.motion import Motion
from chatrobot.motion.planner import Planner
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.safety.competing_controllers import CompetingControllers
from chatrobot.motion.safety.connection_monitor import ConnectionMonitor, ReconnectingWire, reach
from chatrobot.motion.safety.stop import PAUSED
from chatrobot.motion.safety.watchdog import GuardShare, start_guard
from chatrobot.reflex import is_emergency_stop, is_pause, is_stop, leads_with_stop
from chatrobot.robots.load import load_profile
from chatrobot.robots.open_loop import as_chosen, drives_on_alone, slowed
from chatrobot.robots.profile import NOT_CHOSEN, MotionBudget, RobotProfile
from chatrobot.sim.load import load_world
from chatrobot.sim.world import check_known
from chatrobot.wire.connect import Connect, connect_wire, is_on_this_machine
from chatrobot.wire.messages import Flag, Text
from chatrobot.wire.wire import Wire

GUARD_S = 20.0


@dataclass(frozen=True)
class Shared:
    """What the robots of one process have in common, and this one's share of it. What is None a robot makes itself."""

    loop: ControlLoop
    guard: GuardShare | None = None
    planner: Planner | None = None
    programs: ProgramHost | None = None


class MotionRunner:
    """Ties Motion to its threads. Connects at once; `run` in the thread that is to be the control loop.

    Args:
        address: of the robot's wire (`chatrobot.wire.connect`).
        profile: by name or file.
        world: what rehearsal knows of the surroundings: empty, home or a file.
        emit: takes events; called on the control thread only.
        node: our name on the wire.
        accept_others: drive though another Motion is on the same robot.
        on_robot: no network lies between this machine and the base, whatever the address looks like.
        releasers: the sources that may release an emergency stop.
        budget: the motion budget as the command line chose it; what it leaves open the profile chooses.
        open_loop: drive a robot that has no odometry (`chatrobot.robots.open_loop`).
        connect: how our end of the wire is made; the guard has one of its own, at `address`.
        shared: what it has in common with the other robots of this process; None where there is no other.

    Raises:
        WireError: there is no robot, or the guard does not start.
        InputError: the profile or the world cannot be used.
    """

    def __init__(
        self,
        address: str,
        profile: str,
        world: str,
        emit: Callable[[Event], None],
        *,
        node: str = "chatrobot_motion",
        accept_others: bool = False,
        on_robot: bool = False,
        releasers: Collection[str] = RELEASERS,
        budget: MotionBudget = NOT_CHOSEN,
        open_loop: bool = False,
        connect: Connect = connect_wire,
        shared: Shared | None = None,
    ) -> None:
        shared = shared or Shared(ControlLoop())
        self._loop = shared.loop
        given = as_chosen(load_profile(profile), budget, open_loop=open_loop)
        known_world = shared.planner.world if shared.planner is not None else load_world(world)
        check_known(known_world, given)
        self.wire, self.profile, said = _meet(connect, address, given, node, on_robot=on_robot)
        self._emit = emit
        self._is_over: Callable[[], bool] = lambda: False
        self._each_tick: Callable[[], None] = lambda: None
        self._at_end: Callable[[], None] = lambda: None
        self._plans: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self.programs = shared.programs or ProgramHost(self.profile, is_in_step=False)
        is_near = on_robot or is_on_this_machine(address)
        wiring = _as_others_name_it(self.wire, self.profile.wiring)
        self._guard = shared.guard or start_guard([address], wiring, RealClock(), is_near=is_near)
        self._departure = Departure(self.wire, wiring.cmd_vel_topic, wiring.odom_topic, is_near=is_near)
        self.motion = self._make_motion(shared.planner or Planner(self.profile, known_world), releasers)
        self._competitors = CompetingControllers(
            self.wire, node, self.profile.wiring.cmd_vel_topic, open_loop_notice(self.profile)
        )
        self._lookout = ConnectionMonitor(
            self.wire, self._competitors, self.motion, self.profile, self.notice, accept_others=accept_others
        )
        self._open(said)

    def _make_motion(self, planner: Planner, releasers: Collection[str]) -> Motion:
        clock, plan_later = self.wire.clock, self._plans.put
        return Motion(
            self.profile,
            self.wire,
            clock,
            planner,
            self._guard,
            self._emit,
            plan_later,
            self.programs,
            releasers,
        )

    def _open(self, said: list[Reason]) -> None:
        """Begin to listen; where that fails, send the guard away: nothing has been driven that it would halt."""
        with contextlib.ExitStack() as ended_early:
            ended_early.callback(self._guard.goodbye)
            self._listen(said)
            ended_early.pop_all()

    def _listen(self, said: list[Reason]) -> None:
        """Begin to listen, once the guard is there; what a person should know of the robot is told first."""
        if isinstance(self.wire, ReconnectingWire):  # a robot that nobody reaches holds what it heard last
            self.wire.on_gone = lambda: self.motion.halt(Reason("wire_gone"))
        if not self._guard.wait_until_alive(GUARD_S):
            raise WireError("the guard did not start")
        self.motion.start(self.wire)
        self.wire.subscribe(USER_INPUT, Text, self._hear_user_input)
        self.wire.subscribe(STOP, Flag, self._hear_stop)
        for reason in said:
            self.notice(reason)
        self._lookout.look_around()
        if self.wire.knows_others:  # whoever else drives is named before anything moves
            time.sleep(PRESENCE_S)
            self._lookout.look_around()

    def run(self, has_left: Callable[[], bool], each_tick: Callable[[], None]) -> None:
        """Run the control loop until `has_left`; then say goodbye to the guard.

        Raises:
            WireError: the wire is closed for good. What was under way has been told to have failed.
        """
        self.begin(has_left, each_tick)
        self._loop.run([self])

    def begin(
        self,
        has_left: Callable[[], bool],
        each_tick: Callable[[], None],
        at_end: Callable[[], None] = lambda: None,
    ) -> None:
        """Be ready for a control loop that runs until `has_left`; `each_tick` follows each tick, `at_end` the last."""
        self._is_over, self._each_tick, self._at_end = has_left, each_tick, at_end
        threading.Thread(target=self._plan, name="planner", daemon=True).start()

    # --- called by the control loop ---

    def tick(self) -> None:
        """Do one period."""
        self.motion.tick()
        self._each_tick()

    @property
    def has_left(self) -> bool:
        """True once all is done, and nobody is there who may ask for more."""
        return self._is_over()

    def look_out(self) -> None:
        """See whether the wire is up and who else drives."""
        self._lookout.look_out()

    def thaw(self) -> None:
        """Void what drove before a signal stopped this process."""
        self.motion.thaw()

    def leave(self) -> None:
        """Say goodbye to the guard, and close the wire."""
        self.motion.leave()
        self.wire.close()
        self._at_end()

    def give_up(self) -> None:
        """Tell that what was under way has failed: the wire is closed for good."""
        self.motion.give_up(Reason("wire_gone"))
        self._each_tick()
        self._at_end()

    def close(self) -> None:
        """End its programs."""
        self.programs.close()

    @property
    def robot_has_left(self) -> bool:
        """True once the robot's process is seen to be gone; for who waits for it to stand. On the control thread."""
        return self._departure.is_over(time.monotonic())

    # --- from any thread ---

    def receive(self, envelope: Envelope, said_in_epoch: int | None = None) -> None:
        """Take in an envelope; a stop is out before this returns. `said_in_epoch`: see `Motion.receive`."""
        self.motion.receive(envelope, said_in_epoch)
        self._competitors.note_source(envelope.lease)
        if envelope.word != "beat":
            self._wake()

    def lose(self, lease: str, *, others_stay: bool = False) -> None:
        """Stop: the source behind that lease is gone without a goodbye. `others_stay`: end only what is its own."""
        (self.motion.lose_second if others_stay else self.motion.lose)(lease)
        self._wake()

    def halt(self, source: str, why: str, *, keep: bool = False) -> None:
        """Stop; the zero is out before this returns. `keep`: it is a pause."""
        self.motion.halt(Reason(PAUSED if keep else "stopped_by", {"source": source, "why": why}))
        self._wake()

    def notice(self, reason: Reason) -> None:
        """Tell people something that ends nothing."""
        self.motion.post(lambda: self._emit(Notice(0, reason)))
        self._wake()

    def in_background(self, goal: Callable[[], None]) -> None:
        """Have `goal` done by the planner's thread."""
        self._plans.put(goal)

    # --- threads of its own ---

    def _wake(self) -> None:
        self._loop.wake(self)

    def _plan(self) -> None:
        while True:
            self._plans.get()()
            self._wake()

    def _hear_user_input(self, message: Text) -> None:
        """Stop words need nobody's help to be understood."""
        text = message.data
        if is_emergency_stop(text):
            self.receive(
                Envelope("emergency_stop", USER_INPUT, USER_INPUT, time.monotonic_ns(), 0, {"why": text})
            )
        elif leads_with_stop(text) if self.motion.is_busy else is_stop(text):
            self.halt(USER_INPUT, text[:80], keep=is_pause(text))

    def _hear_stop(self, message: Flag) -> None:
        if message.data:
            self.halt(STOP, "")

    def stop(self) -> str:
        """Stop; what was found, for `chatrobot stop` to say: `moving`, `waiting`, `standing` or `unseen`."""
        has_work = self.motion.has_work  # looked up, not asked for: nothing holds the zero up
        self.halt(STOP_COMMAND, "")
        sight = self.motion.stop_confirmation.sight
        return "waiting" if sight == "standing" and has_work else sight


def _meet(
    connect: Connect, address: str, given: RobotProfile, node: str, *, on_robot: bool
) -> tuple[Wire, RobotProfile, list[Reason]]:
    """The robot's wire, its profile as the wire shows it, and what a person should know of the differences."""
    wire, wiring, said = reach(connect, address, given.wiring, node)
    profile = replace(given, wiring=wiring)
    if not on_robot and drives_on_alone(given) and not is_on_this_machine(address):
        profile = slowed(profile)
        said = [*said, Reason("drives_on_alone", {"speed_mps": profile.limits.max_speed_mps})]
    return wire, profile, said


def _as_others_name_it(wire: Wire, wiring: Wiring) -> Wiring:
    """The guard is another end of the wire, which is told our namespace, and the topics as our remappings have them."""
    cmd_vel_topic = wire.resolve(wiring.cmd_vel_topic)
    odom_topic = wiring.odom_topic and wire.resolve(wiring.odom_topic)
    namespace = wire.namespace or wiring.namespace
    return replace(wiring, cmd_vel_topic=cmd_vel_topic, odom_topic=odom_topic, namespace=namespace)
