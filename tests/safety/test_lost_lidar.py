"""A lidar that shows nothing at all is none: the robot goes at its blind speed, and takes nothing for a free way."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from chatrobot.plan.steps import Drive, Plan
from chatrobot.sim.shapes import rectangle
from chatrobot.testing.rig import Rig
from chatrobot.wire.messages import LaserScan

Spoil = Callable[[LaserScan], LaserScan]
BLIND_MPS = 0.1


def spoilt_rig(spoil: Spoil) -> Rig:
    """A wall two metres ahead, and a lidar whose messages are spoilt on their way."""
    rig = Rig()
    rig.robot.add_obstacle("wall", rectangle(2.1, 0.0, 0.2, 4.0))
    publish = rig.robot._wire.publish  # type: ignore[union-attr]

    def publish_spoilt(topic: str, message: Any) -> None:
        publish(topic, spoil(message) if isinstance(message, LaserScan) else message)

    rig.robot._wire.publish = publish_spoilt  # type: ignore[union-attr,method-assign]
    rig.live(0.8)
    return rig


def top_speed_mps(rig: Rig) -> float:
    speeds = [0.0]
    rig.run(
        Plan((Drive(distance_m=1.0, speed_mps=0.6),)),
        lambda _: speeds.append(rig.robot.true_twist.speed_mps),
    )
    return max(speeds)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda scan: scan._replace(range_max_m=0.0),
        lambda scan: scan._replace(range_max_m=math.nan),
        lambda scan: scan._replace(range_min_m=math.nan),
        lambda scan: scan._replace(range_min_m=99.0),
        lambda scan: scan._replace(ranges_m=[math.nan] * len(scan.ranges_m)),
        lambda scan: scan._replace(ranges_m=[-1.0] * len(scan.ranges_m)),
        lambda scan: scan._replace(ranges_m=[0.0] * len(scan.ranges_m)),
        lambda scan: scan._replace(ranges_m=[]),
    ],
    ids=["max 0", "max nan", "min nan", "min 99", "all nan", "all negative", "all zero", "no beams"],
)
def test_a_scan_that_shows_nothing_is_no_scan(spoil: Spoil) -> None:
    assert top_speed_mps(spoilt_rig(spoil)) < BLIND_MPS + 0.01


def test_a_driver_that_calls_zero_its_minimum_range_still_means_no_return_by_zero() -> None:
    rig = spoilt_rig(
        lambda scan: scan._replace(
            range_min_m=0.0, ranges_m=[r if math.isfinite(r) else 0.0 for r in scan.ranges_m]
        )
    )
    assert top_speed_mps(rig) > 0.5
    assert not rig.robot.in_contact


def test_a_lidar_that_is_covered_under_way_slows_the_robot() -> None:
    covered = False

    def cover(scan: LaserScan) -> LaserScan:
        return scan._replace(ranges_m=[0.0] * len(scan.ranges_m)) if covered else scan

    rig = spoilt_rig(cover)
    speeds: list[float] = []

    def watch(t_s: float) -> None:
        nonlocal covered
        covered = t_s > 1.0
        if t_s > 2.0:
            speeds.append(rig.robot.true_twist.speed_mps)

    rig.run(Plan((Drive(distance_m=1.2, speed_mps=0.3),)), watch)
    assert 0.0 < max(speeds) < BLIND_MPS + 0.01
