"""A world as a picture: grid, obstacles, names and places, on which other pictures draw what they show."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from chatrobot.cli.drawing.canvas import XY, Box, Canvas
from chatrobot.cli.drawing.extent import Extent, Orientation, extent_of_world
from chatrobot.cli.drawing.svg_canvas import SvgCanvas
from chatrobot.cli.drawing.ways import outline_at
from chatrobot.core.geometry import Pose
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.world import World

PAPER, WHITE, INK, FAINT = (252, 252, 250), (255, 255, 255), (38, 43, 51), (112, 120, 132)
GRID, GRID_STRONG = (234, 236, 240), (214, 218, 226)
SWEPT, SWEPT_EDGE = (232, 237, 247), (168, 180, 204)
OBSTACLE, OBSTACLE_EDGE = (222, 226, 233), (150, 158, 172)
PLACE, START, END, RED, AMBER = (15, 118, 110), (31, 119, 214), (226, 76, 38), (205, 24, 40), (201, 122, 0)

MAP_WIDTH_PX, MAX_MAP_HEIGHT_PX, MIN_MAP_HEIGHT_PX = 1080, 860, 420
LEFT_PX, RIGHT_PX, TOP_PX, FOOT_PX, LINE_PX, TITLE_SIZE_PX = 62, 28, 108, 96, 24, 26


def draw_world(path: Path, *, world: World, profile: RobotProfile) -> None:
    """Write the picture of a world, with the robot at its start, to `path`: an SVG where it ends so, else a PNG.

    Raises:
        OSError: the file cannot be written.
    """
    extent = extent_of_world(world, (), margin_m=0.25, least_m=3.0)
    canvas = SvgCanvas if path.suffix.casefold() == ".svg" else Canvas
    picture = Ground(extent, Orientation(world), 0, canvas)
    picture.draw_ground(world)
    picture.draw_footprint(profile, Pose(), START)
    picture.draw_names(world)
    picture.canvas.text((LEFT_PX, 14), world.name, INK, TITLE_SIZE_PX)
    picture.canvas.save(path)


class Ground:
    """A picture on its way: an extent of the world on a canvas, and the labels that already stand there.

    Args:
        foot_line_count: lines of words below the legend.
    """

    def __init__(
        self,
        extent: Extent,
        orientation: Orientation,
        foot_line_count: int,
        canvas: type[Canvas] | type[SvgCanvas] = Canvas,
    ) -> None:
        self._extent = extent
        self._orientation = orientation
        self._px_per_m = min(MAP_WIDTH_PX / extent.width_m, MAX_MAP_HEIGHT_PX / extent.height_m)
        self._map_w = max(760, round(extent.width_m * self._px_per_m))
        self._map_h = max(MIN_MAP_HEIGHT_PX, round(extent.height_m * self._px_per_m))
        self._off_x = LEFT_PX + (self._map_w - extent.width_m * self._px_per_m) / 2.0
        self._off_y = TOP_PX + (self._map_h - extent.height_m * self._px_per_m) / 2.0
        height = TOP_PX + self._map_h + FOOT_PX + LINE_PX * foot_line_count
        self.canvas: Canvas | SvgCanvas = canvas(LEFT_PX + self._map_w + RIGHT_PX, height, PAPER)
        self._taken: list[Box] = []

    def draw_ground(self, world: World) -> None:
        """Draw the grid and what stands there."""
        self._grid()
        self._obstacles(world)

    def draw_names(self, world: World) -> None:
        """Draw the places, and the names of all where there is room."""
        self._places(world)
        self._obstacle_names(world)

    def draw_footprint(self, profile: RobotProfile, pose: Pose, colour: tuple[int, int, int]) -> None:
        """Draw the robot where it is, with an arrow that says which way it looks."""
        outline = self._points(outline_at(profile.footprint, pose))
        self.canvas.polygon(outline, fill=(*colour, 40), edge=colour, width_px=1.8)
        self._arrow(pose, colour, profile.footprint_radius_m * self._px_per_m)

    def _arrow(self, point: Pose, colour: tuple[int, int, int], reach_px: float) -> None:
        x, y = self._at(*point[:2])
        heading_rad = self._orientation.heading_rad(point[2])
        cos, sin = math.cos(heading_rad), -math.sin(heading_rad)
        size = max(11.0, reach_px * 0.62)
        corners = ((1.0, 0.0), (-0.62, 0.62), (-0.3, 0.0), (-0.62, -0.62))
        placed = [(x + size * (cos * a - sin * b), y + size * (sin * a + cos * b)) for a, b in corners]
        self.canvas.polygon(placed, fill=colour, edge=WHITE, width_px=1.2)

    def _at(self, x_m: float, y_m: float) -> XY:
        """Place a point in the frame of the start."""
        return self._on_grid(*self._orientation.point(x_m, y_m))

    def _on_grid(self, right_m: float, up_m: float) -> XY:
        """Place a point so far from the start along the axes of the picture."""
        return (
            self._off_x + (right_m - self._extent.min_x_m) * self._px_per_m,
            self._off_y + (self._extent.max_y_m - up_m) * self._px_per_m,
        )

    def _points(self, points: Sequence[tuple[float, float]]) -> list[XY]:
        return [self._at(*point) for point in points]

    # --- the ground ---

    def _grid(self) -> None:
        left, top, right, bottom = LEFT_PX, TOP_PX, LEFT_PX + self._map_w, TOP_PX + self._map_h
        self.canvas.box((left, top, right, bottom), fill=WHITE)
        wide_enough = (
            step for step in (0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500) if step * self._px_per_m >= 55
        )
        step = next(wide_enough, 1000.0)
        first_m = self._extent.min_x_m + (left - self._off_x) / self._px_per_m
        for i in range(
            math.ceil(first_m / step), math.floor((first_m + self._map_w / self._px_per_m) / step) + 1
        ):
            x, _ = self._on_grid(i * step, 0.0)
            self.canvas.line([(x, top), (x, bottom)], GRID_STRONG if i == 0 else GRID)
            self.canvas.text((x, bottom + 7), f"{i * step:g}", FAINT, 13, "ma")
        first_m = self._extent.max_y_m - (bottom - self._off_y) / self._px_per_m
        for i in range(
            math.ceil(first_m / step), math.floor((first_m + self._map_h / self._px_per_m) / step) + 1
        ):
            _, y = self._on_grid(0.0, i * step)
            self.canvas.line([(left, y), (right, y)], GRID_STRONG if i == 0 else GRID)
            self.canvas.text((left - 9, y), f"{i * step:g}", FAINT, 13, "rm")
        whose = "from the start along the world's " if self._orientation.is_turned else ""
        self.canvas.text((right, bottom + 26), f"{whose}x, metres", FAINT, 12, "ra")
        self.canvas.text((left, top - 8), f"{whose}y, metres", FAINT, 12, "ls")

    def _obstacles(self, world: World) -> None:
        if world.allowed_area is not None:
            corners = self._points(world.allowed_area.points)
            for a, b in zip(corners, corners[1:] + corners[:1]):
                self.canvas.dashed(a, b, AMBER, 1.2)
        for _, outline in world.outline():
            self.canvas.polygon(self._points(outline), fill=OBSTACLE, edge=OBSTACLE_EDGE, width_px=1.2)

    def _obstacle_names(self, world: World) -> None:
        """Names of what they fit into; a wall's does not."""
        for name, outline in world.outline():
            points = self._points(outline)
            xs, ys = zip(*points)
            centre = ((min(xs) + max(xs)) / 2.0, (min(ys) + max(ys)) / 2.0)
            box = self.canvas.text_box(centre, name, 13, "mm")
            fits = box[2] - box[0] < max(xs) - min(xs) - 4 and box[3] - box[1] < max(ys) - min(ys) - 4
            if fits and self._is_free(box):
                self.canvas.text(centre, name, FAINT, 13, "mm")
                self._taken.append(box)

    def _places(self, world: World) -> None:
        spots = {name: self._at(pose.x_m, pose.y_m) for name, pose in world.places.items()}
        self._taken += [(x - 6, y - 6, x + 6, y + 6) for x, y in spots.values()]
        for name, pose in world.places.items():
            x, y = spots[name]
            heading_rad = self._orientation.heading_rad(pose.yaw_rad)
            look = (x + 11 * math.cos(heading_rad), y - 11 * math.sin(heading_rad))
            self.canvas.line([(x, y), look], PLACE, 2.0)
            self.canvas.circle((x, y), 5, fill=PLACE, edge=WHITE, width_px=1.2)
            self._label(name, (x, y), looks_right=math.cos(heading_rad) > 0.5)

    def _label(self, name: str, spot: XY, looks_right: bool) -> None:
        x, y = spot
        right = x + (17 if looks_right else 10)
        spots = (((right, y), "lm"), ((x - 17, y), "rm"), ((x, y - 10), "mb"), ((x, y + 10), "mt"))
        boxes = [(at, anchor, self.canvas.text_box(at, name, 15, anchor)) for at, anchor in spots]
        inside = [b for b in boxes if b[2][0] > LEFT_PX and b[2][2] < LEFT_PX + self._map_w]
        free = [b for b in inside if self._is_free(b[2])]
        for at, anchor, box in (free or inside)[:1]:
            self.canvas.text(at, name, PLACE, 15, anchor, halo=(*WHITE, 215))
            self._taken.append(box)

    def _is_free(self, box: Box) -> bool:
        return not any(
            box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]
            for other in self._taken
        )
