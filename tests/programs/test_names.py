"""What programs import behaves as ROS 2 does, down to the words of its errors (checked against ROS in tests/ros)."""

from __future__ import annotations

import copy
from array import array
from typing import Any

import numpy as np
import pytest

from chatrobot.programs.check import ROBOT_MODULES
from chatrobot.programs.inside.interfaces import INTERFACES, kind
from chatrobot.programs.inside.top_level import modules
from chatrobot.programs.names.clock import ClockType, Duration, Infinite, Time
from chatrobot.programs.names.parameter import Parameter
from chatrobot.programs.names.qos import (
    InvalidQoSProfileException,
    QoSProfile,
    QoSReliabilityPolicy,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)
from chatrobot.programs.names.tf_transformations import (
    euler_from_quaternion,
    quaternion_from_euler,
    quaternion_inverse,
    quaternion_multiply,
)

Pose2D, PoseStamped, Quaternion, Twist, Vector3 = (
    kind(f"geometry_msgs/{name}") for name in ("Pose2D", "PoseStamped", "Quaternion", "Twist", "Vector3")
)
Odometry, LaserScan = kind("nav_msgs/Odometry"), kind("sensor_msgs/LaserScan")
Bool, Int8, String = (kind(f"std_msgs/{name}") for name in ("Bool", "Int8", "String"))
SetBool: Any = vars(INTERFACES["std_srvs.srv"])["SetBool"]


def test_what_is_there_may_be_imported() -> None:
    packages = {name.split(".")[0] for name in INTERFACES}
    assert set(modules()) - packages == ROBOT_MODULES


# --- messages ---


@pytest.mark.parametrize(
    ("kind", "field", "value", "words"),
    [
        (Vector3, "x", 1, "The 'x' field must be of type 'float'"),
        (Vector3, "x", "1", "The 'x' field must be of type 'float'"),
        (String, "data", 5, "The 'data' field must be of type 'str'"),
        (Bool, "data", 1, "The 'data' field must be of type 'bool'"),
        (Int8, "data", 1.0, "The 'data' field must be of type 'int'"),
        (Int8, "data", 128, "The 'data' field must be an integer in [-128, 127]"),
        (Twist, "linear", 0.2, "The 'linear' field must be a sub message of type 'Vector3'"),
    ],
)
def test_a_field_refuses_another_type(kind: Any, field: str, value: Any, words: str) -> None:
    with pytest.raises(AssertionError) as refused:
        setattr(kind(), field, value)
    assert str(refused.value).splitlines()[0] == words  # pytest writes below it what it compared
    with pytest.raises(AssertionError):
        kind(**{field: value})


def test_a_field_that_is_none_is_refused_either_way() -> None:
    with pytest.raises(AssertionError, match="Invalid arguments passed to constructor: speed"):
        Twist(speed=1.0)
    with pytest.raises(AttributeError, match="has no attribute 'speed'"):
        Twist().speed = 1.0
    with pytest.raises(TypeError):
        Twist(1.0)


def test_messages_are_shown_and_compared_as_in_ros() -> None:
    twist = Twist(linear=Vector3(x=0.2))
    assert repr(twist) == (
        "geometry_msgs.msg.Twist(linear=geometry_msgs.msg.Vector3(x=0.2, y=0.0, z=0.0), "
        "angular=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0))"
    )
    assert str(type(twist)) == "<class 'geometry_msgs.msg._twist.Twist'>"
    assert twist == copy.deepcopy(twist) != Twist()
    assert twist != "twist"
    assert Twist.get_fields_and_field_types() == {
        "linear": "geometry_msgs/Vector3",
        "angular": "geometry_msgs/Vector3",
    }
    assert Twist.__slots__ == ["_linear", "_angular"]
    assert Pose2D.__module__ == "geometry_msgs.msg._pose2_d"
    with pytest.raises(TypeError):
        hash(twist)


def test_defaults_and_arrays_are_those_of_ros() -> None:
    assert Quaternion().w == 1.0
    odometry = Odometry()
    assert odometry.pose.covariance.shape == (36,)
    assert odometry == Odometry()
    scan = LaserScan(ranges=[1.0, 2.0])
    assert scan.ranges == array("f", [1.0, 2.0])
    scan.ranges = np.array([0.5, 0.25], dtype=np.float32)
    assert min(scan.ranges) == 0.25
    with pytest.raises(AssertionError):
        scan.ranges = [1, 2]
    with pytest.raises(AssertionError):
        odometry.pose.covariance = [0.0] * 35
    stamped = PoseStamped()
    stamped.header.stamp.sec = 5
    assert PoseStamped().header.stamp.sec == 0


def test_services_have_a_request_and_a_response() -> None:
    assert SetBool.Request(data=True).data
    assert SetBool.Response().message == ""
    with pytest.raises(AssertionError):
        SetBool.Response(success="yes")


# --- time ---


def test_times_and_durations_reckon_as_in_rclpy() -> None:
    start = Time(seconds=5, clock_type=ClockType.ROS_TIME)
    later = start + Duration(seconds=1.5)
    assert (later - start).nanoseconds == 1_500_000_000
    assert later > start
    assert later.seconds_nanoseconds() == (6, 500_000_000)
    assert Time.from_msg(later.to_msg()) == later
    assert Duration.from_msg(Duration(seconds=2.5).to_msg()) == Duration(nanoseconds=2_500_000_000)
    assert str(Infinite) == "Infinite"
    with pytest.raises(TypeError, match="Can't subtract times with different clock types"):
        _ = later - Time(seconds=1)
    with pytest.raises(ValueError, match="Seconds value must not be negative"):
        Time(seconds=-1)


# --- QoS, parameters ---


def test_a_qos_profile_needs_a_depth() -> None:
    with pytest.raises(InvalidQoSProfileException):
        QoSProfile()
    assert QoSProfile(depth=5, reliability=QoSReliabilityPolicy.BEST_EFFORT) == qos_profile_sensor_data
    assert ReliabilityPolicy.short_keys()[1] == "reliable"


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (True, "BOOL"), (1, "INTEGER"), (1.0, "DOUBLE"), ("x", "STRING"), ([1, 2], "INTEGER_ARRAY"),
        (["a"], "STRING_ARRAY"), ([], "BYTE_ARRAY"), (None, "NOT_SET"),
    ],
)  # fmt: skip
def test_a_parameter_knows_its_type(value: Any, kind: str) -> None:
    assert Parameter("p", value=value).type_.name == kind


def test_a_parameter_of_the_wrong_type_is_refused() -> None:
    with pytest.raises(ValueError, match="do not agree"):
        Parameter("p", Parameter.Type.INTEGER, 1.0)


# --- tf_transformations ---


def test_euler_angles_and_quaternions_are_two_ways_to_say_the_same() -> None:
    for angles in ((0.0, 0.0, 1.0), (0.1, -0.2, 3.0), (-1.0, 0.5, -2.0)):
        quaternion = quaternion_from_euler(*angles)
        assert euler_from_quaternion(quaternion) == pytest.approx(angles)
        turned_back = quaternion_multiply(quaternion, quaternion_inverse(quaternion))
        assert turned_back.tolist() == pytest.approx([0.0, 0.0, 0.0, 1.0])
