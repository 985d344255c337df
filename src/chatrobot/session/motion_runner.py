"""Motion with its robot, its guard and its threads, whatever carries the joint.

Threads: the control loop at 50 Hz (the caller's); the planner, so that a rehearsal never delays a tick; a listener
for `chatrobot stop`; and a watch for others who drive the same robot. The carrier's reader hands envelopes to
`receive` in its own thread, where a stop is out before it returns.
"""

from __future__ import annotations

import contextlib
import gc
import os
import queue
import socket
import sys
import threading
import time
from collections.abc import Callable, Collection
from dataclasses import replace

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.events import Event, Notice
from chatrobot.core.memory_pressure import MOTION, prefer
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.governor.governor import TICK_S
from chatrobot.governor.priority import RELEASERS
from chatrobot.reflex import is_emergency_stop, is_stop, leads_with_stop
from chatrobot.robots.cautious import drives_on_alone, slowed
from chatrobot.robots.load import load_profile
from chatrobot.session.envelope import Envelope
from chatrobot.session.guard_link import GuardProcess
from chatrobot.session.link import PatientWire, is_up, reach
from chatrobot.session.motion import Motion
from chatrobot.session.planner import Planner
from chatrobot.session.program_host import ProgramHost
from chatrobot.session.rivals import BEAT_S, Rivals
from chatrobot.session.topics import STOP, USER_INPUT
from chatrobot.sim.load import load_world
from chatrobot.wire.connect import Connect, Knowing, clock_of, connect_wire, is_on_this_machine, resolved
from chatrobot.wire.messages import Flag, Text
from chatrobot.wire.runtime_dir import stop_socket_path
from chatrobot.wire.wire import Wire

GUARD_S = 20.0
LOOK_EVERY = 5
"""Who else is on the wire is looked up with every fifth beat: it costs a millisecond."""
SWITCH_INTERVAL_S = 0.0005
"""How long a thread may keep the interpreter: the reader must get in between the lines of a rehearsal."""


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
        connect: how our end of the wire is made; the guard has one of its own, at `address`.

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
        connect: Connect = connect_wire,
    ) -> None:
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        prefer(MOTION)
        given = load_profile(profile)
        known_world = load_world(world)
        self.wire, wiring, said = reach(connect, address, given.wiring, node)
        self.profile = replace(given, wiring=wiring)
        if not on_robot and drives_on_alone(given) and not is_on_this_machine(address):
            self.profile = slowed(self.profile)
            said = [*said, Reason("drives_on_alone", {"speed_mps": self.profile.limits.max_speed_mps})]
        self._emit = emit
        self._accept_others = accept_others
        self._was_up = True
        self._seen: list[str] = []
        self._named: list[str] = []
        self._motions: list[str] = []
        self._wake = threading.Event()
        self._plans: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self.programs = ProgramHost(self.profile, is_in_step=False)
        self._guard = GuardProcess(address, _as_others_name_it(self.wire, self.profile.wiring), RealClock())
        self.motion = Motion(
            self.profile,
            self.wire,
            clock_of(self.wire),
            Planner(self.profile, known_world),
            self._guard,
            emit,
            self._plans.put,
            releasers,
            self.programs,
        )
        if isinstance(self.wire, PatientWire):  # a robot that nobody reaches holds what it heard last
            self.wire.on_gone = lambda: self.motion.halt(Reason("wire_gone"))
        self._rivals = Rivals(self.wire, node, self.profile.wiring.cmd_vel_topic)
        if not self._guard.wait_until_alive(GUARD_S):
            raise WireError("the guard did not start")
        self.motion.start(self.wire)
        self.wire.subscribe(USER_INPUT, Text, self._hear_user_input)
        self.wire.subscribe(STOP, Flag, self._hear_stop)
        for reason in said:
            self.notice(reason)
        self._look_around()
        if isinstance(self.wire, Knowing):  # whoever else drives is named before anything moves
            time.sleep(BEAT_S)
            self._look_around()

    def run(self, has_left: Callable[[], bool], each_tick: Callable[[], None]) -> None:
        """The control loop, until `has_left`; then the guard is told goodbye."""
        for target in (self._plan, self._listen_for_stop, self._watch):
            threading.Thread(target=target, daemon=True).start()
        _settle_memory()
        next_s = time.monotonic()
        try:
            while not has_left():
                self._wake.wait(max(0.0, next_s - time.monotonic()))
                self._wake.clear()
                self.motion.tick()
                each_tick()
                if time.monotonic() >= next_s:  # not where an event drove this tick before its time
                    next_s = max(next_s, time.monotonic() - TICK_S) + TICK_S
            self._guard.goodbye()
            self.wire.close()
        finally:
            self.programs.close()
            with contextlib.suppress(OSError):
                stop_socket_path(os.getpid()).unlink()

    # --- from any thread ---

    def receive(self, envelope: Envelope) -> None:
        """Take in an envelope; a stop is out before this returns."""
        self.motion.receive(envelope)
        self._rivals.note_source(envelope.lease)
        if envelope.word != "beat":
            self._wake.set()

    def lose(self, lease: str) -> None:
        """The source behind that lease is gone without a goodbye."""
        self.motion.lose(lease)
        self._wake.set()

    def halt(self, source: str, why: str) -> None:
        """Stop; the zero is out before this returns."""
        self.motion.halt(Reason("stopped_by", {"source": source, "why": why}))
        self._wake.set()

    def notice(self, reason: Reason) -> None:
        """Tell people something that ends nothing."""
        self.motion.post(lambda: self._emit(Notice(0, reason)))
        self._wake.set()

    def in_background(self, job: Callable[[], None]) -> None:
        """Have `job` done by the planner's thread."""
        self._plans.put(job)

    # --- threads of its own ---

    def _plan(self) -> None:
        while True:
            self._plans.get()()
            self._wake.set()

    def _hear_user_input(self, message: Text) -> None:
        """Stop words need nobody's help to be understood."""
        text = message.data
        if is_emergency_stop(text):
            self.receive(
                Envelope("emergency_stop", USER_INPUT, USER_INPUT, time.monotonic_ns(), 0, {"why": text})
            )
        elif leads_with_stop(text) if self.motion.is_busy else is_stop(text):
            self.halt(USER_INPUT, text[:80])

    def _hear_stop(self, message: Flag) -> None:
        if message.data:
            self.halt(STOP, "")

    def _listen_for_stop(self) -> None:
        """Serve `chatrobot stop`: any packet on this socket stops, and is answered when the zero is out."""
        path = stop_socket_path(os.getpid())
        with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
            with contextlib.suppress(FileNotFoundError):
                path.unlink()
            listener.bind(str(path))
            listener.listen(4)
            while True:
                caller, _ = listener.accept()
                with caller:
                    self.halt("chatrobot stop", "")
                    with contextlib.suppress(OSError):
                        caller.send(b"moving" if self.motion.is_busy else b"standing")

    def _watch(self) -> None:
        """Say that we are here, and see who else is."""
        count = 0
        while True:
            with contextlib.suppress(WireError):  # gone: the control loop will see it, too
                self._mind_link()
                self._rivals.beat()
                if count % LOOK_EVERY == 0:
                    self._look_around()
            count += 1
            time.sleep(BEAT_S)

    def _look_around(self) -> None:
        motions = self._rivals.motions()
        others = sorted({*motions, *self._rivals.others()})
        is_settled, self._seen = others == self._seen, others  # a name from discovery alone soon gets better
        if is_settled and others != self._named:
            reason = Reason("not_alone", {"who": ", ".join(others)}) if others else Reason("alone_again")
            self._named = others
            self.notice(reason)
        self.motion.zeroing.others = ", ".join(others)
        self._motions = motions
        self.motion.clearance.obstruction = self._obstruction(motions)

    def _mind_link(self) -> None:
        """Wi-Fi is gone, or back: say so, and see the robot stand, which may have held its last command meanwhile."""
        is_there = is_up(self.wire)
        if is_there == self._was_up:
            return
        self._was_up = is_there
        self.motion.clearance.obstruction = self._obstruction(self._motions)
        self.notice(Reason("wire_back" if is_there else "wire_gone"))
        if is_there:
            self.motion.post(self.motion.see_it_stand)

    def _obstruction(self, motions: list[str]) -> Reason | None:
        if not is_up(self.wire):
            return Reason("wire_gone")
        if motions and not self._accept_others:
            return Reason("another_motion", {"who": ", ".join(motions)})
        return None


def _settle_memory() -> None:
    """What start-up has made stays: the collector need not look through it while the robot moves."""
    gc.collect()
    gc.freeze()


def _as_others_name_it(wire: Wire, wiring: Wiring) -> Wiring:
    """The guard is another end of the wire, which knows nothing of our namespace and remappings."""
    cmd_vel_topic, odom_topic = resolved(wire, wiring.cmd_vel_topic), resolved(wire, wiring.odom_topic)
    return replace(wiring, cmd_vel_topic=cmd_vel_topic, odom_topic=odom_topic)
