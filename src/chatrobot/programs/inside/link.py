"""The program's end of the pipe: what it asks of its robot goes out, what its robot says comes in."""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

from chatrobot.programs.inside.scheduler import Scheduler
from chatrobot.programs.pipe import LARGEST_FROM_HOST, LATEST_S, FrameReader, ProgramSettings, encode

Listener = Callable[[list[Any]], None]
"""Takes what a sensor says: its stamp (seconds since the program's start) and its numbers."""

LONGEST_TEXT = 8 * 1024
BEAT_S = 0.1
SAME_TWIST_NS = 20_000_000
"""A velocity repeated within a control period is no news."""


class Link:
    """In real time: words go out at once, a thread takes in what sensors say, another one beats.

    `wanted` counts the threads that wait for what sensors may say; `scheduler` is the clock on virtual time.
    """

    scheduler: Scheduler | None = None

    def __init__(self, channel: socket.socket, settings: ProgramSettings) -> None:
        self.settings = settings
        self.wanted = 0
        self._channel = channel
        self._reader = FrameReader(LARGEST_FROM_HOST)
        self._listeners: dict[str, list[Listener]] = {}
        self._depths: dict[str, int] = {}
        self._last_twist: tuple[float, ...] = ()
        self._last_twist_ns = 0
        self._thrift = _Thrift()
        self._began_ns = time.monotonic_ns()
        self._sending = threading.Lock()

    # --- virtual time has its own ---

    def start(self) -> None:
        """Begin to beat, and to hear the host."""
        for name, work in (("beat", self._beat), ("take in", self._take_in)):
            threading.Thread(target=work, name=name, daemon=True).start()

    def now_ns(self) -> int:
        """Return the time since the program's start. Costs nothing."""
        return time.monotonic_ns() - self._began_ns

    def look(self) -> int:
        """Return `now_ns` for a program that asks what time it is, or whether something has happened."""
        return self.now_ns()

    def wall_ns(self) -> int:
        """Return ROS time, which is system time."""
        return time.time_ns()

    def count_publish(self) -> None:
        """Let the little time pass that publishing takes."""

    def send(self, word: str, *values: Any) -> None:
        """Send a word, with the time put first."""
        frame = self._encoded(word, values)
        with self._sending:
            self._channel.sendall(frame)

    def flush(self) -> None:
        """Send what is kept back."""

    # --- what names stand on ---

    def twist(self, vx_mps: float, vy_mps: float, wz_radps: float, planar: bool) -> None:
        """Ask for a velocity; `planar`: without the parts that no ground robot has."""
        twist, now_ns = (vx_mps, vy_mps, wz_radps), self.now_ns()
        if twist == self._last_twist and now_ns - self._last_twist_ns < SAME_TWIST_NS:
            return
        self._last_twist, self._last_twist_ns = twist, now_ns
        self.send("twist", *twist, planar)

    def listen(self, sensor: str, depth: int, listener: Listener) -> None:
        """Have `listener` called with what that sensor of the robot says from now on."""
        self._listeners.setdefault(sensor, []).append(listener)
        if depth > self._depths.get(sensor, 0):
            self._depths[sensor] = depth
            self.send("listens", sensor, min(depth, 1000))

    def unlisten(self, sensor: str, listener: Listener) -> None:
        """Undo `listen`."""
        self._listeners[sensor].remove(listener)

    def log(self, level: str, name: str, text: str) -> None:
        """Tell a line of a logger."""
        self._say("log", (level, name[:200]), text)

    def output(self, stream: str, text: str) -> None:
        """Tell a printed line."""
        self._say("out", (stream,), text)

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """Stand around a wait that what sensors say may end."""
        self.wanted += 1
        try:
            yield
        finally:
            self.wanted -= 1

    # --- inner ---

    def _say(self, word: str, values: tuple[str, ...], text: str) -> None:
        for line in self._thrift.passes(text[:LONGEST_TEXT], self.now_ns()):
            self.send(word, *values, line)

    @property
    def _is_listening(self) -> bool:
        return any(self._listeners.values())

    def _encoded(self, word: str, values: tuple[Any, ...]) -> bytes:
        return encode(word, self.now_ns(), *values)

    def _read(self) -> list[list[Any]]:
        """The frames that came; waits for some. Without a host there is nothing to run for."""
        while True:
            data = self._channel.recv(65536)
            if not data:
                os._exit(0)
            frames = list(self._reader.feed(data))
            if frames:
                return frames

    def _deliver(self, messages: list[list[Any]]) -> None:
        for sensor, *values in messages:
            for listener in tuple(self._listeners.get(sensor, ())):
                listener(values)

    def _beat(self) -> None:
        while True:
            self.send("beat")
            time.sleep(BEAT_S)

    def _take_in(self) -> None:
        while True:
            for _, messages in self._read():
                self._deliver(messages)


_current: list[Link] = []


def open_link(channel: socket.socket, settings: ProgramSettings) -> Link:
    """Begin to speak with the host on `channel`, for this whole process."""
    link = (VirtualLink if settings.mode == "virtual" else Link)(channel, settings)
    _current[:] = [link]
    link.start()
    return link


def get_link() -> Link:
    """Return the one of this process."""
    return _current[0]


BURST_BYTES = 64 * 1024
BYTES_PER_S = 8 * 1024


class _Thrift:
    """A budget of text that refills with time."""

    def __init__(self) -> None:
        self._left = float(BURST_BYTES)
        self._counted_ns = 0
        self._dropped = 0

    def passes(self, text: str, now_ns: int) -> Iterator[str]:
        """Yield `text` where the budget allows it, after a word on what it did not allow before."""
        self._left += max(0, now_ns - self._counted_ns) * 1e-9 * BYTES_PER_S
        self._left = min(self._left, float(BURST_BYTES))
        self._counted_ns = now_ns
        if len(text) > self._left:
            self._dropped += 1
            return
        self._left -= len(text)
        if self._dropped:
            yield f"[{self._dropped} lines dropped]"
            self._dropped = 0
        yield text


SEND_AT_BYTES = 16 * 1024
NEVER_NS = 2**62
SLACK_NS = 100
"""The host's seconds are floats: what it reached this little too early is reached."""
PUBLISH_NS = 20_000
PUBLISH_WEIGHT = 0.1
"""What publishing costs, and how much of a look at the clock it is."""


class VirtualLink(Link):
    """On virtual time: the host's simulated robot and the program move in lock step.

    A program that listens to nothing needs no answers: what it does goes out with the time it did it at, and the host
    follows. One that listens asks the host for time, and gets it up to the next message.
    """

    scheduler: Scheduler

    def __init__(self, channel: socket.socket, settings: ProgramSettings) -> None:
        super().__init__(channel, settings)
        self.due_ns = NEVER_NS
        self._outbox = bytearray()
        self.scheduler = Scheduler(self, int(min(settings.horizon_s, LATEST_S) * 1e9))

    def now_ns(self) -> int:
        return self.scheduler.now_ns

    def start(self) -> None:
        """No threads: the program waits for the host."""

    def wall_ns(self) -> int:
        return self.settings.start_ns + self.look()

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
