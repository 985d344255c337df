"""A sandboxed program on the clock of its host: real time, or a simulation's, which rehearsal and `--fast` share.

Either way the program hears the robot's sensors through one mailbox.
"""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Sequence
from functools import partial
from typing import Any, Protocol

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.programs.events import ENDS, AsksTime, Beat, Died, Listens, ProgramEvent
from chatrobot.programs.sandboxed import SandboxedProgram
from chatrobot.wire.messages import Flag, Imu, LaserScan, Message, Number, Odometry
from chatrobot.wire.wire import SENSOR_KINDS, Wire, subscribe_sensors

POLLS_A_TICK = 8
"""A flood is read on with the next tick: the control loop has other work."""
STEP_LIMIT_S = 5.0
"""A program on virtual time that computes for so long here, without its time going on, is ended."""
MOST_KEPT = 100
"""Messages of one sensor, whatever depth the program asks for."""
_WAIT_S = 0.2
_SLACK_S = 1e-7


class LiveProgram(Protocol):
    """A program that is running: `RealTimeProgram`, or `SteppedProgram` in step with a simulation."""

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        """Return what it did up to `now_s` after its launch. Never blocks on a real clock."""
        ...

    def close(self) -> None:
        """End it now, if it still runs."""
        ...


class SensorMailbox:
    """Keeps what the running program listens to, as deep as it wants it. Wires speak in threads of their own.

    Of odometry, gyro and lidar it takes the newest once a tick: programs need no more than 50 Hz.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._kept: dict[str, deque[list[Any]]] = {}
        self._said: deque[tuple[str, Message]] = deque(maxlen=MOST_KEPT)
        self._yaw_rad = 0.0

    def attach(self, wire: Wire, wiring: Wiring) -> None:
        """Subscribe to what the profile says the robot has."""
        subscribe_sensors(wire, wiring, {sensor: partial(self._hear, sensor) for sensor in SENSOR_KINDS})

    def forget(self) -> None:
        """Begin anew for another program, which listens to nothing yet."""
        with self._lock:
            self._kept = {}
            self._said.clear()

    def listen(self, sensor: str, depth: int) -> None:
        """Keep what that sensor says from now on, the last `depth` of it."""
        with self._lock:
            before = self._kept.get(sensor, deque[list[Any]]())
            most = max(1, min(max(depth, before.maxlen or 1), MOST_KEPT))
            self._kept[sensor] = deque(before, most)

    @property
    def sensors(self) -> frozenset[str]:
        """Return the sensors that the program listens to."""
        return frozenset(self._kept)

    def collect(self, now_s: float) -> None:
        """Stamp what was said since the last tick with the program's own time."""
        with self._lock:
            newest = dict(self._said)
            for sensor, message in self._said:
                if message is newest[sensor] or isinstance(message, (Flag, Number)):
                    self._kept[sensor].append([sensor, now_s, *self._numbers(message)])
            self._said.clear()

    def take(self) -> list[list[Any]]:
        """Return what was collected since the last time, by its stamp: (sensor, stamp, numbers…)."""
        with self._lock:
            taken = sorted(
                (words for kept in self._kept.values() for words in kept), key=lambda words: words[1]
            )
            for kept in self._kept.values():
                kept.clear()
        return taken

    def _hear(self, sensor: str, message: Message) -> None:
        with self._lock:
            if isinstance(message, Odometry):
                self._yaw_rad = message.yaw_rad
            if sensor in self._kept:
                self._said.append((sensor, message))

    def _numbers(self, message: Message) -> Sequence[Any]:
        """Return what the program's side makes a ROS message of, but for its stamp."""
        if isinstance(message, Imu):
            return (message.wz_radps, self._yaw_rad)
        if isinstance(message, LaserScan):
            return (*message[1:-1], [round(range_m, 4) for range_m in message.ranges_m])
        return message if isinstance(message, (Flag, Number)) else message[1:]


def is_tick(now_s: float) -> bool:
    """Tell whether the control loop ticks then, on a clock that does not jitter."""
    return abs(now_s - round(now_s / TICK_S) * TICK_S) < _SLACK_S


class RealTimeProgram:
    """A program that runs by itself: what it said since the last tick is read, what sensors said is passed on."""

    def __init__(self, program: SandboxedProgram, sensors: SensorMailbox) -> None:
        self._program = program
        self._sensors = sensors

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        """Return what it said since the last call, at most a tick's worth."""
        found: list[ProgramEvent] = []
        for _ in range(POLLS_A_TICK):
            events = self._program.poll()
            found += events
            for event in events:
                if isinstance(event, Listens):
                    self._sensors.listen(event.sensor, event.depth)
            if not events:
                break
        self._sensors.collect(now_s)
        for sensor, *values in self._sensors.take():
            self._program.tell(sensor, values)
        return found

    def close(self) -> None:
        """End it now, if it still runs."""
        self._program.close()


class SteppedProgram:
    """A program on virtual time: it gets as much of it as has passed here, and what sensors said meanwhile.

    Args:
        limit_s: of this machine's time, for one step; with `in_all`, for its whole life.
    """

    def __init__(
        self,
        program: SandboxedProgram,
        sensors: SensorMailbox,
        *,
        limit_s: float = STEP_LIMIT_S,
        in_all: bool = False,
    ) -> None:
        self._program = program
        self._sensors = sensors
        self._limit_s = limit_s
        self._began_s = time.monotonic() if in_all else None
        self._horizon_s = program.settings.horizon_s
        self._now_s = 0.0
        self._coming: deque[ProgramEvent] = deque()
        self._asking: AsksTime | None = None

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        """Return what it did up to `now_s` of its time; the last event is its end, or a beat."""
        self._now_s = now_s
        if is_tick(now_s):
            self._sensors.collect(now_s)
        began_s = time.monotonic() if self._began_s is None else self._began_s
        found: list[ProgramEvent] = []
        while True:
            while self._coming and self._time_of(self._coming[0]) <= now_s + _SLACK_S:
                event = self._coming.popleft()
                if isinstance(event, Listens):
                    self._sensors.listen(event.sensor, event.depth)
                elif isinstance(event, AsksTime):
                    self._asking = event
                else:
                    found.append(event)
                if isinstance(event, ENDS):
                    return found
            if self._coming or not self._may_go_on(now_s):
                return [*found, Beat(now_s)]
            if time.monotonic() - began_s > self._limit_s:
                self._program.close()
                return [*found, Died(Reason("program_too_busy", {"limit_s": self._limit_s}), "")]
            self._coming.extend(self._program.poll(_WAIT_S))

    @property
    def next_s(self) -> float:
        """Return when it next does or hears something, as far as is known after `poll_until`."""
        known_s = self._horizon_s
        if self._coming:
            known_s = self._time_of(self._coming[0])
        elif self._asking is not None:
            known_s = min(self._asking.until_s, known_s)
        return min(known_s, self._next_tick_s) if self._sensors.sensors else known_s

    def close(self) -> None:
        """End it now, if it still runs."""
        self._program.close()

    def _may_go_on(self, now_s: float) -> bool:
        """Answer what it asks, if there is an answer by now; True where it computes."""
        asking = self._asking
        if asking is None:
            return self._program.end is None
        until_s = min(asking.until_s, self._horizon_s)
        is_reached = until_s <= now_s + _SLACK_S
        messages = self._sensors.take() if asking.wakes or is_reached else []
        if not messages and not is_reached:
            return False
        self._asking = None
        reached_s = min(now_s, until_s) if is_reached else now_s
        self._program.let_pass(max(reached_s, asking.t_s), self._next_tick_s, messages)
        return True

    @property
    def _next_tick_s(self) -> float:
        return (int((self._now_s + _SLACK_S) / TICK_S) + 1) * TICK_S

    def _time_of(self, event: ProgramEvent) -> float:
        return self._now_s if isinstance(event, Died) else min(event.t_s, self._horizon_s)


class HeldTwist:
    """Holds what a program published last, for as long as the base would have held it.

    Args:
        base_timeout_s: of the robot's wiring; None holds for ever. The lease ends it in any case.
    """

    def __init__(self, base_timeout_s: float | None) -> None:
        self._timeout_s = math.inf if base_timeout_s is None else base_timeout_s
        self._twist = ZERO_TWIST
        self.ends_s = -math.inf
        """When it turns to zero."""

    def publish(self, twist: Twist, now_s: float) -> None:
        """Hold `twist` from now on."""
        self._twist, self.ends_s = twist, now_s + self._timeout_s

    def at(self, now_s: float) -> Twist:
        """Return what is held then."""
        return self._twist if now_s < self.ends_s else ZERO_TWIST
