"""What a picture wants to know about a predicted way: its points, where along it something happens, its colours."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from chatrobot.core.events import FindingSeen, Rehearsed
from chatrobot.core.geometry import Pose

Point = tuple[float, float, float]
Rgb = tuple[int, int, int]

_GRADIENT: tuple[Rgb, ...] = ((31, 119, 214), (125, 63, 190), (226, 76, 38))


def progress_colour(share: float) -> Rgb:
    """Blue at the beginning of a way, orange at its end."""
    at = min(1.0, max(0.0, share)) * (len(_GRADIENT) - 1)
    i = min(int(at), len(_GRADIENT) - 2)
    low, high, part = _GRADIENT[i], _GRADIENT[i + 1], at - i
    return (
        round(low[0] + (high[0] - low[0]) * part),
        round(low[1] + (high[1] - low[1]) * part),
        round(low[2] + (high[2] - low[2]) * part),
    )


def standing_points(
    way: Sequence[Point], spacing_m: float, spacing_rad: float = math.radians(30)
) -> Iterator[Point]:
    """Return poses at which to show the robot's outline: no nearer to each other than the spacing, both ends always."""
    last: Point | None = None
    for point in way:
        if (
            last is None
            or math.dist(point[:2], last[:2]) >= spacing_m
            or abs(point[2] - last[2]) >= spacing_rad
        ):
            last = point
            yield point
    if last is not None and way[-1] != last:
        yield way[-1]


def outline_at(footprint: Sequence[tuple[float, float]], pose: Pose) -> list[tuple[float, float]]:
    """Return a footprint, given in the robot's frame, where the robot is."""
    placed = (pose.compose(Pose(x, y)) for x, y in footprint)
    return [(corner.x_m, corner.y_m) for corner in placed]


def where_found(rehearsed: Rehearsed, finding: FindingSeen) -> tuple[float, float] | None:
    """Find where on the way a finding is: where it says so itself, else by its time."""
    values = finding.reason.values
    x, y = values.get("x_m"), values.get("y_m")
    if isinstance(x, (int, float)) and isinstance(y, (int, float)):
        return float(x), float(y)
    if not rehearsed.path:
        return None
    share = finding.t_s / rehearsed.duration_s if rehearsed.duration_s > 0.0 else 1.0
    point = rehearsed.path[round(min(1.0, max(0.0, share)) * (len(rehearsed.path) - 1))]
    return point[0], point[1]
