"""A recording as what happened, one thing after the other: what a display is told to show it again.

Nothing here knows a robot: events are told to a display, and no wire is opened.
"""

from __future__ import annotations

import math
import time
from bisect import bisect_right
from collections.abc import Callable, Iterator
from typing import NamedTuple, Union

from chatrobot.core.events import Event, Scan, Telemetry, event_from_json
from chatrobot.core.geometry import Pose, Twist
from chatrobot.execution.sensors import scan_points_m
from chatrobot.recording.reader import Recording
from chatrobot.robots.profile import Lidar

TELEMETRY_S, SCAN_S = 0.1, 0.2
"""So often a display is told where the robot is, and what its lidar sees, as it is told of one that is there."""
WAIT_S = 0.1
"""No longer than this passes before it is asked whether to go on."""


class Heard(NamedTuple):
    """What a person said, and the turn that it began; 0 where nobody knows."""

    turn: int
    text: str


Shown = Union[Event, Heard]


def shown(recording: Recording, lidar: Lidar | None = None) -> list[tuple[float, Shown]]:
    """Return everything that a display shows, with its seconds since the recording began, in order.

    Telemetry is as it was told; where nobody told it (a robot that others drive), it is made of the odometry. With
    `lidar` there are scans, too.
    """
    found: list[tuple[float, Shown]] = list(_told(recording))
    names = {type(item) for _, item in found}
    if Heard not in names:
        found += [(t_s, Heard(0, text)) for t_s, text in recording.words]
    if Telemetry not in names:
        found += _telemetry(recording)
    if lidar is not None:
        told = [(t_s, item.pose) for t_s, item in found if isinstance(item, Telemetry)]
        found += _scans(recording, lidar, told)
    return sorted(found, key=lambda item: item[0])


def play(
    items: list[tuple[float, Shown]],
    speed_factor: float,
    show: Callable[[float, Shown], None],
    goes_on: Callable[[], bool] = lambda: True,
) -> None:
    """Show each at its time, `speed_factor` times as fast as it was, as long as it goes on."""
    began_s = time.monotonic()
    for t_s, item in items:
        while (left_s := began_s + t_s / speed_factor - time.monotonic()) > 0.0 and goes_on():
            time.sleep(min(left_s, WAIT_S))
        if not goes_on():
            return
        show(t_s, item)


def _told(recording: Recording) -> Iterator[tuple[float, Shown]]:
    for t_s, data in recording.events:
        if data["event"] == "heard":
            yield t_s, Heard(int(data.get("turn", 0)), str(data.get("text", "")))
            continue
        try:
            yield t_s, event_from_json(data)
        except ValueError:
            continue  # of a newer version


def _telemetry(recording: Recording) -> Iterator[tuple[float, Shown]]:
    path_m, before, due_s = 0.0, None, 0.0
    for t_s, odometry in recording.odometry:
        pose = Pose(odometry.x_m, odometry.y_m, odometry.yaw_rad)
        twist = Twist(odometry.vx_mps, odometry.vy_mps, odometry.wz_radps)
        path_m += pose.distance_to(before) if before is not None else 0.0
        before = pose
        if t_s >= due_s:
            due_s = t_s + TELEMETRY_S
            yield t_s, Telemetry(0, pose, twist, path_m, moving=not twist.is_zero)


def _scans(
    recording: Recording, lidar: Lidar, told: list[tuple[float, Pose]]
) -> Iterator[tuple[float, Shown]]:
    """Give what the lidar saw, from where the robot took itself to be: last told, and driven on since by the wheels."""
    wheels = [
        (t_s, Pose(odometry.x_m, odometry.y_m, odometry.yaw_rad)) for t_s, odometry in recording.odometry
    ]
    due_s = -math.inf
    for t_s, scan in recording.scans:
        here, since = _last(wheels, t_s), _last(told, t_s)
        if t_s < due_s or here is None:
            continue
        due_s = t_s + SCAN_S
        pose = here[1]
        if since is not None and (before := _last(wheels, since[0])) is not None:
            pose = since[1].compose(pose.relative_to(before[1]))
        yield t_s, Scan(0, pose, tuple(scan_points_m(lidar, scan, pose)))


def _last(timed: list[tuple[float, Pose]], t_s: float) -> tuple[float, Pose] | None:
    """Return the last of them that had come by then."""
    at = bisect_right(timed, t_s, key=lambda one: one[0]) - 1
    return timed[at] if at >= 0 else None
