"""Motion's process under a console: `python -m chatrobot.motion.process --profile … --world … --max-distance …
--max-time … --open-loop yes|"" --wire … --fd N,M`.

Envelopes come over inherited sockets, one a client, and events go back over them; `MotionRunner` does the rest. They
are inherited, not listened for: nobody but who started this process can ever be at the other end. The Motions of a
class are one process: `--wire` comes once for each robot, and `--fd` names one line for each.
"""

from __future__ import annotations

import contextlib
import json
import signal
import socket
import sys
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.events import Event, Scan, Telemetry
from chatrobot.link.envelope import Envelope, ready
from chatrobot.link.motion_link import ClientLine
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

    def __init__(self, line: socket.socket, client: ClientLine) -> None:
        self._line = line
        self._client = client
        self._waiting: deque[Event] = deque()

    def put(self, event: Event) -> None:
        """Queue `event`, if this client is to hear it; telemetry and scans are dropped where too much waits."""
        if isinstance(event, (Telemetry, Scan)) and len(self._waiting) > OUTBOX_LIMIT:
            return
        heard = self._client.outward(event)
        if heard is not None:
            self._waiting.append(heard)

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
    """Reads the line of one client: Motion hears a stop in this very thread.

    Args:
        tell_person: hears what others order; from any thread.
    """

    def __init__(
        self,
        line: socket.socket,
        client: ClientLine,
        runner: MotionRunner,
        tell_person: Callable[[Event], None],
    ) -> None:
        self._line = line
        self._client = client
        self._runner = runner
        self._tell_person = tell_person
        self._lease = ""
        self._said_goodbye = False
        self.has_ended = False
        """The client has said goodbye, or is lost; Motion has been told."""

    def start(self) -> None:
        """Begin to read."""
        threading.Thread(target=self.run, name="link", daemon=True).start()

    def run(self) -> None:
        """Read until the other end leaves; without a goodbye that is a loss."""
        while packet := self._receive():
            said = Envelope.from_bytes(packet)
            envelope = self._client.inward(said) if said is not None else None
            if envelope is None:
                continue
            self._lease = envelope.lease
            self._said_goodbye = self._said_goodbye or envelope.word == "goodbye"
            if (ordered := self._client.ordered(envelope)) is not None:
                self._tell_person(ordered)
            self._runner.receive(envelope)
            self.has_ended = self._said_goodbye
        if self._client.is_persons and not self._said_goodbye:
            self._runner.lose(self._lease)
        elif self._lease and not self._said_goodbye:
            self._runner.lose(self._lease, others_stay=True)
        self.has_ended = True

    def _receive(self) -> bytes:
        try:
            return self._line.recv(PACKET_BYTES)
        except OSError:
            return b""


def main(arguments: list[str]) -> int:
    """Run Motion on the inherited sockets, the first a person's; return the exit code."""
    for name in ("SIGINT", "SIGTSTP", "SIGHUP", "SIGPIPE"):
        signal.signal(getattr(signal, name), signal.SIG_IGN)
    options = dict(zip(arguments[::2], arguments[1::2]))
    addresses = [value for name, value in zip(arguments[::2], arguments[1::2]) if name == "--wire"]
    lines = [socket.socket(fileno=int(number)) for number in options["--fd"].split(",")]
    clients = len(lines) // len(addresses)
    try:
        shared = _shared(addresses, options)
        runners = [
            _begin(address, lines[place * clients : (place + 1) * clients], shared[place], options)
            for place, address in enumerate(addresses)
        ]
        for line in lines[::clients]:
            with contextlib.suppress(OSError):  # gone already: the reader's end of file ends the loop
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


def _begin(
    address: str, lines: Sequence[socket.socket], shared: Shared, options: Mapping[str, str]
) -> MotionRunner:
    """Meet that robot, and begin to listen to whoever speaks for it: a person on the first line."""
    clients = [ClientLine(number) for number in range(len(lines))]
    outboxes = [Outbox(line, client) for line, client in zip(lines, clients)]
    runner = MotionRunner(
        address,
        options["--profile"],
        options["--world"],
        lambda event: _put(outboxes, event),
        budget=_budget(options),
        open_loop=bool(options["--open-loop"]),
        connect=shared.loop.connect if shared.guard is not None else connect_wire,
        shared=shared,
    )
    readers = [SocketReader(*end, runner, outboxes[0].put) for end in zip(lines, clients)]
    for reader in readers:
        reader.start()
    runner.begin(
        lambda: readers[0].has_ended and not runner.motion.is_busy,
        lambda: _flush(outboxes),
        lambda: lines[0].shutdown(socket.SHUT_RDWR),
    )
    return runner


def _put(outboxes: Sequence[Outbox], event: Event) -> None:
    for outbox in outboxes:
        outbox.put(event)


def _flush(outboxes: Sequence[Outbox]) -> None:
    for outbox in outboxes:
        outbox.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
