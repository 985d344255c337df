"""Motion's process under a console: `python -m chatrobot.motion.process --profile … --world … --max-distance …
--max-time … --open-loop yes|"" --wire … --fd N`.

Envelopes come over an inherited socket, and events go back over it; `MotionRunner` does the rest. The Motions of a
class are one process: `--wire` comes once for each robot, and `--fd` names the line of each: `--fd N,M,…`.
"""

from __future__ import annotations

import json
import signal
import socket
import sys
import threading
from collections import deque
from collections.abc import Mapping, Sequence

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.events import Event, Telemetry
from chatrobot.link.envelope import Envelope, ready
from chatrobot.motion.control_loop import ControlLoop
from chatrobot.motion.runner import MotionRunner, Shared
from chatrobot.motion.safety.watchdog import SharedGuard, start_guard
from chatrobot.programs.sandboxed import warm_server
from chatrobot.robots.load import load_profile
from chatrobot.robots.open_loop import as_chosen
from chatrobot.robots.profile import MotionBudget, read_limit_text
from chatrobot.sim.load import load_world
from chatrobot.wire.connect import connect_wire
from chatrobot.wire.local import PACKET_BYTES

OUTBOX_LIMIT = 200


class Outbox:
    """Sends events to the other half. Never blocks: a frozen reader costs it telemetry, nothing else.

    They are written down after the tick they belong to: that takes longer than a velocity may wait.
    """

    def __init__(self, line: socket.socket) -> None:
        self._line = line
        self._waiting: deque[Event] = deque()

    def put(self, event: Event) -> None:
        """Queue `event`; telemetry is dropped where too much waits."""
        if isinstance(event, Telemetry) and len(self._waiting) > OUTBOX_LIMIT:
            return
        self._waiting.append(event)

    def flush(self) -> None:
        """Send what waits, as far as the line takes it."""
        while self._waiting:
            try:
                packet = json.dumps(self._waiting[0].to_json(), separators=(",", ":")).encode()
                self._line.send(packet, socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)
            except OSError:
                return  # full or gone: the reader's end of file tells which
            self._waiting.popleft()


class SocketReader:
    """Reads the link: Motion hears a stop in this very thread."""

    def __init__(self, line: socket.socket, runner: MotionRunner) -> None:
        self._line = line
        self._runner = runner
        self._lease = ""
        self._said_goodbye = False

    def run(self) -> None:
        """Read until the other end leaves; without a goodbye that is a loss."""
        while packet := self._receive():
            envelope = Envelope.from_bytes(packet)
            if envelope is None:
                continue
            self._lease = envelope.lease
            self._said_goodbye = self._said_goodbye or envelope.word == "goodbye"
            self._runner.receive(envelope)
        if not self._said_goodbye:
            self._runner.lose(self._lease)

    def _receive(self) -> bytes:
        try:
            return self._line.recv(PACKET_BYTES)
        except OSError:
            return b""


def main(arguments: list[str]) -> int:
    """Run Motion on the inherited socket; return the exit code."""
    for name in ("SIGINT", "SIGTSTP", "SIGHUP", "SIGPIPE"):
        signal.signal(getattr(signal, name), signal.SIG_IGN)
    options = dict(zip(arguments[::2], arguments[1::2]))
    addresses = [value for name, value in zip(arguments[::2], arguments[1::2]) if name == "--wire"]
    lines = [socket.socket(fileno=int(number)) for number in options["--fd"].split(",")]
    try:
        shared = _shared(addresses, options)
        runners = [_begin(*one, options) for one in zip(addresses, lines, shared)]
        for line in lines:
            line.send(ready())
        shared[0].loop.run(runners)
    except WireError:
        return 1  # the robot's end is gone
    return 0


def _shared(addresses: Sequence[str], options: Mapping[str, str]) -> list[Shared]:
    loop = ControlLoop()
    if len(addresses) == 1:
        return [Shared(loop)]
    from chatrobot.motion.planning_process import PlanningProcess, RemoteProgramHost

    profile = as_chosen(
        load_profile(options["--profile"]), _budget(options), open_loop=bool(options["--open-loop"])
    )
    clock = RealClock()
    guard = SharedGuard(start_guard(addresses, profile.wiring, clock, is_near=True), clock)
    planners = PlanningProcess(profile, load_world(options["--world"]), len(addresses)).planners
    server = warm_server()
    return [
        Shared(loop, guard.share(), planner, RemoteProgramHost(profile, planner, server))
        for planner in planners
    ]


def _budget(options: Mapping[str, str]) -> MotionBudget:
    return MotionBudget(*(read_limit_text(options[name]) for name in ("--max-distance", "--max-time")))


def _begin(address: str, line: socket.socket, shared: Shared, options: Mapping[str, str]) -> MotionRunner:
    """Meet that robot, and begin to listen to whoever speaks for it over `line`."""
    outbox = Outbox(line)
    runner = MotionRunner(
        address,
        options["--profile"],
        options["--world"],
        outbox.put,
        budget=_budget(options),
        open_loop=bool(options["--open-loop"]),
        connect=shared.loop.connect if shared.guard is not None else connect_wire,
        shared=shared,
    )
    threading.Thread(target=SocketReader(line, runner).run, name="link", daemon=True).start()
    runner.begin(lambda: runner.motion.has_left, outbox.flush, lambda: line.shutdown(socket.SHUT_RDWR))
    return runner


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
