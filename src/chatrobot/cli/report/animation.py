"""The drive as an animation: the robot on the map with its trail behind it, and what was said below."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

from PIL import Image

from chatrobot.cli.drawing.canvas import Canvas
from chatrobot.cli.drawing.ground import (
    AMBER,
    FAINT,
    GRID,
    GRID_STRONG,
    INK,
    OBSTACLE,
    OBSTACLE_EDGE,
    PAPER,
    PLACE,
    RED,
    START,
    WHITE,
)
from chatrobot.cli.report.drive import JUMP_M, Drive, Point
from chatrobot.cli.report.map_figure import MEASURED, MEASURED_PX, TOLD, TOLD_PX, DriveMap, map_size
from chatrobot.cli.report.speed_chart import clock

WIDTH_PX, MOST_MAP_HEIGHT_PX = 560, 420
LEFT_PX, EDGE_PX, CAPTION_PX, FOOT_PX = 34, 8, 30, 26
FRAME_S, MOST_S, HOLD_S = 0.1, 14.0, 2.5
REST_S = 0.8
"""Where the robot stands for longer, the rest of it is left out."""
MOVED_M, MOVED_RAD = 0.002, 0.01
SHADES = 4
TRAIL_PX = 2.0
_MS_PER_S = 1000


def write_gif(drive: Drive, path: Path) -> None:
    """Write the animation as GIF, at most `MOST_S` long: a longer drive is shown quicker.

    Raises:
        OSError: the file cannot be written.
    """
    film, palette = _Film(drive), _palette()
    shown = [film.frame(t_s).quantize(palette=palette, dither=Image.Dither.NONE) for t_s in moments_of(drive)]
    durations = [round(FRAME_S * _MS_PER_S)] * (len(shown) - 1) + [round(HOLD_S * _MS_PER_S)]
    shown[0].save(
        path,
        "GIF",
        save_all=True,
        append_images=shown[1:],
        duration=durations,
        loop=0,
        optimize=True,
        disposal=1,
    )


def _palette() -> Image.Image:
    """Make one palette for all frames: what is drawn with, and each colour's way to white, for soft edges."""
    colours = (INK, FAINT, OBSTACLE_EDGE, START, RED, AMBER, PLACE, MEASURED, TOLD)
    shades = [
        tuple(round(255 + (part - 255) * share / SHADES) for part in colour)
        for colour in colours
        for share in range(1, SHADES + 1)
    ]
    flat = [part for colour in (WHITE, PAPER, GRID, GRID_STRONG, OBSTACLE, *shades) for part in colour]
    image = Image.new("P", (1, 1))
    image.putpalette(flat)
    return image


def moments_of(drive: Drive) -> list[float]:
    """Return the times of the frames: evenly over the drive, without what the robot stood in between."""
    samples = drive.telemetry
    kept: list[float] = []
    last_t_s, last, rest_s = 0.0, drive.at(0.0) or (0.0, 0.0, 0.0), 0.0
    for t_s, sample in samples:
        point = (sample.x_m, sample.y_m, sample.yaw_rad)
        has_moved = math.dist(point[:2], last[:2]) > MOVED_M or abs(point[2] - last[2]) > MOVED_RAD
        rest_s = 0.0 if has_moved else rest_s + t_s - last_t_s
        if has_moved:
            last = point
        if rest_s <= REST_S:
            kept.append(t_s)
        last_t_s = t_s
    if not kept:
        return [drive.recording.duration_s]
    count = min(len(kept), math.ceil(_duration_s(kept) / FRAME_S))
    return [kept[round(i * (len(kept) - 1) / max(1, count - 1))] for i in range(count)]


def _duration_s(kept: list[float]) -> float:
    """How long the animation takes: as long as the drive, but for what is too long."""
    gaps = (b - a for a, b in pairwise(kept))
    driven_s = sum(gap for gap in gaps if gap <= REST_S)
    return max(FRAME_S, min(MOST_S, driven_s))


class _Film:
    """Draws the drive as it was at one moment after the other."""

    def __init__(self, drive: Drive) -> None:
        self._drive = drive
        width, height = map_size(drive, WIDTH_PX - LEFT_PX - EDGE_PX, MOST_MAP_HEIGHT_PX)
        self._ground = Canvas(WIDTH_PX, EDGE_PX + height + FOOT_PX + CAPTION_PX, PAPER)
        self._caption_y = EDGE_PX + height + FOOT_PX + CAPTION_PX / 2.0 - 2.0
        box = (LEFT_PX, EDGE_PX, LEFT_PX + width, EDGE_PX + height)
        self._map = DriveMap(drive, self._ground, box)
        self._map.ground.draw(drive.world)
        self._trail = _trail(drive, TRAIL_PX / self._map.ground.px_per_m)
        self._told = [(t_s, event.turn, [*event.path]) for t_s, event in drive.rehearsals]
        self._ends_s = {result.turn: t_s for t_s, result in drive.results}

    def frame(self, t_s: float) -> Image.Image:
        """Draw it as it was then."""
        drive, canvas = self._drive, self._ground.copy()
        shown = self._map.on(canvas)
        for began_s, turn, way in self._told:
            if began_s <= t_s <= self._ends_s.get(turn, math.inf):
                shown.way(way, TOLD, TOLD_PX)
        now = drive.at(t_s)
        for trail in self._trail:
            past = [point for at_s, point in trail if at_s <= t_s]
            is_last = bool(past) and now is not None and len(past) < len(trail)
            shown.way([*past, now] if is_last and now is not None else past, MEASURED, MEASURED_PX)
        shown.ground.places(drive.world)
        shown.ground.name_obstacles(drive.world)
        shown.draw_marks(t_s)
        if now is not None:
            shown.ground.robot(now, drive.footprint_m, START)
        self._write(canvas, t_s)
        return canvas.picture()

    def _write(self, canvas: Canvas, t_s: float) -> None:
        """Write the last words and the time."""
        words = [text for heard_s, _, text in self._drive.heard if heard_s <= t_s]
        canvas.text((WIDTH_PX - EDGE_PX, self._caption_y), clock(t_s), FAINT, 14, "rm")
        if words:
            text = canvas.fitting(f"“{words[-1]}”", WIDTH_PX - LEFT_PX - 60, 15)
            canvas.text((LEFT_PX, self._caption_y), text, INK, 15, "lm")


def _trail(drive: Drive, spacing_m: float) -> list[list[tuple[float, Point]]]:
    """Return the measured ways with their times, without the points that nobody would see."""
    ways: list[list[tuple[float, Point]]] = []
    for t_s, sample in drive.telemetry:
        point = (sample.x_m, sample.y_m, sample.yaw_rad)
        distance_m = math.dist(point[:2], ways[-1][-1][1][:2]) if ways else math.inf
        if distance_m > JUMP_M:
            ways.append([(t_s, point)])
        elif distance_m >= spacing_m:
            ways[-1].append((t_s, point))
    return ways
