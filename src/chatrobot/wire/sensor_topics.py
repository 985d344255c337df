"""Hearing the sensors of one robot: each on the topic that its wiring names, as the message that it is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from chatrobot.core.wiring import Wiring
from chatrobot.wire.messages import Flag, Imu, LaserScan, Number, Odometry
from chatrobot.wire.wire import Wire

SENSOR_KINDS: Mapping[str, type[Any]] = {
    "odom": Odometry,
    "imu": Imu,
    "scan": LaserScan,
    "bumper": Flag,
    "battery": Number,
}


def subscribe_sensors(wire: Wire, wiring: Wiring, hear: Mapping[str, Callable[[Any], None]]) -> None:
    """Have each callback of `hear`, by its sensor's name, take what that sensor says, if the robot has it."""
    for sensor, topic in wiring.sensor_topics.items():
        if sensor in hear:
            wire.subscribe(topic, SENSOR_KINDS[sensor], hear[sensor])
