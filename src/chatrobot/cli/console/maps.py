"""Maps as something rich can print."""

from __future__ import annotations

from rich.text import Text

from chatrobot.cli.console.motion_view import MotionView
from chatrobot.cli.drawing.extent import Extent, Orientation, extent_around, extent_of_world
from chatrobot.cli.drawing.map_text import MapLines, draw_map_text
from chatrobot.sim.world import World

COLOURS = {
    "wall": "bright_black", "path": "blue", "trail": "dark_orange", "place": "cyan", "robot": "bold red", "": "",
}  # fmt: skip
BIG_COLUMNS, BIG_ROWS = 100, 30
WAY_COLUMNS, WAY_ROWS = 60, 14


def big_map(motion_view: MotionView, world: World, width: int) -> Text:
    """The whole world with its names, the last plan's way and what was driven of it."""
    extent = extent_of_world(world, (*motion_view.path, *motion_view.trail), margin_m=0.1, least_m=3.0)
    return _draw(motion_view, world, extent, min(width - 4, BIG_COLUMNS), BIG_ROWS)


def way_map(motion_view: MotionView, world: World) -> Text:
    """The predicted way of the last plan and what stands around it."""
    extent = extent_around(Orientation(world).points(motion_view.path), margin_m=0.8, least_m=3.0)
    return _draw(motion_view, world, extent, WAY_COLUMNS, WAY_ROWS)


def _draw(motion_view: MotionView, world: World, extent: Extent, columns: int, rows: int) -> Text:
    columns, rows = _shape(extent, columns, rows)
    lines = draw_map_text(
        world,
        extent,
        columns=columns,
        rows=rows,
        path=motion_view.path,
        trail=motion_view.trail,
        pose=motion_view.pose,
        names=True,
    )
    return _text(lines)


def _shape(extent: Extent, columns: int, rows: int) -> tuple[int, int]:
    """As many cells as the extent fills; a braille dot is as wide as it is high, a cell has two by four."""
    dots_per_m = min(columns * 2 / extent.width_m, rows * 4 / extent.height_m)
    return max(4, round(extent.width_m * dots_per_m / 2)), max(2, round(extent.height_m * dots_per_m / 4))


def _text(lines: MapLines) -> Text:
    text = Text(no_wrap=True)
    for number, line in enumerate(lines):
        text.append("\n  " if number else "  ")
        for layer, run in line:
            text.append(run, COLOURS[layer])
    return text
