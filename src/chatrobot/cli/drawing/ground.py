"""A world seen from above on a surface: grid, obstacles and places, and robots on it. Plans and reports share it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from copy import copy

from chatrobot.cli.drawing.extent import Extent, Orientation
from chatrobot.cli.drawing.surface import XY, Box, Surface
from chatrobot.cli.drawing.ways import outline_at
from chatrobot.core.geometry import Pose
from chatrobot.sim.world import World

PAPER, WHITE, INK, FAINT = (252, 252, 250), (255, 255, 255), (38, 43, 51), (112, 120, 132)
GRID, GRID_STRONG = (234, 236, 240), (214, 218, 226)
OBSTACLE, OBSTACLE_EDGE = (222, 226, 233), (150, 158, 172)
PLACE, START, END, RED, AMBER = (15, 118, 110), (31, 119, 214), (226, 76, 38), (205, 24, 40), (201, 122, 0)
_STEPS_M = (0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500)
_LEAST_STEP_PX = 55
Rgb = tuple[int, int, int]


class Ground:
    """An extent of the world on a part of a surface, and the labels that already stand there.

    Args:
        box: where on the surface; the extent is put in its middle, as large as it fits.
    """

    def __init__(self, surface: Surface, extent: Extent, orientation: Orientation, box: Box) -> None:
        self.surface, self.box = surface, box
        self._extent, self._orientation = extent, orientation
        left, top, right, bottom = box
        self.px_per_m = min((right - left) / extent.width_m, (bottom - top) / extent.height_m)
        self._off_x = (left + right - extent.width_m * self.px_per_m) / 2.0
        self._off_y = (top + bottom - extent.height_m * self.px_per_m) / 2.0
        self.taken: list[Box] = []

    def on(self, surface: Surface) -> Ground:
        """Return the same ground on another surface, without labels yet."""
        other = copy(self)
        other.surface, other.taken = surface, []
        return other

    def draw(self, world: World) -> None:
        """Draw what lies under everything: the grid, and what stands there."""
        self._grid()
        if world.allowed_area is not None:
            corners = self.points(world.allowed_area.points)
            self.surface.dashed([*corners, corners[0]], AMBER, 1.2)
        for _, outline in world.outline():
            self.surface.polygon(self.points(outline), fill=OBSTACLE, edge=OBSTACLE_EDGE, width_px=1.2)

    def at(self, x_m: float, y_m: float) -> XY:
        """Place a point in the frame of the start."""
        return self._on_grid(*self._orientation.point(x_m, y_m))

    def points(self, points: Iterable[tuple[float, float]]) -> list[XY]:
        """Place points."""
        return [self.at(*point) for point in points]

    def _on_grid(self, right_m: float, up_m: float) -> XY:
        """Place a point so far from the start along the axes of the picture."""
        return (
            self._off_x + (right_m - self._extent.min_x_m) * self.px_per_m,
            self._off_y + (self._extent.max_y_m - up_m) * self.px_per_m,
        )

    def _grid(self) -> None:
        left, top, right, bottom = self.box
        self.surface.box(self.box, fill=WHITE)
        step = next((step for step in _STEPS_M if step * self.px_per_m >= _LEAST_STEP_PX), 1000.0)
        first_m = self._extent.min_x_m + (left - self._off_x) / self.px_per_m
        for i in _multiples(first_m, first_m + (right - left) / self.px_per_m, step):
            x, _ = self._on_grid(i * step, 0.0)
            self.surface.line([(x, top), (x, bottom)], GRID_STRONG if i == 0 else GRID)
            self.surface.text((x, bottom + 7), f"{i * step:g}", FAINT, 13, "ma")
        first_m = self._extent.max_y_m - (bottom - self._off_y) / self.px_per_m
        for i in _multiples(first_m, first_m + (bottom - top) / self.px_per_m, step):
            _, y = self._on_grid(0.0, i * step)
            self.surface.line([(left, y), (right, y)], GRID_STRONG if i == 0 else GRID)
            self.surface.text((left - 9, y), f"{i * step:g}", FAINT, 13, "rm")

    def name_obstacles(self, world: World) -> None:
        """Write the names of what they fit into; a wall's does not."""
        for name, outline in world.outline():
            points = self.points(outline)
            xs, ys = zip(*points)
            centre = ((min(xs) + max(xs)) / 2.0, (min(ys) + max(ys)) / 2.0)
            box = self.surface.text_box(centre, name, 13, "mm")
            fits = box[2] - box[0] < max(xs) - min(xs) - 4 and box[3] - box[1] < max(ys) - min(ys) - 4
            if fits and self._is_free(box):
                self.surface.text(centre, name, FAINT, 13, "mm", is_minor=True)
                self.taken.append(box)

    def places(self, world: World) -> None:
        """Draw every named place and how it looks there."""
        spots = {name: self.at(pose.x_m, pose.y_m) for name, pose in world.places.items()}
        self.taken += [(x - 6, y - 6, x + 6, y + 6) for x, y in spots.values()]
        for name, pose in world.places.items():
            x, y = spots[name]
            heading_rad = self._orientation.heading_rad(pose.yaw_rad)
            look = (x + 11 * math.cos(heading_rad), y - 11 * math.sin(heading_rad))
            self.surface.line([(x, y), look], PLACE, 2.0)
            self.surface.circle((x, y), 5, fill=PLACE, edge=WHITE, width_px=1.2)
            self._label(name, (x, y), looks_right=math.cos(heading_rad) > 0.5)

    def _label(self, name: str, spot: XY, looks_right: bool) -> None:
        x, y = spot
        right = x + (17 if looks_right else 10)
        spots = (((right, y), "lm"), ((x - 17, y), "rm"), ((x, y - 10), "mb"), ((x, y + 10), "mt"))
        boxes = [(at, anchor, self.surface.text_box(at, name, 15, anchor)) for at, anchor in spots]
        inside = [b for b in boxes if b[2][0] > self.box[0] and b[2][2] < self.box[2]]
        free = [b for b in inside if self._is_free(b[2])]
        for at, anchor, box in (free or inside)[:1]:
            self.surface.text(at, name, PLACE, 15, anchor, halo=(*WHITE, 215))
            self.taken.append(box)

    def _is_free(self, box: Box) -> bool:
        return not any(
            box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]
            for other in self.taken
        )

    def robot(self, point: tuple[float, float, float], footprint: Sequence[XY], colour: Rgb) -> None:
        """Draw the robot's outline and where it looks."""
        outline = self.points(outline_at(footprint, Pose(*point)))
        self.surface.polygon(outline, fill=(*colour, 40), edge=colour, width_px=1.8)
        x, y = self.at(*point[:2])
        heading_rad = self._orientation.heading_rad(point[2])
        cos, sin = math.cos(heading_rad), -math.sin(heading_rad)
        size = max(11.0, max(math.hypot(*corner) for corner in footprint) * self.px_per_m * 0.62)
        corners = ((1.0, 0.0), (-0.62, 0.62), (-0.3, 0.0), (-0.62, -0.62))
        placed = [(x + size * (cos * a - sin * b), y + size * (sin * a + cos * b)) for a, b in corners]
        self.surface.polygon(placed, fill=colour, edge=WHITE, width_px=1.2)

    def mark(self, at: XY, number: str, colour: Rgb) -> None:
        """Draw a numbered disc."""
        self.taken.append((at[0] - 11, at[1] - 11, at[0] + 11, at[1] + 11))
        self.surface.circle(at, 10, fill=colour, edge=WHITE, width_px=1.5)
        self.surface.text(at, number, WHITE, 13, "mm")

    def name_below(self, point: tuple[float, float], name: str, reach_m: float, colour: Rgb) -> None:
        """Write a name below what reaches so far around a point."""
        x, y = self.at(*point)
        below = (x, y + reach_m * self.px_per_m + 6)
        self.surface.text(below, name, colour, 14, "mt", halo=(*WHITE, 215))
        self.taken.append(self.surface.text_box(below, name, 14, "mt"))


def _multiples(low_m: float, high_m: float, step_m: float) -> range:
    return range(math.ceil(low_m / step_m), math.floor(high_m / step_m) + 1)
