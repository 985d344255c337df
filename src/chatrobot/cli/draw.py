"""Pictures of a world, and of a rehearsed plan in it: the predicted way coloured by progress, what rehearsal found."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

from chatrobot.cli.drawing.canvas import Canvas
from chatrobot.cli.drawing.extent import Extent, Orientation, extent_of_world
from chatrobot.cli.drawing.fonts import font_for
from chatrobot.cli.drawing.ground import AMBER, END, FAINT, INK, PAPER, PLACE, RED, START, WHITE, Ground
from chatrobot.cli.drawing.surface import Surface
from chatrobot.cli.drawing.svg import SvgCanvas
from chatrobot.cli.drawing.ways import outline_at, progress_colour, standing_points, where_found
from chatrobot.core.events import FindingSeen, Rehearsed
from chatrobot.core.geometry import Pose
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.world import World

SWEPT, SWEPT_EDGE = (232, 237, 247), (168, 180, 204)

MAP_WIDTH_PX, MAX_MAP_HEIGHT_PX, MIN_MAP_HEIGHT_PX = 1080, 860, 420
LEFT_PX, RIGHT_PX, TOP_PX, FOOT_PX, LINE_PX, TITLE_SIZE_PX = 62, 28, 108, 96, 24, 26
WAY_CLEARANCE_PX = 9

Words = Callable[[FindingSeen], str]


def draw_world(path: Path, *, world: World, profile: RobotProfile) -> None:
    """Write the picture of a world, with the robot at its start, to `path`: an SVG where it ends so, else a PNG.

    Raises:
        OSError: the file cannot be written.
    """
    extent = extent_of_world(world, (), margin_m=0.25, least_m=3.0)
    kind = SvgCanvas if path.suffix.casefold() == ".svg" else Canvas
    sheet = _Sheet(extent, Orientation(world), 0, kind)
    sheet.draw_ground(world)
    sheet.ground.robot((0.0, 0.0, 0.0), profile.footprint, START)
    sheet.draw_names(world)
    sheet.canvas.text((LEFT_PX, 14), world.name, INK, TITLE_SIZE_PX)
    sheet.canvas.save(path, world.name)


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


class _Sheet:
    """A surface with a ground on it, and room for words above and below.

    Args:
        foot_line_count: lines of words below the legend.
    """

    def __init__(
        self,
        extent: Extent,
        orientation: Orientation,
        foot_line_count: int,
        kind: type[Canvas] | type[SvgCanvas] = Canvas,
    ) -> None:
        px_per_m = min(MAP_WIDTH_PX / extent.width_m, MAX_MAP_HEIGHT_PX / extent.height_m)
        self._is_turned = orientation.is_turned
        self._map_w = max(760, round(extent.width_m * px_per_m))
        self._map_h = max(MIN_MAP_HEIGHT_PX, round(extent.height_m * px_per_m))
        height = TOP_PX + self._map_h + FOOT_PX + LINE_PX * foot_line_count
        self.canvas: Surface = kind(LEFT_PX + self._map_w + RIGHT_PX, height, PAPER)
        box = (LEFT_PX, TOP_PX, LEFT_PX + self._map_w, TOP_PX + self._map_h)
        self.ground = Ground(self.canvas, extent, orientation, box)

    def draw_ground(self, world: World) -> None:
        """Draw the grid and what stands there, and say what the axes are."""
        self.ground.draw(world)
        left, top, right, bottom = self.ground.box
        whose = "from the start along the world's " if self._is_turned else ""
        self.canvas.text((right, bottom + 26), f"{whose}x, metres", FAINT, 12, "ra")
        self.canvas.text((left, top - 8), f"{whose}y, metres", FAINT, 12, "ls")

    def draw_names(self, world: World) -> None:
        """Draw the places, and the names of all where there is room."""
        self.ground.places(world)
        self.ground.name_obstacles(world)


class _Picture(_Sheet):
    """The picture of one plan."""

    def draw(
        self, world: World, profile: RobotProfile, rehearsed: Rehearsed, title: str, words: Words
    ) -> Surface:
        """Draw all of it, the ground first."""
        self.draw_ground(world)
        self._way(profile, rehearsed)
        self.draw_names(world)
        self._findings(rehearsed)
        self._headline(world, profile, rehearsed, title)
        self._legend(rehearsed, words, bool(world.places))
        return self.canvas

    def _way(self, profile: RobotProfile, rehearsed: Rehearsed) -> None:
        way, ground = rehearsed.path, self.ground
        if not way:
            return
        radius_m = profile.footprint_radius_m
        for point in standing_points(way, radius_m / 4.0, math.radians(6)):
            self.canvas.polygon(ground.points(outline_at(profile.footprint, Pose(*point))), fill=SWEPT)
        for point in standing_points(way, max(radius_m * 2.0, rehearsed.length_m / 40.0), math.radians(45)):
            outline = ground.points(outline_at(profile.footprint, Pose(*point)))
            self.canvas.polygon(outline, edge=SWEPT_EDGE, width_px=0.8)
        for point in standing_points(way, WAY_CLEARANCE_PX / ground.px_per_m, math.tau):
            x, y = ground.at(*point[:2])
            clear = WAY_CLEARANCE_PX
            ground.taken.append((x - clear, y - clear, x + clear, y + clear))
        for i, (a, b) in enumerate(pairwise(way)):
            self.canvas.line(ground.points((a[:2], b[:2])), progress_colour(i / max(1, len(way) - 2)), 4.5)
        is_loop = math.dist(way[0][:2], way[-1][:2]) <= radius_m
        names = ("", "start and end") if is_loop else ("start", "end")
        for point, colour, name in ((way[0], START, names[0]), (way[-1], END, names[1])):
            ground.robot(point, profile.footprint, colour)
            if name:
                ground.name_below(point[:2], name, radius_m, colour)

    def _findings(self, rehearsed: Rehearsed) -> None:
        for number, finding in enumerate(rehearsed.findings, 1):
            spot = where_found(rehearsed, finding)
            if spot is not None:
                at, colour = self.ground.at(*spot), _severity_colour(finding)
                self.canvas.circle(at, 15, edge=(*colour, 130), width_px=2.5)
                self.ground.mark(at, str(number), colour)

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
        if not title.strip() or font_for(title, TITLE_SIZE_PX) is None:
            return "plan"
        return self.canvas.fitting(title, self._map_w, TITLE_SIZE_PX)

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
