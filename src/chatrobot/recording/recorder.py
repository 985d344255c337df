"""Takes in what happens and has it written by a thread of its own: whoever tells it something never waits.

The recordings of a class share that thread: twenty of them, woken at the same moment, kept the interpreter from the
beats of every robot for up to a second (decision 63).

What comes faster than it can be written is dropped, counted and told; a disk that is full ends the recording, and
nothing else.
"""

from __future__ import annotations

import contextlib
import fcntl
import math
import os
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
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
"""Where many are recorded: so often at each of them, one after the other."""
AT_ONCE, PAUSE_S = 10, 0.001
"""After so many messages, half a millisecond of work, others get the interpreter: a backlog must not keep it."""
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


class WritingThread:
    """Writes recordings, each in its turn, as long as there are any.

    Args:
        look_s: within so long each has its turn.
        first_s: the first turn comes so late.
    """

    def __init__(self, look_s: float = LOOK_S, first_s: float = 0.0) -> None:
        self._look_s, self._first_s = look_s, first_s
        self._recorders: list[Recorder] = []
        self._lock = threading.Lock()
        self._wake = threading.Event()
        self._is_running = False

    def add(self, recorder: Recorder) -> None:
        """Have that one written, too."""
        with self._lock:
            self._recorders.append(recorder)
            if not self._is_running:
                self._is_running = True
                threading.Thread(target=self._run, name="recorder", daemon=True).start()

    def wake(self) -> None:
        """Have those that are closing written at once."""
        self._wake.set()

    def _run(self) -> None:
        place, wait_s = 0, self._first_s
        while count := self._count():
            is_woken, began_s = self._wake.wait(wait_s), time.monotonic()
            if is_woken:
                self._wake.clear()
                due = [recorder for recorder in self._recorders if recorder.is_closing]
            else:
                place = (place + 1) % count
                due = [self._recorders[place]]
            for recorder in due:
                if not recorder.write():
                    self._recorders.remove(recorder)
            wait_s = max(0.0, began_s + self._look_s / count - time.monotonic())

    def _count(self) -> int:
        with self._lock:
            self._is_running = bool(self._recorders)
            return len(self._recorders)


class Recorder:
    """One recording. `take`, `hear` and `said` may be called from any thread and return at once.

    Args:
        path: the file, which is made here: nothing is there yet, and its folder is.
        clock: that of the robot; on simulated time the sender waits where the queue is full, and nothing is dropped.
        limit_bytes: the recording ends where its file has become so long.
        among: what writes the recordings of many robots, this one with them: less is written (`Thinning`).

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
        among: WritingThread | None = None,
    ) -> None:
        self.path = path
        self._thinning = Thinning() if among is not None else None
        self._redactor = redactor
        self._clock = clock or RealClock()
        self._is_simulated = not isinstance(self._clock, RealClock)
        self._limit_bytes = limit_bytes
        self._began_ns = time.time_ns() - int(self._clock.now_s() * 1e9)
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
        fcntl.flock(
            self._descriptor, fcntl.LOCK_EX
        )  # whoever tidies up leaves it alone, and looks for a moment
        self._queue: deque[tuple[Topic, Message | Event, int]] = deque()
        self._notices: deque[Notice] = deque()
        self._wire: Wire | None = None
        self._about: Callable[[], Mapping[str, str]] = dict
        self._dropped = self._dropped_told = 0
        self.message_count = self.size_bytes = 0
        self.is_over = False
        """Nothing is written any more."""
        self.is_closing = False
        """What has come is to be written, and then the end."""
        self._writer: RecordingWriter | None = None
        self._flushed_s = -math.inf
        self._is_closed: threading.Event | None = None
        self._thread = among or WritingThread(first_s=0.0 if self._is_simulated else LOAD_AFTER_S)

    def start(self, about: Callable[[], Mapping[str, str]]) -> None:
        """Begin to write; `about` gives the metadata, and is called by the thread that writes."""
        self._about = about
        self._notices.append(Notice(0, Reason("recording", {"path": str(self.path)})))
        self._is_closed = threading.Event()
        self._thread.add(self)

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
        self.is_closing = True
        if self._is_closed is not None:
            self._thread.wake()
            self._is_closed.wait()

    def _waited(self) -> bool:
        """On simulated time, wait until there is room: it stands meanwhile."""
        while self._is_simulated and not self.is_over and len(self._queue) >= MOST_WAITING:
            time.sleep(0.001)
        return self._is_simulated

    # --- the thread that writes ---

    def write(self) -> bool:
        """Write what has come by now; False once the file is closed."""
        is_last = self.is_closing
        with self._failures_told():
            self._writer = self._writer or self._open()
            self._write_news(self._writer)
        if not (is_last or self.is_over):
            return True
        with self._failures_told():
            if self._writer is not None:
                self._writer.close()
                self.size_bytes = self.path.stat().st_size
        self.is_over = True
        if self._is_closed is not None:
            self._is_closed.set()
        return False

    @contextlib.contextmanager
    def _failures_told(self) -> Iterator[None]:
        """End the recording where something goes wrong within."""
        try:
            yield
        except OSError as error:
            self._end("recording_failed", problem=error.strerror or str(error))
        except Exception as error:  # noqa: BLE001 - a recording that breaks must end nothing else
            self._end("recording_failed", problem=f"{type(error).__name__}: {error}")

    def _open(self) -> RecordingWriter:
        from chatrobot.recording.writer import RecordingWriter

        self._redactor.refresh()
        return RecordingWriter(os.fdopen(self._descriptor, "wb"), self._about(), self._redactor)

    def _write_news(self, writer: RecordingWriter) -> None:
        self._redactor.refresh()
        has_news = self._drain(writer)
        if has_news and time.monotonic() - self._flushed_s >= FLUSH_S:
            writer.flush()
            self._flushed_s, self.size_bytes = time.monotonic(), writer.size_bytes
            if self.size_bytes > self._limit_bytes:
                self._end("recording_too_large", megabytes=round(self._limit_bytes / 1e6))

    def _drain(self, writer: RecordingWriter) -> bool:
        count = len(self._queue)
        for number in range(1, count + 1):
            topic, message, time_ns = self._queue.popleft()
            if isinstance(message, Event):
                message = Text(strict_json(message.to_json(), is_compact=True))
            elif (timed := stamped(message)) is not None:
                message = timed._replace(stamp_s=timed.stamp_s + self._began_ns * 1e-9)
            writer.write(topic, message, time_ns)
            if number % AT_ONCE == 0 and not (self._is_simulated or self.is_closing):
                time.sleep(PAUSE_S)
        self.message_count += count
        if self._dropped > self._dropped_told:
            self._dropped_told = self._dropped
            notice = Notice(0, Reason("recording_dropped", {"count": self._dropped}))
            self._notices.append(notice)
            writer.write(EVENTS, Text(strict_json(notice.to_json(), is_compact=True)), time.time_ns())
        return count > 0

    def _end(self, code: str, **values: Any) -> None:
        if self.is_over:
            return  # the first reason is told
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
        kept_s, said = self._kept.get(topic.name, (-math.inf, ()))
        if now_s - kept_s < CHANGING_S - _EARLY_S and isinstance(message, Odometry):
            return False  # four of five come to nothing more than this
        says = _says(message)
        if says is None:
            return True
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
