"""The drive as one figure, in SVG or PNG: headline, map, legend and speeds."""

from __future__ import annotations

from pathlib import Path

from chatrobot.cli.drawing.canvas import Canvas
from chatrobot.cli.drawing.ground import FAINT, INK, PAPER, Rgb
from chatrobot.cli.drawing.surface import Surface
from chatrobot.cli.drawing.svg import SvgCanvas
from chatrobot.cli.report.drive import Drive
from chatrobot.cli.report.map_figure import LEGEND, MARK_COLOURS, TOLD_PX, DriveMap, map_size
from chatrobot.cli.report.speed_chart import COMMANDED, draw_speeds
from chatrobot.cli.report.summary import Say, headline, sentences

WIDTH_PX, MOST_MAP_HEIGHT_PX = 1000, 640
LEFT_PX, RIGHT_PX, TOP_PX, LEGEND_PX, SPEEDS_PX = 50, 24, 124, 74, 250


def write_figure(drive: Drive, say: Say, path: Path, kind: type[SvgCanvas] | type[Canvas]) -> None:
    """Write the figure. As SVG it follows the colour scheme of whoever looks.

    Raises:
        OSError: the file cannot be written.
    """
    surface = kind(WIDTH_PX, TOP_PX + _map_px(drive)[1] + LEGEND_PX + SPEEDS_PX, PAPER)
    _draw(drive, surface, say)
    surface.save(path, say("map_name", marks=len(drive.marks)))


def _map_px(drive: Drive) -> tuple[int, int]:
    return map_size(drive, WIDTH_PX - LEFT_PX - RIGHT_PX, MOST_MAP_HEIGHT_PX)


def _draw(drive: Drive, surface: Surface, say: Say) -> None:
    width, height = _map_px(drive)
    surface.text((LEFT_PX, 14), surface.fitting(headline(drive, say), width, 22), INK, 22)
    told = sentences(drive, say)
    for row, texts in enumerate((told[:2], told[2:3], told[3:])):
        surface.text((LEFT_PX, 48 + 21 * row), surface.fitting(" ".join(texts), width, 14), FAINT, 14)
    bottom = TOP_PX + height
    DriveMap(drive, surface, (LEFT_PX, TOP_PX, LEFT_PX + width, bottom)).draw()
    _legend(drive, surface, say, bottom + 48)
    draw_speeds(
        drive,
        surface,
        (LEFT_PX, bottom + LEGEND_PX, LEFT_PX + width, bottom + LEGEND_PX + SPEEDS_PX - 4),
        say,
    )


def _legend(drive: Drive, surface: Surface, say: Say, y_px: float) -> None:
    ways = {"told": drive.told, "measured": drive.measured, "true": drive.true}
    x_px = float(LEFT_PX)
    lines = [(name, colour) for name, colour in LEGEND if ways[name]]
    for name, colour in [*lines, *([("commanded", COMMANDED)] if drive.recording.commands else [])]:
        surface.line([(x_px, y_px), (x_px + 26, y_px)], colour, TOLD_PX if name == "told" else 3.0)
        x_px = _named(surface, x_px + 33, y_px, say(f"legend_{name}"))
    for kind in dict.fromkeys(mark.kind for mark in drive.marks):
        surface.circle((x_px + 7, y_px), 7, fill=MARK_COLOURS[kind])
        x_px = _named(surface, x_px + 20, y_px, say(f"mark_{kind}"))


def _named(surface: Surface, x_px: float, y_px: float, name: str, colour: Rgb = INK) -> float:
    """Write a name, and return where the next entry begins."""
    surface.text((x_px, y_px), name, colour, 14, "lm")
    return surface.text_box((x_px, y_px), name, 14, "lm")[2] + 16
