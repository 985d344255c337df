"""The map of a drive on any surface: the world, the ways told, measured and true, and where something happened."""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy

from chatrobot.cli.drawing.extent import Extent, Orientation, extent_of_world
from chatrobot.cli.drawing.ground import AMBER, END, FAINT, RED, START, Ground, Rgb
from chatrobot.cli.drawing.surface import XY, Box, Surface
from chatrobot.cli.report.drive import Drive, Way

TOLD, MEASURED, TRUE = (168, 180, 204), (19, 122, 84), (138, 63, 184)
TOLD_PX, MEASURED_PX, TRUE_PX = 8.0, 3.0, 1.4
"""The way told is a broad band under the others, so that all three are seen where they agree."""
MARK_COLOURS: dict[str, Rgb] = {"stop": RED, "limit": AMBER, "refusal": FAINT}
MOST_MARKS = 30
"""More of them would hide the map; the timeline has all."""
LEGEND: tuple[tuple[str, Rgb], ...] = (("told", TOLD), ("measured", MEASURED), ("true", TRUE))
_NEAR_PX = 26.0
SIMPLIFIED_PX = 0.4
"""What a line is off after points were left out; nobody sees it."""


def extent_of(drive: Drive) -> Extent:
    """Return the part of the plane that the map shows."""
    ways = [*drive.told, *drive.measured, *drive.true]
    points = [point[:2] for way in ways for point in way if math.hypot(*point[:2]) < _FAR_M]
    radius_m = max(math.hypot(*corner) for corner in drive.footprint_m)
    return extent_of_world(drive.world, points, margin_m=0.25 + radius_m, least_m=3.0)


_FAR_M = 10_000.0


def map_size(drive: Drive, width_px: int, most_height_px: int) -> tuple[int, int]:
    """Return how large the map is drawn within that much room."""
    extent = extent_of(drive)
    height = width_px * extent.height_m / extent.width_m
    return width_px, round(min(most_height_px, max(0.4 * width_px, height)))


class DriveMap:
    """The map on a part of a surface."""

    def __init__(self, drive: Drive, surface: Surface, box: Box) -> None:
        self._drive = drive
        self.ground = Ground(surface, extent_of(drive), Orientation(drive.world), box)

    def on(self, surface: Surface) -> DriveMap:
        """Return the same map on another surface, on which nothing is drawn yet."""
        other = copy(self)
        other.ground = self.ground.on(surface)
        return other

    def draw(self) -> None:
        """Draw the world, the ways, the robot at their ends, the marks with their numbers, and names where room is."""
        drive, world = self._drive, self._drive.world
        self.ground.draw(world)
        for way in drive.told:
            self.way(way, TOLD, TOLD_PX)
        for way in drive.measured:
            self.way(way, MEASURED, MEASURED_PX)
        for way in drive.true:
            self.way(way, TRUE, TRUE_PX)
        ends = drive.measured or drive.true
        if ends:
            self.ground.robot(ends[0][0], drive.footprint_m, START)
            self.ground.robot(ends[-1][-1], drive.footprint_m, END)
        self.draw_marks()
        self.ground.places(world)
        self.ground.name_obstacles(world)

    def way(self, way: Way, colour: Rgb, width_px: float) -> None:
        """Draw one way."""
        points = simplified(self.ground.points(point[:2] for point in way), SIMPLIFIED_PX)
        if len(points) > 1:
            self.ground.surface.line(points, colour, width_px)

    def draw_marks(self, until_s: float = math.inf) -> None:
        """Draw the marks up to that time; those at one spot stand beside each other."""
        standing: list[XY] = []
        for number, mark in enumerate(self._drive.marks[:MOST_MARKS], 1):
            if mark.at is None or mark.times_s[0] > until_s:
                continue
            x, y = self.ground.at(*mark.at)
            while any(math.dist((x, y), other) < _NEAR_PX for other in standing):
                x += _NEAR_PX + 2.0
            standing.append((x, y))
            self.ground.mark((x, y), str(number), MARK_COLOURS[mark.kind])


def simplified(points: Sequence[XY], tolerance_px: float) -> list[XY]:
    """Leave out the points that a line does not need (Douglas and Peucker), without recursion."""
    if len(points) < 3:
        return [*points]
    kept = {0, len(points) - 1}
    waiting = [(0, len(points) - 1)]
    while waiting:
        first, last = waiting.pop()
        farthest, distance = _farthest(points, first, last)
        if distance > tolerance_px:
            kept.add(farthest)
            waiting += [(first, farthest), (farthest, last)]
    return [points[index] for index in sorted(kept)]


def _farthest(points: Sequence[XY], first_index: int, last_index: int) -> tuple[int, float]:
    import numpy as np

    inner = np.asarray(points[first_index + 1 : last_index], dtype=float)
    if not len(inner):
        return first_index, 0.0
    start, end = np.asarray(points[first_index]), np.asarray(points[last_index])
    along = end - start
    squared = float(along @ along)
    share = np.clip((inner - start) @ along / squared, 0.0, 1.0) if squared > 0.0 else np.zeros(len(inner))
    distances = np.hypot(*(inner - start - share[:, None] * along).T)
    index = int(distances.argmax())
    return first_index + 1 + index, float(distances[index])
