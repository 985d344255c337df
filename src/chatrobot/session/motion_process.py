"""Motion's process: `python -m chatrobot.session.motion_process --profile … --world … --wire … --fd N`.

Four threads: the control loop at 50 Hz; the reader of the joint, which stops the robot itself before it hands an
envelope on; the planner, so that a rehearsal never delays a tick; and a listener for `chatrobot stop`.
"""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import socket
import sys
import threading
import time
from collections import deque
from collections.abc import Callable

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.events import Event, Telemetry
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.governor.governor import TICK_S
from chatrobot.robots.load import load_profile
from chatrobot.session.envelope import READY, Envelope
from chatrobot.session.guard_link import GuardProcess
from chatrobot.session.motion import Motion
from chatrobot.session.planner import Planner
from chatrobot.sim.load import load_world
from chatrobot.wire.connect import advertise, connect_wire
from chatrobot.wire.local import PACKET_BYTES
from chatrobot.wire.messages import Text, TwistMessage
from chatrobot.wire.runtime_dir import stop_socket_path
from chatrobot.wire.wire import Wire

OUTBOX_LIMIT = 200
CONNECT_S = 20.0
SWITCH_INTERVAL_S = 0.0005
"""How long a thread may keep the interpreter: the reader must get in between the lines of a rehearsal."""


class Outbox:
    """Events on their way to the other half. Never blocks: a frozen reader costs it telemetry, nothing else."""

    def __init__(self, line: socket.socket) -> None:
        self._line = line
        self._waiting: deque[bytes] = deque()

    def put(self, event: Event) -> None:
        if isinstance(event, Telemetry) and len(self._waiting) > OUTBOX_LIMIT:
            return
        self._waiting.append(json.dumps(event.to_json(), separators=(",", ":")).encode())
        self.flush()

    def flush(self) -> None:
        while self._waiting:
            try:
                self._line.send(self._waiting[0], socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)
            except OSError:
                return  # full or gone: the reader's end of file tells which
            self._waiting.popleft()


class MotionProcess:
    """Ties Motion to its threads."""

    def __init__(self, options: dict[str, str]) -> None:
        self._line = socket.socket(fileno=int(options["--fd"]))
        self._outbox = Outbox(self._line)
        clock = RealClock()
        profile = load_profile(options["--profile"])
        world = load_world(options["--world"])
        self._wire = _connect(options["--wire"], profile.wiring)
        self._guard = GuardProcess(options["--wire"], profile.wiring, clock)
        self._wake = threading.Event()
        self._plans: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self.motion = Motion(
            profile,
            self._wire,
            clock,
            Planner(profile, world),
            self._guard,
            self._outbox.put,
            self._plans.put,
        )
        self._lease = ""
        self._said_goodbye = False
        if not self._guard.wait_until_alive(CONNECT_S):
            raise WireError("the guard did not start")
        self.motion.start(self._wire)
        self._wire.subscribe("user_input", Text, self._hear_user_input)

    def run(self) -> None:
        """Until every source has left and the robot stands."""
        for target in (self._read, self._plan, self._listen_for_stop):
            threading.Thread(target=target, daemon=True).start()
        self._line.send(READY)
        next_s = time.monotonic()
        while not self.motion.has_left:
            self._wake.wait(max(0.0, next_s - time.monotonic()))
            self._wake.clear()
            self.motion.tick()
            self._outbox.flush()
            if time.monotonic() >= next_s:  # not where an event drove this tick before its time
                next_s = max(next_s, time.monotonic() - TICK_S) + TICK_S
        self._guard.goodbye()
        self._wire.close()

    def _read(self) -> None:
        """The joint's reader: Motion hears a stop in this very thread."""
        while True:
            try:
                packet = self._line.recv(PACKET_BYTES)
            except OSError:
                packet = b""
            if not packet:
                if not self._said_goodbye:
                    self.motion.lose(self._lease)
                self._wake.set()
                return
            envelope = Envelope.from_bytes(packet)
            if envelope is None:
                continue
            self._lease = envelope.lease
            self._said_goodbye = self._said_goodbye or envelope.word == "goodbye"
            self.motion.receive(envelope)
            if envelope.word != "beat":
                self._wake.set()

    def _plan(self) -> None:
        while True:
            self._plans.get()()
            self._wake.set()

    def _hear_user_input(self, message: Text) -> None:
        """Stop words on `user_input` need nobody's help to be understood."""
        from chatrobot.reflex import is_stop, leads_with_stop

        moving = self.motion.is_busy
        if leads_with_stop(message.data) if moving else is_stop(message.data):
            self.motion.halt(Reason("stopped_by", {"source": "user_input", "why": message.data[:80]}))
            self._wake.set()

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
                    self.motion.halt(Reason("stopped_by", {"source": "chatrobot stop", "why": ""}))
                    with contextlib.suppress(OSError):
                        caller.send(b"moving" if self.motion.is_busy else b"standing")
                self._wake.set()


def _connect(address: str, wiring: Wiring) -> Wire:
    """The robot's wire; it may still be starting."""
    deadline_s = time.monotonic() + CONNECT_S
    while True:
        try:
            wire = connect_wire(address, wiring, "chatrobot_motion")
        except WireError:
            if time.monotonic() > deadline_s:
                raise
            time.sleep(0.01)
        else:
            advertise(wire, wiring.cmd_vel_topic, TwistMessage)
            return wire


def main(arguments: list[str]) -> int:
    for name in ("SIGINT", "SIGTSTP", "SIGHUP", "SIGPIPE"):
        signal.signal(getattr(signal, name), signal.SIG_IGN)
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    process = MotionProcess(dict(zip(arguments[::2], arguments[1::2])))
    try:
        process.run()
    except WireError:
        return 1  # the robot's end is gone
    finally:
        with contextlib.suppress(OSError):
            stop_socket_path(os.getpid()).unlink()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
