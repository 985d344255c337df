"""Nothing moves without the sensors that the profile requires."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.governor.situations import MECANUM, at, with_safety

from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Twist
from chatrobot.governor.rule import SensorRule, silent_after_s
from chatrobot.plan.steps import Drive, Plan
from chatrobot.robots.profile import Safety
from chatrobot.testing.rig import Rig

ALL = with_safety(Safety(requires=("odom", "scan", "imu")))
SLOW = Twist(0.1, 0.0, 0.0)
FRESH = {"odom": 0.3, "scan": 0.5, "imu": 0.3}


def test_with_all_of_them_fresh_it_moves() -> None:
    assert SensorRule(ALL).judge(SLOW, at(**FRESH)).factor == 1.0


@pytest.mark.parametrize("sensor", FRESH)
@pytest.mark.parametrize("more_s", [0.001, float("inf"), float("nan")])
def test_one_that_is_late_silent_or_odd_stops_it(sensor: str, more_s: float) -> None:
    ruling = SensorRule(ALL).judge(SLOW, at(**{**FRESH, sensor: FRESH[sensor] + more_s}))
    assert ruling.factor == 0.0
    assert ruling.reason is not None
    assert (ruling.reason.code, ruling.reason.values) == ("sensor_silent", {"sensor": sensor})


@pytest.mark.parametrize("sensor", FRESH)
def test_one_that_never_spoke_stops_it(sensor: str) -> None:
    ages = {name: age for name, age in FRESH.items() if name != sensor}
    assert SensorRule(ALL).judge(SLOW, at(**ages)).factor == 0.0


def test_zero_needs_no_sensor() -> None:
    assert SensorRule(ALL).judge(ZERO_TWIST, at()).factor == 1.0


def test_a_slow_lidar_may_take_its_time() -> None:
    assert MECANUM.lidar is not None
    slow = replace(MECANUM, lidar=replace(MECANUM.lidar, rate_hz=2.0))
    assert silent_after_s(slow, "scan") == 2.0
    assert silent_after_s(MECANUM, "scan") == 0.5
    assert silent_after_s(replace(MECANUM, lidar=None), "scan") == 0.3
    assert silent_after_s(MECANUM, "odom") == 0.3


def test_a_lidar_that_falls_silent_ends_the_motion_where_the_profile_requires_it() -> None:
    rig = Rig(with_safety(Safety(requires=("scan",))))

    def cut(t_s: float) -> None:
        if t_s > 1.0:
            rig.sensors._scan_at_s = min(rig.sensors._scan_at_s, 1.5)

    executor = rig.run(Plan((Drive(distance_m=5.0, speed_mps=1.0),)), cut)
    assert executor.outcome == "stopped"
    assert executor.reason is not None
    assert executor.reason.code == "sensor_silent"


def test_a_lidar_that_falls_silent_slows_the_motion_where_it_does_not() -> None:
    rig = Rig(MECANUM)

    def cut(_t_s: float) -> None:
        rig.sensors._scan_at_s = -9.0

    assert rig.run(Plan((Drive(distance_m=0.3, speed_mps=1.0),)), cut).outcome == "completed"
    assert max(twist.speed_mps for twist in rig.sent) == pytest.approx(MECANUM.safety.blind_speed_mps)
    assert rig.robot.true_pose != ORIGIN
