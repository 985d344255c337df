"""A program in the sandbox, as its host holds it.

    program = SandboxedProgram(server, ProgramSettings(source, mode="live", topics=robot_topics(profile.wiring)))
    program.start()
    for event in program.poll(timeout_s=0.02):
        ...                     # TwistAsked, Log, Output, TopicNoticed, Listens, Beat; last Ended, Raised or Died
    program.tell("odom", [stamp_s, x, y, yaw, vx, vy, wz])
    program.close()

`server` is a `WarmServer` made by `warm_server()`. Nothing here blocks but for `poll`'s own timeout. A live program
beats every 0.1 s: who holds its lease goes by that.
"""

from __future__ import annotations

import contextlib
import select
import socket
from collections.abc import Sequence
from typing import Any

from chatrobot.core.reason import Reason
from chatrobot.programs.events import ENDS, AsksTime, Died, Log, Output, ProgramEvent, read_event
from chatrobot.programs.pipe import LARGEST_FROM_PROGRAM, FrameReader, PipeError, ProgramSettings, encode
from chatrobot.sandbox.limits import SandboxLimits
from chatrobot.sandbox.process import ExitReport, SandboxedProcess
from chatrobot.sandbox.warm_server import WarmServer

ENTRY = "chatrobot.programs.inside.entry:run"
PRELOAD = ("chatrobot.programs.inside.entry",)
BYTES_A_POLL = 16 * 1024
"""A flood may not keep the host from its other work."""
TEXT_BYTES = 1024 * 1024
"""What is passed on of all that a program writes."""
OUTBOX_BYTES = 1024 * 1024
EXIT_WAIT_S = 1.0


def warm_server() -> WarmServer:
    """Return a server that knows the names that programs import. Start it, use it for many programs, close it."""
    return WarmServer(preload=PRELOAD)


class SandboxedProgram:
    """See the module."""

    def __init__(
        self, server: WarmServer, settings: ProgramSettings, limits: SandboxLimits | None = None
    ) -> None:
        self.settings = settings
        self._server = server
        self._limits = limits
        self._process: SandboxedProcess | None = None
        self._reader = FrameReader(LARGEST_FROM_PROGRAM)
        self._outbox = bytearray()
        self._text_left = TEXT_BYTES
        self._end: ProgramEvent | None = None

    def start(self) -> None:
        """Launch it. Raises SandboxError."""
        self._process = self._server.launch(ENTRY, self.settings.to_bytes(), self._limits)
        self._process.channel.setblocking(False)

    @property
    def end(self) -> ProgramEvent | None:
        """Return its last event; None while it runs."""
        return self._end

    def poll(self, timeout_s: float = 0.0) -> list[ProgramEvent]:
        """Return what happened since the last poll; wait for something at most `timeout_s`. Nothing after its end."""
        if self._end is not None:
            return []
        self._send()
        waiting = select.poll()
        waiting.register(self._channel, select.POLLIN)
        if not waiting.poll(timeout_s * 1000.0):
            return []
        try:
            data = self._channel.recv(BYTES_A_POLL)
        except BlockingIOError:
            return []
        except OSError:
            data = b""
        events: list[ProgramEvent]
        events = self._read(data) if data else [self._died(Reason("program_vanished"))]
        if events and isinstance(events[-1], ENDS):
            self._end = events[-1]
        return events

    def tell(self, sensor: str, values: Sequence[Any]) -> None:
        """Pass on a sensor's stamp (seconds since the program's start) and numbers, if the pipe is not full."""
        if len(self._outbox) < OUTBOX_BYTES:
            self._outbox += encode("feed", [[sensor, *values]])
        self._send()

    def let_pass(self, now_s: float, due_s: float, messages: Sequence[Sequence[Any]]) -> None:
        """Answer `AsksTime`: the time now, when the next message may come, and those of until now."""
        self._outbox += encode("now", round(now_s * 1e9), round(due_s * 1e9), messages)
        self._send()

    def kill(self) -> None:
        """End it at once; the next poll tells so."""
        if self._process is not None:
            self._process.kill()

    def exit_report(self) -> ExitReport | None:
        """Return what the process of an ended program used and tried."""
        return self._process.wait(EXIT_WAIT_S) if self._process is not None else None

    def close(self) -> None:
        """Kill it if it still runs."""
        if self._process is not None:
            self._process.close()

    @property
    def _channel(self) -> socket.socket:
        assert self._process is not None, "start it first"
        return self._process.channel

    def _send(self) -> None:
        """As much as the pipe takes."""
        if self._outbox:
            with contextlib.suppress(OSError):
                sent = self._channel.send(self._outbox, socket.MSG_NOSIGNAL)
                del self._outbox[:sent]

    def _read(self, data: bytes) -> list[ProgramEvent]:
        """Read up to the end, if that is among it: what a program says after its end does not count."""
        events: list[ProgramEvent] = []
        try:
            for frame in self._reader.feed(data):
                event = read_event(frame)
                if isinstance(event, (Log, Output)):
                    self._text_left -= len(event.text)
                    if self._text_left < 0:
                        continue
                if isinstance(event, AsksTime) and len(self._outbox) > OUTBOX_BYTES:
                    raise PipeError("it asks and does not listen")
                events.append(event)
                if isinstance(event, ENDS):
                    break
        except PipeError as error:
            self.kill()
            events.append(self._died(Reason("program_broke_pipe", {"problem": str(error)})))
        return events

    def _died(self, reason: Reason) -> Died:
        """Its process's own report knows better why it vanished, if it has to be said at all."""
        assert self._process is not None
        report = self._process.wait(EXIT_WAIT_S)
        if reason.code == "program_vanished" and report is not None and report.reason is not None:
            reason = report.reason
        return Died(reason, self._process.read_logs())
