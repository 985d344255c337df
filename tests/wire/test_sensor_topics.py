"""Each sensor is heard where the wiring names it, and only if the robot has it and somebody listens."""

from __future__ import annotations

from typing import Any

from chatrobot.core.wiring import Wiring
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Flag, Imu, Number
from chatrobot.wire.wire import SENSOR_KINDS, subscribe_sensors


def test_a_sensor_is_heard_where_the_wiring_names_it() -> None:
    hub, heard = MemoryHub(), list[Any]()
    wiring = Wiring(imu_topic="gyro", battery_topic="power")
    wanted = ("imu", "bumper")
    subscribe_sensors(hub.connect(), wiring, dict.fromkeys(wanted, heard.append))
    robot = hub.connect()
    robot.publish("gyro", Imu(1.0, 0.5))
    robot.publish("bumper", Flag(True))
    robot.publish("power", Number(80.0))
    assert heard == [Imu(1.0, 0.5)]


def test_every_sensor_of_a_wiring_is_of_a_known_kind() -> None:
    full = Wiring(imu_topic="i", scan_topic="s", bumper_topic="b", battery_topic="p")
    assert full.sensor_topics.keys() == SENSOR_KINDS.keys()
    assert Wiring().sensor_topics == {"odom": "odom"}
