"""What the robot's sensors say, on its way to a program that listens. Wires speak in threads of their own."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from chatrobot.core.wiring import Wiring
from chatrobot.wire.messages import Odometry
from chatrobot.wire.sensor_topics import subscribe_sensors
from chatrobot.wire.wire import Wire

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
