"""A running program as Motion's control loop polls it, in real time or in step with a simulated clock, and the feed of
the robot's sensors to it. Wires speak in threads of their own."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from chatrobot.core.clock import TICK_S
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.programs.events import ENDS, AsksTime, Beat, Died, Listens, ProgramEvent
from chatrobot.programs.sandboxed import SandboxedProgram
from chatrobot.wire.messages import Odometry
from chatrobot.wire.sensor_topics import subscribe_sensors
from chatrobot.wire.wire import Wire

POLLS_A_TICK = 8
"""A flood is read on with the next tick: the control loop has other work."""
STEP_LIMIT_S = 5.0
"""A program on virtual time that computes for so long here, without its time going on, is ended."""
_WAIT_S = 0.2
_SLACK_S = 1e-9


class RealTimeProgram:
    """It runs by itself; what it said since the last tick is read, what sensors said is passed on."""

    def __init__(self, program: SandboxedProgram, senses: Senses) -> None:
        self._program = program
        self._senses = senses

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        found: list[ProgramEvent] = []
        for _ in range(POLLS_A_TICK):
            events = self._program.poll()
            found += events
            for event in events:
                if isinstance(event, Listens):
                    self._senses.listen(event.sensor, event.depth)
            if not events:
                break
        for words in self._senses.take():
            sensor, *values = stamped(words, now_s)
            self._program.tell(sensor, values)
        return found

    def close(self) -> None:
        self._program.close()


class InStepProgram:
    """It lives on virtual time: it gets as much of it as has passed, and what sensors said meanwhile."""

    def __init__(self, program: SandboxedProgram, senses: Senses) -> None:
        self._program = program
        self._senses = senses
        self._coming: deque[ProgramEvent] = deque()
        self._asking: AsksTime | None = None

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        found: list[ProgramEvent] = []
        waited_s = 0.0
        while True:
            while self._coming and _time_of(self._coming[0], now_s) <= now_s + _SLACK_S:
                event = self._coming.popleft()
                if isinstance(event, Listens):
                    self._senses.listen(event.sensor, event.depth)
                elif isinstance(event, AsksTime):
                    self._asking = event
                else:
                    found.append(event)
            if found and isinstance(found[-1], ENDS):
                return found
            if self._coming or not self._may_go_on(now_s):
                return [*found, Beat(now_s)]
            events = self._program.poll(_WAIT_S)
            self._coming.extend(events)
            waited_s = 0.0 if events else waited_s + _WAIT_S
            if waited_s > STEP_LIMIT_S:
                self._program.close()
                return [*found, Died(Reason("program_too_busy", {"limit_s": STEP_LIMIT_S}), "")]

    def close(self) -> None:
        self._program.close()

    def _may_go_on(self, now_s: float) -> bool:
        """Answer what it asks, if there is an answer by now; True where it computes."""
        asking = self._asking
        if asking is None:
            return self._program.end is None
        messages = self._senses.take() if asking.wakes or asking.until_s <= now_s + _SLACK_S else []
        if not messages and asking.until_s > now_s + _SLACK_S:
            return False
        reached_s = min(now_s, asking.until_s) if asking.until_s <= now_s + _SLACK_S else now_s
        self._asking = None
        told = [stamped(words, reached_s) for words in messages]
        self._program.let_pass(max(reached_s, asking.t_s), now_s + TICK_S, told)
        return True


def _time_of(event: ProgramEvent, now_s: float) -> float:
    return now_s if isinstance(event, Died) else event.t_s


Words = tuple[Any, ...]
"""(sensor, numbers…), without a stamp: the program's own time is what it gets."""

_MOST_KEPT = 50


class Senses:
    """Subscribed once; keeps what the running program listens to, as deep as it wants it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._kept: dict[str, deque[Words]] = {}
        self._yaw_rad = 0.0

    def attach(self, wire: Wire, wiring: Wiring) -> None:
        """Subscribe to what the profile says the robot has."""
        hear: dict[str, Callable[[Any], None]] = {
            "odom": self._on_odometry,
            "scan": lambda scan: self._keep(("scan", *scan[1:])),
            "imu": lambda imu: self._keep(("imu", imu.wz_radps, self._yaw_rad)),
            "bumper": lambda flag: self._keep(("bumper", flag.data)),
            "battery": lambda number: self._keep(("battery", number.data)),
        }
        subscribe_sensors(wire, wiring, hear)

    def forget(self) -> None:
        """Another program begins: it listens to nothing yet."""
        with self._lock:
            self._kept = {}

    def listen(self, sensor: str, depth: int) -> None:
        """From now on what that sensor says is kept."""
        with self._lock:
            before = self._kept.get(sensor, deque[Words]())
            most = max(1, min(max(depth, before.maxlen or 1), _MOST_KEPT))
            self._kept[sensor] = deque(before, most)

    def take(self) -> list[Words]:
        """What was said since the last time, oldest first for each sensor."""
        with self._lock:
            taken = [words for kept in self._kept.values() for words in kept]
            for kept in self._kept.values():
                kept.clear()
        return taken

    def _keep(self, words: Words) -> None:
        with self._lock:
            kept = self._kept.get(words[0])
            if kept is not None:
                kept.append(words)

    def _on_odometry(self, message: Odometry) -> None:
        self._yaw_rad = message.yaw_rad
        self._keep(("odom", *message[1:]))


def stamped(words: Words, stamp_s: float) -> Sequence[Any]:
    """As the program's side reads it: (sensor, stamp, numbers…)."""
    return [words[0], stamp_s, *words[1:]]
