"""What the lidar sees in eight numbers."""

from __future__ import annotations

import math

from chatrobot.motion.telemetry import sectors_m
from chatrobot.robots.load import load_profile
from chatrobot.wire.messages import LaserScan


def test_each_sector_tells_the_way_from_the_robots_edge_to_the_nearest_thing() -> None:
    profile = load_profile("wheeltec_mini_mec")
    ranges = [math.inf] * 360
    ranges[180] = 1.0  # straight ahead
    ranges[180 + 90] = 2.0  # left
    ranges[180 + 92] = 0.0  # no return
    scan = LaserScan(0.0, -math.pi, math.radians(1.0), 0.05, 8.0, ranges)
    seen = sectors_m(profile, scan)
    assert seen[1] is None
    assert seen[0] is not None
    assert 0.7 < seen[0] < 1.0
    assert seen[2] is not None
    assert 1.7 < seen[2] < 2.0
    assert [seen[sector] for sector in (3, 4, 5, 6, 7)] == [None] * 5


def test_without_a_lidar_nothing_is_told() -> None:
    assert sectors_m(load_profile("turtlesim"), None) == ()
