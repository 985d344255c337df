"""A rehearsed plan as a picture: the world, the predicted way coloured by progress, what rehearsal found."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path

from chatrobot.cli.drawing.canvas import XY, Box, Canvas, font_for
from chatrobot.cli.drawing.extent import Extent, Orientation, extent_of_world
from chatrobot.cli.drawing.ways import outline_at, progress_colour, standing_points, where_found
from chatrobot.core.events import FindingSeen, Rehearsed
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
WAY_CLEARANCE_PX = 9

Words = Callable[[FindingSeen], str]


def draw_plan(
    path: Path, *, world: World, profile: RobotProfile, rehearsed: Rehearsed, title: str, words: Words
) -> None:
    """Write the picture of `rehearsed` in `world` to `path`, a PNG.

    Args:
        words: puts a finding into words for the legend.

    Raises:
        OSError: the file cannot be written.
    """
    way = [point[:2] for point in rehearsed.path]
    margin_m = 0.25 + (profile.footprint_radius_m if way else 0.0)
    extent = extent_of_world(world, way, margin_m=margin_m, least_m=3.0)
    picture = _Picture(extent, Orientation(world), len(rehearsed.findings))
    picture.draw(world, profile, rehearsed, title, words).save(path)


class _Picture:
    """One picture on its way: an extent of the world on a canvas, and the labels that already stand there."""

    def __init__(self, extent: Extent, orientation: Orientation, finding_count: int) -> None:
        self._extent = extent
        self._orientation = orientation
        self._px_per_m = min(MAP_WIDTH_PX / extent.width_m, MAX_MAP_HEIGHT_PX / extent.height_m)
        self._map_w = max(760, round(extent.width_m * self._px_per_m))
        self._map_h = max(MIN_MAP_HEIGHT_PX, round(extent.height_m * self._px_per_m))
        self._off_x = LEFT_PX + (self._map_w - extent.width_m * self._px_per_m) / 2.0
        self._off_y = TOP_PX + (self._map_h - extent.height_m * self._px_per_m) / 2.0
        height = TOP_PX + self._map_h + FOOT_PX + LINE_PX * finding_count
        self.canvas = Canvas(LEFT_PX + self._map_w + RIGHT_PX, height, PAPER)
        self._taken: list[Box] = []

    def draw(
        self, world: World, profile: RobotProfile, rehearsed: Rehearsed, title: str, words: Words
    ) -> Canvas:
        """Draw all of it, the ground first."""
        self._grid()
        self._obstacles(world)
        self._way(profile, rehearsed)
        self._places(world)
        self._obstacle_names(world)
        self._findings(rehearsed)
        self._headline(world, profile, rehearsed, title)
        self._legend(rehearsed, words, bool(world.places))
        return self.canvas

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

    # --- the way ---

    def _way(self, profile: RobotProfile, rehearsed: Rehearsed) -> None:
        way = rehearsed.path
        if not way:
            return
        radius_m = profile.footprint_radius_m
        for point in standing_points(way, radius_m / 4.0, math.radians(6)):
            self.canvas.polygon(self._points(outline_at(profile.footprint, Pose(*point))), fill=SWEPT)
        for point in standing_points(way, max(radius_m * 2.0, rehearsed.length_m / 40.0), math.radians(45)):
            outline = self._points(outline_at(profile.footprint, Pose(*point)))
            self.canvas.polygon(outline, edge=SWEPT_EDGE, width_px=0.8)
        for point in standing_points(way, WAY_CLEARANCE_PX / self._px_per_m, math.tau):
            x, y = self._at(*point[:2])
            clear = WAY_CLEARANCE_PX
            self._taken.append((x - clear, y - clear, x + clear, y + clear))
        for i, (a, b) in enumerate(pairwise(way)):
            ends = [self._at(*a[:2]), self._at(*b[:2])]
            self.canvas.line(ends, progress_colour(i / max(1, len(way) - 2)), 4.5)
        is_loop = math.dist(way[0][:2], way[-1][:2]) <= profile.footprint_radius_m
        names = ("", "start and end") if is_loop else ("start", "end")
        for point, colour, name in ((way[0], START, names[0]), (way[-1], END, names[1])):
            outline = self._points(outline_at(profile.footprint, Pose(*point)))
            self.canvas.polygon(outline, fill=(*colour, 40), edge=colour, width_px=1.8)
            self._arrow(point, colour, profile.footprint_radius_m * self._px_per_m)
            if name:
                x, y = self._at(*point[:2])
                below = profile.footprint_radius_m * self._px_per_m + 6
                self.canvas.text((x, y + below), name, colour, 14, "mt", halo=(*WHITE, 215))
                self._taken.append(self.canvas.text_box((x, y + below), name, 14, "mt"))

    def _arrow(
        self, point: tuple[float, float, float], colour: tuple[int, int, int], reach_px: float
    ) -> None:
        x, y = self._at(*point[:2])
        heading_rad = self._orientation.heading_rad(point[2])
        cos, sin = math.cos(heading_rad), -math.sin(heading_rad)
        size = max(11.0, reach_px * 0.62)
        corners = ((1.0, 0.0), (-0.62, 0.62), (-0.3, 0.0), (-0.62, -0.62))
        placed = [(x + size * (cos * a - sin * b), y + size * (sin * a + cos * b)) for a, b in corners]
        self.canvas.polygon(placed, fill=colour, edge=WHITE, width_px=1.2)

    def _findings(self, rehearsed: Rehearsed) -> None:
        for number, finding in enumerate(rehearsed.findings, 1):
            spot = where_found(rehearsed, finding)
            if spot is not None:
                at, colour = self._at(*spot), _severity_colour(finding)
                self.canvas.circle(at, 15, edge=(*colour, 130), width_px=2.5)
                self.canvas.circle(at, 10, fill=colour, edge=WHITE, width_px=1.5)
                self.canvas.text(at, str(number), WHITE, 13, "mm")

    # --- words around the map ---

    def _headline(self, world: World, profile: RobotProfile, rehearsed: Rehearsed, title: str) -> None:
        self.canvas.text((LEFT_PX, 14), self._fitting(title), INK, TITLE_SIZE_PX)
        turned = rehearsed.path[-1][2] - rehearsed.path[0][2] if rehearsed.path else 0.0
        length, duration = f"{rehearsed.length_m:.2f} m", f"{rehearsed.duration_s:.1f} s"
        facts = f"{length} · {duration} · turns {math.degrees(turned):+.0f}°"
        verdict = "" if rehearsed.ok else " · refused"
        where = "in the open" if world.is_empty else f"in '{world.name}'"
        self.canvas.text((LEFT_PX, 50), facts + verdict, INK if rehearsed.ok else RED, 17)
        self.canvas.text((LEFT_PX + self._map_w, 54), f"{profile.title} {where}", FAINT, 13, "ra")

    def _fitting(self, title: str) -> str:
        """Cut the title where the picture ends; "plan" where no font has its letters."""
        shown = " ".join(title.split())
        if not shown or font_for(shown, TITLE_SIZE_PX) is None:
            return "plan"
        while self.canvas.text_box((0.0, 0.0), shown, TITLE_SIZE_PX)[2] > self._map_w:
            shown = f"{shown[:-2].rstrip()}…"
        return shown

    def _legend(self, rehearsed: Rehearsed, words: Words, has_places: bool) -> None:
        y = TOP_PX + self._map_h + 58
        x = float(LEFT_PX)
        for i in range(120):
            self.canvas.box((x + i, y - 3, x + i + 1.4, y + 3), fill=progress_colour(i / 119))
        along = f"0 to {rehearsed.duration_s:.1f} s along the predicted way"
        self.canvas.text((x + 130, y), along, INK, 14, "lm")
        x = self.canvas.text_box((x + 130, y), along, 14, "lm")[2]
        self.canvas.box((x + 30, y - 7, x + 48, y + 7), fill=SWEPT, edge=SWEPT_EDGE)
        self.canvas.text((x + 56, y), "swept by the footprint", INK, 14, "lm")
        if has_places:
            self.canvas.circle((x + 238, y), 5, fill=PLACE)
            self.canvas.text((x + 250, y), "named place", INK, 14, "lm")
        for number, finding in enumerate(rehearsed.findings, 1):
            y += LINE_PX
            self.canvas.circle((LEFT_PX + 9, y), 9, fill=_severity_colour(finding))
            self.canvas.text((LEFT_PX + 9, y), str(number), WHITE, 12, "mm")
            self.canvas.text((LEFT_PX + 26, y), words(finding), INK, 14, "lm")


def _severity_colour(finding: FindingSeen) -> tuple[int, int, int]:
    return {"refuse": RED, "warn": AMBER}.get(finding.severity, FAINT)
