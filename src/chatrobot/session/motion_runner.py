"""Motion with its robot, its guard and its threads, whatever carries the joint.

Threads: the control loop at 50 Hz (the caller's); the planner, so that a rehearsal never delays a tick; a listener
for `chatrobot stop`; and a watch for others who drive the same robot. The carrier's reader hands envelopes to
`receive` in its own thread, where a stop is out before it returns.
"""

from __future__ import annotations

import contextlib
import os
import queue
import socket
import sys
import threading
import time
from collections.abc import Callable, Collection

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.events import Event, Notice
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.governor.governor import TICK_S
from chatrobot.governor.priority import RELEASERS
from chatrobot.reflex import is_emergency_stop, is_stop, leads_with_stop
from chatrobot.robots.load import load_profile
from chatrobot.session.envelope import Envelope
from chatrobot.session.guard_link import GuardProcess
from chatrobot.session.motion import Motion
from chatrobot.session.planner import Planner
from chatrobot.session.rivals import BEAT_S, Rivals
from chatrobot.session.topics import STOP, USER_INPUT
from chatrobot.sim.load import load_world
from chatrobot.wire.connect import Returning, advertise, comes_back, connect_wire
from chatrobot.wire.messages import Flag, Message, Text, TwistMessage
from chatrobot.wire.runtime_dir import stop_socket_path
from chatrobot.wire.wire import M, Wire

CONNECT_S = 20.0
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
        releasers: the sources that may release an emergency stop.

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
        releasers: Collection[str] = RELEASERS,
    ) -> None:
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        clock = RealClock()
        self.profile = load_profile(profile)
        known_world = load_world(world)
        self.wire = _connect(address, self.profile.wiring, node)
        self._emit = emit
        self._accept_others = accept_others
        self._seen: list[str] = []
        self._named: list[str] = []
        self._wake = threading.Event()
        self._plans: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._guard = GuardProcess(address, self.profile.wiring, clock)
        self.motion = Motion(
            self.profile,
            self.wire,
            clock,
            Planner(self.profile, known_world),
            self._guard,
            emit,
            self._plans.put,
            releasers,
        )
        if isinstance(
            self.wire, _PatientWire
        ):  # a robot that nobody reached meanwhile holds what it heard last
            self.wire.on_gone = lambda: self.motion.halt(Reason("wire_gone"))
        self._rivals = Rivals(self.wire, node, self.profile.wiring.cmd_vel_topic)
        if not self._guard.wait_until_alive(CONNECT_S):
            raise WireError("the guard did not start")
        self.motion.start(self.wire)
        self.wire.subscribe(USER_INPUT, Text, self._hear_user_input)
        self.wire.subscribe(STOP, Flag, self._hear_stop)
        self._look_around()

    def run(self, has_left: Callable[[], bool], each_tick: Callable[[], None]) -> None:
        """The control loop, until `has_left`; then the guard is told goodbye."""
        for target in (self._plan, self._listen_for_stop, self._watch):
            threading.Thread(target=target, daemon=True).start()
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
        self.motion.obstruction = self._obstruction(motions)

    def _obstruction(self, motions: list[str]) -> Reason | None:
        if isinstance(self.wire, Returning) and not self.wire.is_connected:
            return Reason("wire_gone")
        if motions and not self._accept_others:
            return Reason("another_motion", {"who": ", ".join(motions)})
        return None


class _PatientWire:
    """A wire whose other end may return: what cannot be sent meanwhile is dropped, as on every other wire.

    `on_gone` is called once for each time that it goes, by whatever thread finds out.
    """

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
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
        return isinstance(self._wire, Returning) and self._wire.is_connected


def _connect(address: str, wiring: Wiring, node: str) -> Wire:
    """The robot's wire; it may still be starting."""
    deadline_s = time.monotonic() + CONNECT_S
    while True:
        try:
            wire = connect_wire(address, wiring, node)
        except WireError:
            if time.monotonic() > deadline_s:
                raise
            time.sleep(0.01)
        else:
            advertise(wire, wiring.cmd_vel_topic, TwistMessage)
            return _PatientWire(wire) if comes_back(wire) else wire
