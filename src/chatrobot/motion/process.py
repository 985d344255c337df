"""Motion's process under a console: `python -m chatrobot.motion.process --profile … --world … --wire …
--max-distance … --max-time … --open-loop yes|"" --fd N`.

Envelopes come over an inherited socket, and events go back over it; `MotionRunner` does the rest.
"""

from __future__ import annotations

import json
import signal
import socket
import sys
import threading
from collections import deque

from chatrobot.core.errors import WireError
from chatrobot.core.events import Event, Telemetry
from chatrobot.core.motion_budget import MotionBudget, read_limit_text
from chatrobot.link.envelope import Envelope, ready
from chatrobot.motion.runner import MotionRunner
from chatrobot.wire.local import PACKET_BYTES

OUTBOX_LIMIT = 200


class Outbox:
    """Events on their way to the other half. Never blocks: a frozen reader costs it telemetry, nothing else.

    They are written down after the tick they belong to: that takes longer than a velocity may wait.
    """

    def __init__(self, line: socket.socket) -> None:
        self._line = line
        self._waiting: deque[Event] = deque()

    def put(self, event: Event) -> None:
        if isinstance(event, Telemetry) and len(self._waiting) > OUTBOX_LIMIT:
            return
        self._waiting.append(event)

    def flush(self) -> None:
        while self._waiting:
            try:
                packet = json.dumps(self._waiting[0].to_json(), separators=(",", ":")).encode()
                self._line.send(packet, socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)
            except OSError:
                return  # full or gone: the reader's end of file tells which
            self._waiting.popleft()


class SocketReader:
    """The link's reader: Motion hears a stop in this very thread."""

    def __init__(self, line: socket.socket, runner: MotionRunner) -> None:
        self._line = line
        self._runner = runner
        self._lease = ""
        self._said_goodbye = False

    def run(self) -> None:
        """Until the other end leaves; without a goodbye that is a loss."""
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
    for name in ("SIGINT", "SIGTSTP", "SIGHUP", "SIGPIPE"):
        signal.signal(getattr(signal, name), signal.SIG_IGN)
    options = dict(zip(arguments[::2], arguments[1::2]))
    line = socket.socket(fileno=int(options["--fd"]))
    outbox = Outbox(line)
    try:
        budget = MotionBudget(*(read_limit_text(options[name]) for name in ("--max-distance", "--max-time")))
        runner = MotionRunner(
            options["--wire"],
            options["--profile"],
            options["--world"],
            outbox.put,
            budget=budget,
            open_loop=bool(options["--open-loop"]),
        )
        threading.Thread(target=SocketReader(line, runner).run, name="link", daemon=True).start()
        line.send(ready())
        runner.run(lambda: runner.motion.has_left, outbox.flush)
    except WireError:
        return 1  # the robot's end is gone
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
