"""The link on virtual time: the host's simulated robot and the program move in lock step.

A program that listens to nothing needs no answers: what it does goes out with the time it did it at, and the host
follows. One that listens asks the host for time, and gets it up to the next message.
"""

from __future__ import annotations

import os
import socket
from typing import Any, NoReturn

from chatrobot.programs.inside.link import Link
from chatrobot.programs.inside.scheduler import Scheduler
from chatrobot.programs.settings import LATEST_S, ProgramSettings

SEND_AT_BYTES = 16 * 1024
NEVER_NS = 2**62
SLACK_NS = 100
"""The host's seconds are floats: what it reached this little too early is reached."""
PUBLISH_NS = 20_000
PUBLISH_WEIGHT = 0.1
"""What publishing costs, and how much of a look at the clock it is."""


class VirtualLink(Link):
    """`scheduler` is the process's clock."""

    def __init__(self, channel: socket.socket, settings: ProgramSettings) -> None:
        super().__init__(channel, settings)
        self.due_ns = NEVER_NS
        self._outbox = bytearray()
        self.scheduler = Scheduler(self, int(min(settings.horizon_s, LATEST_S) * 1e9))

    def now_ns(self) -> int:
        return self.scheduler.now_ns

    def look(self) -> int:
        return self.scheduler.look()

    def count_publish(self) -> None:
        self.scheduler.look(PUBLISH_NS, PUBLISH_WEIGHT)

    def send(self, word: str, *values: Any) -> None:
        self._outbox += self._encoded(word, values)
        if len(self._outbox) > SEND_AT_BYTES:
            self.flush()

    def flush(self) -> None:
        data, self._outbox = self._outbox, bytearray()
        self._channel.sendall(data)

    def listen(self, sensor: str, depth: int, listener: Any) -> None:
        super().listen(sensor, depth, listener)
        self.due_ns = min(self.due_ns, self.now_ns())

    # --- for the scheduler ---

    def advance(self, now_ns: int, until_ns: int) -> int:
        if not self._is_listening:
            self.due_ns = NEVER_NS
            return until_ns
        self.send("until", until_ns, self.wanted > 0)
        self.flush()
        for word, reached_ns, due_ns, messages in self._read():
            assert word == "now"
            self.due_ns = due_ns
            now_ns = max(now_ns, until_ns if until_ns - reached_ns < SLACK_NS else reached_ns)
            self._deliver(messages)
        return now_ns

    def finish(self, now_ns: int, stuck: bool) -> NoReturn:
        self.scheduler.now_ns = now_ns
        self.send("ended", "stuck" if stuck and not self._is_listening else "horizon", 0)
        self.flush()
        os._exit(0)
