"""The same canvas as `canvas.Canvas`, written as SVG: sharp at any size, and its words can be searched."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

from chatrobot.cli.drawing.canvas import DASH_PX, XY, Box, Colour, font_for

_ALIGNED = {"l": "start", "m": "middle", "r": "end"}
_UP_SHARE = {"a": 0.95, "t": 0.75, "m": 0.35, "s": 0.0, "b": -0.2}
"""How far below the point the letters stand, of their size, by the second letter of pillow's anchor."""
_FONTS = "DejaVu Sans, Noto Sans, Noto Sans CJK SC, Microsoft YaHei, PingFang SC, sans-serif"


class SvgCanvas:
    """Coordinates are pixels, y downwards. Colours may have an alpha."""

    def __init__(self, width_px: int, height_px: int, background: Colour) -> None:
        self.width_px, self.height_px = width_px, height_px
        self._parts = [f'<rect width="100%" height="100%" {_paint("fill", background)}/>']

    def line(self, points: Sequence[XY], colour: Colour, width_px: float = 1.0) -> None:
        """Draw a polyline with round joints and ends."""
        how = f'fill="none" {_paint("stroke", colour)} stroke-width="{width_px:g}"'
        self._parts.append(
            f'<polyline points="{_points(points)}" {how} stroke-linecap="round" stroke-linejoin="round"/>'
        )

    def dashed(self, a: XY, b: XY, colour: Colour, width_px: float = 1.0) -> None:
        """Draw a dashed line."""
        how = f'fill="none" {_paint("stroke", colour)} stroke-width="{width_px:g}" stroke-dasharray="{DASH_PX:g}"'
        self._parts.append(f'<polyline points="{_points((a, b))}" {how}/>')

    def polygon(self, points: Sequence[XY], *, fill: Colour | None = None, edge: Colour | None = None,
                width_px: float = 1.0) -> None:  # fmt: skip
        """Draw a polygon."""
        self._parts.append(f'<polygon points="{_points(points)}" {_look(fill, edge, width_px)}/>')

    def circle(self, centre: XY, radius_px: float, *, fill: Colour | None = None, edge: Colour | None = None,
               width_px: float = 1.0) -> None:  # fmt: skip
        """Draw a circle."""
        x, y = centre
        self._parts.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius_px:g}" {_look(fill, edge, width_px)}/>'
        )

    def box(self, box: Box, *, fill: Colour | None = None, edge: Colour | None = None) -> None:
        """Draw a rectangle."""
        x0, y0, x1, y1 = box
        size = f'x="{x0:.1f}" y="{y0:.1f}" width="{x1 - x0:.1f}" height="{y1 - y0:.1f}"'
        self._parts.append(f"<rect {size} {_look(fill, edge, 1.0)}/>")

    def text(
        self,
        at: XY,
        text: str,
        colour: Colour,
        size_px: float,
        anchor: str = "la",
        halo: Colour | None = None,
    ) -> None:
        """Write `text`. `anchor` as pillow has it."""
        y = at[1] + _UP_SHARE[anchor[1]] * size_px
        look = f'font-size="{size_px:g}" text-anchor="{_ALIGNED[anchor[0]]}" {_paint("fill", colour)}'
        if halo is not None:
            look += f' {_paint("stroke", halo)} stroke-width="5" paint-order="stroke"'
        self._parts.append(f'<text x="{at[0]:.1f}" y="{y:.1f}" {look}>{escape(text)}</text>')

    def text_box(self, at: XY, text: str, size_px: float, anchor: str = "la") -> Box:
        """Return the box in which `text` would stand, about: whoever shows it has fonts of their own."""
        font = font_for(text, round(size_px))
        width = font.getlength(text) if font is not None else size_px * len(text)
        x = at[0] - {"l": 0.0, "m": 0.5, "r": 1.0}[anchor[0]] * width
        y = at[1] + _UP_SHARE[anchor[1]] * size_px
        return (x, y - 0.75 * size_px, x + width, y + 0.2 * size_px)

    def save(self, path: Path) -> None:
        """Write the SVG.

        Raises:
            OSError: the file cannot be written.
        """
        size = f'width="{self.width_px}" height="{self.height_px}" viewBox="0 0 {self.width_px} {self.height_px}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="{_FONTS}">'
        path.write_text("\n".join((head, *self._parts, "</svg>", "")), encoding="utf-8")


def _points(points: Sequence[XY]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)


def _look(fill: Colour | None, edge: Colour | None, width_px: float) -> str:
    stroke = f'{_paint("stroke", edge)} stroke-width="{width_px:g}"' if edge is not None else ""
    return f"{_paint('fill', fill)} {stroke}" if fill is not None else f'fill="none" {stroke}'


def _paint(what: str, colour: Colour) -> str:
    red, green, blue, *alpha = colour
    opacity = f' {what}-opacity="{alpha[0] / 255:.2f}"' if alpha else ""
    return f'{what}="#{red:02x}{green:02x}{blue:02x}"{opacity}'
