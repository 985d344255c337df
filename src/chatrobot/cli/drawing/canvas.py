"""A pillow image drawn three times too large and made smaller at the end."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

from PIL import Image, ImageDraw

from chatrobot.cli.drawing.fonts import font_for
from chatrobot.cli.drawing.surface import DASH_PX, MEASURE_SCALE, XY, Box, Colour, Surface

SCALE = MEASURE_SCALE


class Canvas(Surface):
    """A surface of pixels."""

    def __init__(self, width_px: int, height_px: int, background: Colour) -> None:
        super().__init__(width_px, height_px)
        self._image = Image.new("RGB", (width_px * SCALE, height_px * SCALE), background)
        self._draw = ImageDraw.Draw(self._image, "RGBA")

    def line(self, points: Sequence[XY], colour: Colour, width_px: float = 1.0) -> None:
        width = max(1, round(width_px * SCALE))
        self._draw.line(_scaled(points), fill=colour, width=width, joint="curve")
        if width > SCALE:
            for x, y in (points[0], points[-1]):
                self.circle((x, y), width_px / 2.0, fill=colour)

    def dashed(self, points: Sequence[XY], colour: Colour, width_px: float = 1.0) -> None:
        for dash in _dashes(points):
            self.line(dash, colour, width_px)

    def polygon(self, points: Sequence[XY], *, fill: Colour | None = None, edge: Colour | None = None,
                width_px: float = 1.0) -> None:  # fmt: skip
        if fill is not None:
            self._draw.polygon(_scaled(points), fill=fill)
        if edge is not None:
            self.line([*points, points[0], points[1]], edge, width_px)

    def circle(self, centre: XY, radius_px: float, *, fill: Colour | None = None, edge: Colour | None = None,
               width_px: float = 1.0) -> None:  # fmt: skip
        x, y, r = centre[0] * SCALE, centre[1] * SCALE, radius_px * SCALE
        self._draw.ellipse(
            (x - r, y - r, x + r, y + r), fill=fill, outline=edge, width=max(1, round(width_px * SCALE))
        )

    def box(self, box: Box, *, fill: Colour | None = None, edge: Colour | None = None) -> None:
        self._draw.rectangle([v * SCALE for v in box], fill=fill, outline=edge, width=SCALE)

    def text(self, at: XY, text: str, colour: Colour, size_px: float, anchor: str = "la",
             halo: Colour | None = None, *, is_minor: bool = False) -> None:  # fmt: skip  # noqa: ARG002
        """Write `text`; nothing at all where no font has its letters. `anchor` as pillow has it."""
        font = font_for(text, round(size_px * SCALE))
        if font is not None:
            self._draw.text(
                (at[0] * SCALE, at[1] * SCALE), text, fill=colour, font=font, anchor=anchor,
                stroke_width=round(2.5 * SCALE) if halo else 0, stroke_fill=halo,
            )  # fmt: skip

    def copy(self) -> Canvas:
        """Return another canvas with the same picture, which is drawn on alone."""
        other = Canvas.__new__(Canvas)
        Surface.__init__(other, self.width_px, self.height_px)
        other._image = self._image.copy()
        other._draw = ImageDraw.Draw(other._image, "RGBA")
        return other

    def picture(self) -> Image.Image:
        """Return the finished picture, made smaller the quick way, for one of many."""
        return self._image.reduce(SCALE)

    def save(self, path: Path, name: str = "") -> None:  # noqa: ARG002
        """Write a PNG."""
        small = self._image.resize((self.width_px, self.height_px), Image.Resampling.LANCZOS)
        small.save(path, "PNG", optimize=True)


def _scaled(points: Sequence[XY]) -> list[XY]:
    return [(x * SCALE, y * SCALE) for x, y in points]


def _dashes(points: Sequence[XY]) -> Iterator[list[XY]]:
    """Cut a polyline into dashes, which go on around its corners."""
    dash, done_px, is_drawn = [points[0]], 0.0, True
    for a, b in pairwise(points):
        length, at = math.dist(a, b), 0.0
        while length - at > 0.0:
            step = min(DASH_PX - done_px, length - at)
            at, done_px = at + step, done_px + step
            dash.append((a[0] + (b[0] - a[0]) * at / length, a[1] + (b[1] - a[1]) * at / length))
            if done_px >= DASH_PX - 1e-9:
                if is_drawn:
                    yield dash
                dash, done_px, is_drawn = [dash[-1]], 0.0, not is_drawn
    if is_drawn and len(dash) > 1:
        yield dash
