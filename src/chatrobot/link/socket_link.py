"""The link to a Motion in a process of its own, over an inherited socket."""

from __future__ import annotations

import contextlib
import json
import socket
import subprocess
import threading
import time
from typing import Any

from chatrobot.core.clock import LOCAL_BEAT_HZ, LOCAL_TERM_S
from chatrobot.core.errors import LinkError
from chatrobot.core.events import event_from_json
from chatrobot.core.process import own_identity, wake_promptly
from chatrobot.link.envelope import PROTOCOL, Envelope, Word, read_ready
from chatrobot.link.motion_link import EventQueue, MotionLink, Sender
from chatrobot.link.processes import MotionProcess
from chatrobot.wire.local import PACKET_BYTES

START_TIMEOUT_S = 20.0
END_TIMEOUT_S = 5.0


class SocketLink(EventQueue, MotionLink):
    """Talks to a Motion that has been started.

    A thread beats the lease; a thread reads events. If this process freezes or dies, the beats end and Motion
    stops the robot.

    Raises:
        LinkError: Motion does not start.
    """

    def __init__(self, motion: MotionProcess, source: str = "console") -> None:
        super().__init__()
        self._sender = Sender(source)
        self._closed = threading.Event()
        self._is_second = False
        self._motion, self._line = motion, motion.line
        self.process = motion.process
        self._reader = threading.Thread(target=self._read, name="link", daemon=True)

    def second(self, source: str) -> SocketLink:
        """Return a link of another client, an agent, to the same Motion, which is ready. There is one at a time.

        Raises:
            LinkError: there was one already.
        """
        line, self._motion.second_line = self._motion.second_line, None
        if line is None:
            raise LinkError(
                "this robot's second line is taken: end its session and start again to get another"
            )
        link = SocketLink(MotionProcess(self.process, line), source)
        link._is_second = True
        link._begin()
        return link

    def wait_until_ready(self) -> None:
        """Block until Motion has its robot and its guard; then begin to beat."""
        self._line.settimeout(START_TIMEOUT_S)
        try:
            ready = self._line.recv(PACKET_BYTES)
        except OSError:
            ready = b""
        protocol = read_ready(ready)
        if protocol != PROTOCOL:
            self.process.kill()  # nothing has been asked of it, so nothing moves; its guard sees to that
            raise LinkError(
                "Motion did not start; its own message is above"
                if protocol is None
                else f"Motion runs link protocol {protocol}, this process {PROTOCOL}:"
                " install the same version of chatrobot on both sides"
            )
        self._begin()

    def _begin(self) -> None:
        self._line.settimeout(None)
        self.send("hello", term_s=LOCAL_TERM_S, process=own_identity())
        threading.Thread(target=self._beat, name="beat", daemon=True).start()
        self._reader.start()

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        self._say(self._sender.envelope(word, turn, **payload))

    def release_as(self, source: str) -> None:
        """Release an emergency stop in the name of somebody who may, where the source of this link may not.

        Raises:
            LinkError: Motion is gone.
        """
        self._say(Sender(source).envelope("release"))

    def _say(self, envelope: Envelope) -> None:
        packet = envelope.to_bytes()
        try:
            self._line.send(packet, socket.MSG_NOSIGNAL)
        except OSError as error:
            raise LinkError("Motion is gone") from error

    def close(self) -> None:
        if self._closed.is_set():
            return
        with contextlib.suppress(LinkError):
            self.send("goodbye")
        self._closed.set()
        if self._is_second:
            with contextlib.suppress(OSError):
                self._line.shutdown(socket.SHUT_RDWR)  # ends our reader; what was queued is still done
        elif self._motion.is_shared:  # it goes on with others; our line ends once what was queued is done
            self._reader.join(END_TIMEOUT_S)
        else:
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.process.wait(END_TIMEOUT_S)
        self._motion.close()

    def _beat(self) -> None:
        wake_promptly()
        period_s = 1.0 / LOCAL_BEAT_HZ
        next_s = time.monotonic()
        while not self._closed.wait(max(0.0, next_s - time.monotonic())):
            next_s = max(next_s + period_s, time.monotonic())
            try:
                if self.beats:
                    self.send("beat", age_s=self.age_s())
            except LinkError:
                return

    def _read(self) -> None:
        while True:
            try:
                packet = self._line.recv(PACKET_BYTES)
            except OSError:
                packet = b""
            if not packet:
                self.is_lost = not self._closed.is_set()
                self.wake()
                return
            with contextlib.suppress(ValueError):
                self._events.put(event_from_json(json.loads(packet)))
