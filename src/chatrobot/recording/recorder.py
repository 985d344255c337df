"""Takes in what happens and has it written by a thread of its own: whoever tells it something never waits.

What comes faster than it can be written is dropped, counted and told; a disk that is full ends the recording, and
nothing else.
"""

from __future__ import annotations

import fcntl
import math
import os
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from chatrobot.core.clock import Clock, RealClock
from chatrobot.core.event import strict_json
from chatrobot.core.events import Event, Interpreted, Notice, Telemetry
from chatrobot.core.reason import Reason
from chatrobot.recording.redactor import Redactor
from chatrobot.recording.topics import (
    CHATGPT_NODE,
    CMD_VEL,
    EVENTS,
    GROUND_TRUTH,
    ODOM,
    SCAN,
    USER_INPUT,
    Topic,
)
from chatrobot.wire.messages import Message, Odometry, Text, TwistMessage
from chatrobot.wire.ros_messages import stamped
from chatrobot.wire.wire import Wire

if TYPE_CHECKING:
    from chatrobot.core.wiring import Wiring
    from chatrobot.recording.writer import RecordingWriter

MOST_WAITING = 5_000
"""Messages in the queue: half a minute of a moving robot with a lidar."""
LOOK_S, FLUSH_S = 0.1, 0.25
"""How often the queue is looked at, and how often what was written is handed to the operating system."""
LOOK_OF_MANY_S = 0.5
"""Where many are recorded: each waking takes the interpreter from all the others."""
LOAD_AFTER_S = 0.3
"""The libraries are loaded this long after the start: a prompt is drawn, and a first key echoed, before."""
CHANGING_S, SAME_S = 0.1, 1.0
"""What changes is recorded so often, what stays the same so often."""
_EARLY_S = 0.01
"""Messages 20 ms apart come a little early or late."""
_DIGITS = 3
"""A millimetre, or a thousandth of a radian, is no change."""
_NEVER_HEARD = frozenset({"pose", "scan"})
"""Truth and scans come from the wire, whether or not somebody watches them."""


class Recorder:
    """One recording. `take`, `hear` and `said` may be called from any thread and return at once.

    Args:
        path: the file, which is made here: nothing is there yet, and its folder is.
        clock: that of the robot; on simulated time the sender waits where the queue is full, and nothing is dropped.
        limit_bytes: the recording ends where its file has become so long.
        is_one_of_many: more robots are recorded by this process: less is written, and less often (`Thinning`).

    Raises:
        OSError: the file cannot be made.
    """

    def __init__(
        self,
        path: Path,
        redactor: Redactor,
        *,
        clock: Clock | None = None,
        limit_bytes: float = math.inf,
        is_one_of_many: bool = False,
    ) -> None:
        self.path = path
        self._thinning = Thinning() if is_one_of_many else None
        self._look_s = LOOK_OF_MANY_S if is_one_of_many else LOOK_S
        self._redactor = redactor
        self._clock = clock or RealClock()
        self._is_simulated = not isinstance(self._clock, RealClock)
        self._limit_bytes = limit_bytes
        self._began_ns = time.time_ns() - int(self._clock.now_s() * 1e9)
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
        fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)  # whoever tidies up leaves it alone
        self._queue: deque[tuple[Topic, Message | Event, int]] = deque()
        self._notices: deque[Notice] = deque()
        self._wire: Wire | None = None
        self._about: Callable[[], Mapping[str, str]] = dict
        self._dropped = self._dropped_told = 0
        self.message_count = self.size_bytes = 0
        self.is_over = False
        """Nothing is written any more."""
        self._is_closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)

    def start(self, about: Callable[[], Mapping[str, str]]) -> None:
        """Begin to write; `about` gives the metadata, and is called by the thread that writes."""
        self._about = about
        self._notices.append(Notice(0, Reason("recording", {"path": str(self.path)})))
        self._thread.start()

    def listen(self, wire: Wire, wiring: Wiring, truth_topic: str = "") -> None:
        """Take in what that robot is told and what it says; the wire is closed with the recording."""
        self._wire = wire
        subjects: list[tuple[Topic, str | None]] = [
            (CMD_VEL, wiring.cmd_vel_topic),
            (ODOM, wiring.odom_topic),
            (SCAN, wiring.scan_topic),
            (GROUND_TRUTH, truth_topic),
        ]
        for topic, name in subjects:
            if name:
                self.subscribe(wire, topic, name)

    def subscribe(self, wire: Wire, topic: Topic, name: str) -> None:
        """Take in as `topic` what comes on the wire's topic of that name."""
        wire.subscribe(name, topic.kind, lambda message: self.take(topic, message))

    def take(self, topic: Topic, message: Message | Event) -> None:
        """Take in a message of that topic, which has been received just now."""
        if self.is_over:
            return
        now_s = self._clock.now_s()
        if self._thinning is not None and not self._thinning.keeps(topic, message, now_s):
            return
        if len(self._queue) >= MOST_WAITING and not self._waited():
            self._dropped += 1
            return
        self._queue.append((topic, message, self._began_ns + int(now_s * 1e9)))

    def hear(self, event: Event) -> None:
        """Take in an event."""
        if event.name in _NEVER_HEARD:
            return
        self.take(EVENTS, event)
        if isinstance(event, Interpreted) and event.plan_text:
            self.take(CHATGPT_NODE, Text(event.plan_text))

    def said(self, turn: int, text: str) -> None:
        """Take in what a person said: as ROS's nodes would hear it, and with the number of its turn."""
        self.take(USER_INPUT, Text(text))
        self.take(EVENTS, Text(strict_json({"event": "heard", "turn": turn, "text": text})))

    def notices(self) -> list[Notice]:
        """Return what a person should know by now, once."""
        found = []
        while self._notices:
            found.append(self._notices.popleft())
        return found

    def close(self) -> None:
        """Write what has come, and the index. Waits for it."""
        if self._wire is not None:
            self._wire.close()
        self._is_closing.set()
        if self._thread.ident is not None and threading.current_thread() is not self._thread:
            self._thread.join()

    def _waited(self) -> bool:
        """On simulated time, wait until there is room: it stands meanwhile."""
        while self._is_simulated and not self.is_over and len(self._queue) >= MOST_WAITING:
            time.sleep(0.001)
        return self._is_simulated

    # --- the thread that writes ---

    def _run(self) -> None:
        try:
            if not self._is_simulated:
                self._is_closing.wait(LOAD_AFTER_S)
            from chatrobot.recording.writer import RecordingWriter

            self._redactor.refresh()
            writer = RecordingWriter(os.fdopen(self._descriptor, "wb"), self._about(), self._redactor)
            try:
                self._write_all(writer)
            finally:
                self.is_over = True
                writer.close()
                self.size_bytes = self.path.stat().st_size
        except OSError as error:
            self._end("recording_failed", problem=error.strerror or str(error))
        except Exception as error:  # noqa: BLE001 - a recording that breaks must end nothing else
            self._end("recording_failed", problem=f"{type(error).__name__}: {error}")

    def _write_all(self, writer: RecordingWriter) -> None:
        flushed_s = -math.inf
        while True:
            is_last = self._is_closing.wait(self._look_s)
            self._redactor.refresh()
            has_news = self._drain(writer)
            if has_news and time.monotonic() - flushed_s >= FLUSH_S:
                writer.flush()
                flushed_s, self.size_bytes = time.monotonic(), writer.size_bytes
                if self.size_bytes > self._limit_bytes:
                    self._end("recording_too_large", megabytes=round(self._limit_bytes / 1e6))
            if is_last or self.is_over:
                return

    def _drain(self, writer: RecordingWriter) -> bool:
        count = len(self._queue)
        for _ in range(count):
            topic, message, time_ns = self._queue.popleft()
            if isinstance(message, Event):
                message = Text(strict_json(message.to_json(), is_compact=True))
            elif (timed := stamped(message)) is not None:
                message = timed._replace(stamp_s=timed.stamp_s + self._began_ns * 1e-9)
            writer.write(topic, message, time_ns)
        self.message_count += count
        if self._dropped > self._dropped_told:
            self._dropped_told = self._dropped
            notice = Notice(0, Reason("recording_dropped", {"count": self._dropped}))
            self._notices.append(notice)
            writer.write(EVENTS, Text(strict_json(notice.to_json(), is_compact=True)), time.time_ns())
        return count > 0

    def _end(self, code: str, **values: Any) -> None:
        self.is_over = True
        self._queue.clear()
        self._notices.append(Notice(0, Reason(code, {"path": str(self.path), **values})))


class Thinning:
    """Leaves out what one robot of many says again and again; each topic comes from one thread.

    What changes is kept ten times a second, what does not once a second; a velocity that begins or ends a motion, and
    every event but telemetry, always.
    """

    def __init__(self) -> None:
        self._kept: dict[str, tuple[float, tuple[Any, ...]]] = {}

    def keeps(self, topic: Topic, message: Message | Event, now_s: float) -> bool:
        """Tell whether that message is to be recorded."""
        says = _says(message)
        if says is None:
            return True
        kept_s, said = self._kept.get(topic.name, (-math.inf, ()))
        wait_s = CHANGING_S if says != said else SAME_S
        turns = isinstance(message, TwistMessage) and any(says) != any(said)
        if not turns and now_s - kept_s < wait_s - _EARLY_S:
            return False
        self._kept[topic.name] = (now_s, says)
        return True


def _says(message: Message | Event) -> tuple[Any, ...] | None:
    """What it says, apart from when; None where each is recorded."""
    if isinstance(message, Odometry):
        return _rounded(message[1:])
    if isinstance(message, TwistMessage):
        return _rounded(message)
    if isinstance(message, Telemetry):
        return (*_rounded(message.pose), message.moving)
    return None


def _rounded(values: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(value, _DIGITS) for value in values)
