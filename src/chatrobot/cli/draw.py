"""A rehearsed plan as a picture: the world, the predicted way coloured by progress, what rehearsal found."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

from chatrobot.cli.drawing.canvas import Canvas, font_for
from chatrobot.cli.drawing.extent import Orientation, extent_of_world
from chatrobot.cli.drawing.ground import (
    AMBER,
    END,
    FAINT,
    INK,
    LEFT_PX,
    LINE_PX,
    PLACE,
    RED,
    START,
    SWEPT,
    SWEPT_EDGE,
    TITLE_SIZE_PX,
    TOP_PX,
    WHITE,
    Ground,
)  # fmt: skip
from chatrobot.cli.drawing.svg_canvas import SvgCanvas
from chatrobot.cli.drawing.ways import outline_at, progress_colour, standing_points, where_found
from chatrobot.core.events import FindingSeen, Rehearsed
from chatrobot.core.geometry import Pose
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.world import World

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


class _Picture(Ground):
    """The picture of one plan."""

    def draw(
        self, world: World, profile: RobotProfile, rehearsed: Rehearsed, title: str, words: Words
    ) -> Canvas | SvgCanvas:
        """Draw all of it, the ground first."""
        self.draw_ground(world)
        self._way(profile, rehearsed)
        self.draw_names(world)
        self._findings(rehearsed)
        self._headline(world, profile, rehearsed, title)
        self._legend(rehearsed, words, bool(world.places))
        return self.canvas

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
            self.draw_footprint(profile, Pose(*point), colour)
            if name:
                x, y = self._at(*point[:2])
                below = profile.footprint_radius_m * self._px_per_m + 6
                self.canvas.text((x, y + below), name, colour, 14, "mt", halo=(*WHITE, 215))
                self._taken.append(self.canvas.text_box((x, y + below), name, 14, "mt"))

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
