"""The wiring that the wire shows goes before the profile's, where it is plain; and it is said."""

from __future__ import annotations

from dataclasses import replace

import pytest

from chatrobot.core.wiring import Wiring
from chatrobot.motion.topic_discovery import (
    IMU,
    ODOMETRY,
    TURTLE_POSE,
    TWIST,
    TWIST_STAMPED,
    fit,
    is_complete,
)
from chatrobot.wire.wire import Endpoint

AS_SAID = Wiring()
LISTENS = Endpoint("/cmd_vel", TWIST, "listens")
TELLS = Endpoint("/odom", ODOMETRY, "publishes")


def fitted(*seen: Endpoint, wiring: Wiring = AS_SAID, namespace: str = "") -> tuple[Wiring, list[str]]:
    wiring, said = fit(wiring, seen, lambda topic: topic if topic.startswith("/") else f"{namespace}/{topic}")
    return wiring, [f"{reason.code} {reason.values.get('found', '')}".strip() for reason in said]


def test_a_robot_as_its_profile_says_is_left_alone() -> None:
    assert is_complete(AS_SAID, [LISTENS, TELLS], lambda topic: f"/{topic}")
    assert fitted(LISTENS, TELLS) == (AS_SAID, [])


def test_where_nothing_is_seen_the_profile_counts() -> None:
    assert not is_complete(AS_SAID, [], lambda topic: f"/{topic}")
    assert fitted() == (AS_SAID, [])


@pytest.mark.parametrize(("has", "gets"), [("Twist", "TwistStamped"), ("TwistStamped", "Twist")])
def test_velocities_are_of_the_type_that_is_listened_for(has: str, gets: str) -> None:
    wiring = Wiring(cmd_vel_type=has)  # type: ignore[arg-type]
    listens = Endpoint("/cmd_vel", f"geometry_msgs/msg/{gets}", "listens")
    assert fitted(listens, TELLS, wiring=wiring) == (
        replace(wiring, cmd_vel_type=gets),  # type: ignore[arg-type]
        ["cmd_vel_type_found"],
    )


def test_where_both_types_are_listened_for_the_profile_counts() -> None:
    both = (LISTENS, Endpoint("/cmd_vel", TWIST_STAMPED, "listens"))
    assert fitted(*both, TELLS) == (AS_SAID, [])


def test_the_only_odometry_there_is_is_taken_and_named() -> None:
    other = Endpoint("/odom_combined", ODOMETRY, "publishes")
    assert fitted(LISTENS, other) == (
        replace(AS_SAID, odom_topic="/odom_combined"),
        ["sensor_found /odom_combined"],
    )


def test_of_two_odometries_none_is_guessed() -> None:
    others = [Endpoint(f"/{name}", ODOMETRY, "publishes") for name in ("wheel_odom", "ekf_odom")]
    assert fitted(LISTENS, *others) == (AS_SAID, ["sensor_unclear /ekf_odom, /wheel_odom"])


def test_who_only_listens_to_odometry_tells_none() -> None:
    assert fitted(LISTENS, Endpoint("/odom", ODOMETRY, "listens")) == (AS_SAID, [])


def test_odometry_of_the_other_type_is_read_as_what_it_is() -> None:
    turtle = Endpoint("/odom", TURTLE_POSE, "publishes")
    assert fitted(LISTENS, turtle) == (replace(AS_SAID, odom_type="turtlesim/Pose"), ["odom_type_found"])


def test_a_robot_in_another_namespace_is_named_and_not_taken() -> None:
    there = Endpoint("/robot1/cmd_vel", TWIST, "listens")
    assert fitted(there, TELLS) == (AS_SAID, ["cmd_vel_elsewhere /robot1/cmd_vel"])
    assert fitted(there, Endpoint("/robot1/odom", ODOMETRY, "publishes"), namespace="/robot1") == (
        AS_SAID,
        [],
    )


def test_a_gyro_elsewhere_is_taken_too_and_one_that_is_missing_is_waited_for() -> None:
    wiring = Wiring(imu_topic="imu")
    raw = Endpoint("/imu/data_raw", IMU, "publishes")
    assert not is_complete(wiring, [LISTENS, TELLS, raw], lambda topic: f"/{topic}")
    assert fitted(LISTENS, TELLS, raw, wiring=wiring) == (
        replace(wiring, imu_topic="/imu/data_raw"),
        ["sensor_found /imu/data_raw"],
    )
    assert fitted(LISTENS, TELLS, wiring=wiring) == (wiring, [])
    assert fitted(LISTENS, TELLS, raw) == (AS_SAID, [])


def test_another_robots_odometry_is_named_and_never_taken() -> None:
    theirs = Endpoint("/right/odom", ODOMETRY, "publishes"), Endpoint("/right/cmd_vel", TWIST, "listens")
    assert fitted(*theirs, namespace="/left") == (
        AS_SAID,
        ["cmd_vel_elsewhere /right/cmd_vel", "sensor_unclear /right/odom"],
    )
    assert fitted(LISTENS, *theirs) == (AS_SAID, ["sensor_unclear /right/odom"])
