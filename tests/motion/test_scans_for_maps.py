"""Scans for a map: for who watches, at a map's rate, and nothing for anybody else."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
from tests.motion.far_robot import Rig

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.events import Event, Scan
from chatrobot.core.geometry import Pose
from chatrobot.execution.sensors import SCAN_POINTS, scan_points_m
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import Lidar
from chatrobot.wire.messages import LaserScan

WALLS_M = 0.1


class Watched:
    """A session in the furnished home on simulated time."""

    def __init__(self) -> None:
        self.heard: list[Event] = []
        self.connection: Connection = connect(Setup(world="home", fast=True), self.heard.append)
        self.session = self.connection.session

    def live(self, duration_s: float) -> list[Scan]:
        """Let time pass; the scans that came meanwhile."""
        before = len(self.heard)
        for _ in range(round(duration_s / 0.1)):
            self.session.pump(0.1)
            while (event := self.session._link.next_event(0.0)) is not None:
                self.heard.append(event)
        return [event for event in self.heard[before:] if isinstance(event, Scan)]


@pytest.fixture
def watched() -> Iterator[Watched]:
    made = Watched()
    yield made
    made.connection.close()


def test_nobody_hears_of_scans_unasked(watched: Watched) -> None:
    assert watched.live(1.0) == []


def test_who_watches_hears_at_most_five_a_second_until_they_look_away(watched: Watched) -> None:
    watched.session.watch_scans(True)
    told = watched.live(3.0)
    assert 8 <= len(told) <= 15
    assert all(0 < len(scan.points_m) <= SCAN_POINTS for scan in told)
    watched.session.watch_scans(False)
    watched.live(0.2)
    assert watched.live(1.0) == []


def test_the_points_lie_where_the_walls_are_wherever_the_robot_stands(watched: Watched) -> None:
    watched.session.watch_scans(True)
    first = watched.live(1.0)[-1]
    watched.session.do("turn left 40 degrees")
    second = watched.live(1.0)[-1]
    assert second.pose.yaw_rad == pytest.approx(math.radians(40.0), abs=0.05)
    near = sum(any(math.dist(a, b) < WALLS_M for b in second.points_m) for a in first.points_m)
    assert near > 0.9 * len(first.points_m), "turning moves no wall"


def test_an_agents_session_hears_none_that_it_did_not_ask_for(watched: Watched) -> None:
    heard: list[Event] = []
    agent = watched.connection.second_session("agent", heard.append).session
    watched.session.watch_scans(True)
    assert watched.live(1.0)
    agent.pump(0.1)
    assert not [event for event in heard if isinstance(event, Scan)]


def test_a_watcher_whose_beats_end_is_told_no_more() -> None:
    rig = Rig()
    rig.link.send("watch", scans=True)
    rig.pass_time(1.0)
    assert [event for event in rig.events if isinstance(event, Scan)]
    rig.link.beats = False
    rig.pass_time(1.0)
    rig.events.clear()
    rig.link.beats = True
    rig.pass_time(1.0)
    assert not [event for event in rig.events if isinstance(event, Scan)]


def test_of_many_beams_the_nearest_return_of_neighbours_is_shown() -> None:
    lidar = load_profile("wheeltec_mini_mec").lidar
    assert isinstance(lidar, Lidar)
    ranges = [3.0] * 720
    ranges[361] = 1.0
    ranges[0:4] = [math.inf, math.nan, 0.0, 99.0]
    scan = LaserScan(0.0, -math.pi, math.radians(0.5), 0.1, 12.0, ranges)
    points = scan_points_m(lidar, scan, Pose(1.0, 2.0, 0.0))
    assert len(points) == SCAN_POINTS - 1
    origin = (1.0 + lidar.x_m, 2.0 + lidar.y_m)
    distances = sorted(math.dist(point, origin) for point in points)
    assert distances[0] == pytest.approx(1.0, abs=0.01)
    assert distances[1] == pytest.approx(3.0, abs=0.01)
