"""Planar messages become ROS messages and back, with REP-103's units and REP-105's frames."""

from __future__ import annotations

import json
import math
from types import SimpleNamespace
from typing import Any

import pytest
from about import About
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.wiring import Wiring
from chatrobot.testing.wire_contract import ONE_OF_EACH
from chatrobot.wire.codec import as_base64
from chatrobot.wire.messages import Message, Number, Odometry, Text, TwistMessage
from chatrobot.wire.ros_messages import is_sensor, ros_form, transform

PLAIN = Wiring()


def as_object(fields: dict[str, Any]) -> Any:
    return json.loads(
        json.dumps(fields, default=as_base64), object_hook=lambda found: SimpleNamespace(**found)
    )


@pytest.mark.parametrize("message", ONE_OF_EACH, ids=lambda message: type(message).__name__)
def test_every_message_survives_the_way_there_and_back(message: Message) -> None:
    form = ros_form("topic", type(message), PLAIN)
    assert About(message) == form.from_ros(as_object(form.to_ros(message)))


@given(st.floats(-20.0, 20.0))
def test_a_heading_survives_its_quaternion(yaw_rad: float) -> None:
    form = ros_form("odom", Odometry, PLAIN)
    back = form.from_ros(as_object(form.to_ros(Odometry(0.0, 0.0, 0.0, yaw_rad, 0.0, 0.0, 0.0))))
    assert isinstance(back, Odometry)
    assert math.cos(back.yaw_rad - yaw_rad) == pytest.approx(1.0)


def test_a_tilted_robot_has_a_heading() -> None:
    form = ros_form("odom", Odometry, PLAIN)
    fields = form.to_ros(Odometry(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    roll, yaw = 0.1, 1.0
    fields["pose"]["pose"]["orientation"] = {
        "x": math.sin(roll / 2) * math.cos(yaw / 2),
        "y": math.sin(roll / 2) * math.sin(yaw / 2),
        "z": math.cos(roll / 2) * math.sin(yaw / 2),
        "w": math.cos(roll / 2) * math.cos(yaw / 2),
    }
    back = form.from_ros(as_object(fields))
    assert isinstance(back, Odometry)
    assert back.yaw_rad == pytest.approx(1.0, abs=1e-9)


def test_the_profile_decides_the_types_of_its_own_topics_alone() -> None:
    wiring = Wiring(cmd_vel_type="TwistStamped", odom_type="turtlesim/Pose", battery_topic="power")
    assert ros_form("cmd_vel", TwistMessage, wiring).type_name == "geometry_msgs/msg/TwistStamped"
    assert ros_form("other", TwistMessage, wiring).type_name == "geometry_msgs/msg/Twist"
    assert ros_form("odom", Odometry, wiring).type_name == "turtlesim/msg/Pose"
    assert ros_form("power", Number, wiring).type_name == "sensor_msgs/msg/BatteryState"
    assert ros_form("number", Number, wiring).type_name == "std_msgs/msg/Float64"


def test_a_turtle_says_where_it_is_and_how_fast() -> None:
    form = ros_form("odom", Odometry, Wiring(odom_type="turtlesim/Pose"))
    turtle = SimpleNamespace(x=5.5, y=4.0, theta=-1.0, linear_velocity=0.5, angular_velocity=0.25)
    assert form.from_ros(turtle) == Odometry(0.0, 5.5, 4.0, -1.0, 0.5, 0.0, 0.25)


@pytest.mark.parametrize(
    ("percentage", "told"),
    [
        (0.5, Number(50.0)),
        (1.0, Number(100.0)),
        (87.0, Number(87.0)),
        (math.nan, None),
        (None, None),
        (-1.0, None),
    ],
)
def test_a_battery_says_per_cent_or_nothing(percentage: float | None, told: Number | None) -> None:
    form = ros_form("power", Number, Wiring(battery_topic="power"))
    assert form.from_ros(SimpleNamespace(percentage=percentage)) == told


@pytest.mark.parametrize("kind", [TwistMessage, Odometry, Number, Text])
@pytest.mark.parametrize("wrong", [None, 5, SimpleNamespace(), SimpleNamespace(data=None)])
def test_an_object_of_another_shape_is_an_error_of_the_kinds_promised(kind: type, wrong: object) -> None:
    with pytest.raises((AttributeError, TypeError, ValueError)):
        ros_form("topic", kind, PLAIN).from_ros(wrong)


def test_sensors_may_be_published_as_ros_publishes_sensors() -> None:
    wiring = Wiring(bumper_topic="bumper")
    assert is_sensor("anything", Odometry, wiring)
    assert not is_sensor("cmd_vel", TwistMessage, wiring)


def test_a_transform_says_where_the_child_is() -> None:
    made = transform("odom", "base_link", 1.5, 2.0, -3.0, math.pi)
    assert (made["header"]["frame_id"], made["child_frame_id"]) == ("odom", "base_link")
    assert made["header"]["stamp"] == {"sec": 1, "nanosec": 500_000_000}
    assert made["transform"]["translation"] == {"x": 2.0, "y": -3.0}
    assert made["transform"]["rotation"]["z"] == pytest.approx(1.0)
