"""A surface that becomes SVG: shapes stretch with the figure, letters and marks stay as large on a phone.

Its light colours stand at every shape. `dark_style` is the style that exchanges them where a person prefers dark.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

from chatrobot.cli.drawing.surface import XY, Box, Colour, Surface

FONT = (
    "system-ui, -apple-system, 'Segoe UI', Roboto, 'Noto Sans', 'PingFang SC', 'Microsoft YaHei', sans-serif"
)
DARK = {
    "fcfcfa": "0f141a", "ffffff": "182029", "262b33": "e7edf4", "707884": "9aa8b7", "eaecf0": "222d38",
    "d6dae2": "33414f", "dee2e9": "2a3643", "969eac": "56687b", "0f766e": "4fc3b5", "1f77d6": "6aa9ff",
    "e24c26": "ff8a5c", "cd1828": "ff7b78", "c97a00": "f0b04a", "137a54": "54cf9f", "8a3fb8": "cf95f2",
    "a8b4cc": "4c5d73",
}  # fmt: skip
"""The colour in the dark of each that figures use."""
HALO_PX = 4.0
WIDEST = 1.14
"""How much wider than pillow's font that of a browser may be (DejaVu Sans)."""
_ANCHORS = {"l": "start", "m": "middle", "r": "end"}
_SHIFTS_EM = {"a": 0.95, "t": 0.85, "m": 0.35, "s": 0.0, "b": -0.2}


def dark_style() -> str:
    """Return the rules that exchange the colours of every figure in the dark."""
    rules = (f".f{light}{{fill:#{dark}}}.s{light}{{stroke:#{dark}}}" for light, dark in DARK.items())
    return "@media (prefers-color-scheme: dark){" + "".join(rules) + "}"


SHAPES_STYLE = (
    ".figure .shapes *{vector-effect:non-scaling-stroke;stroke-linejoin:round;stroke-linecap:round}"
    f".figure text{{font-family:{FONT}}}"
)
"""The rules that a figure always needs."""


class SvgCanvas(Surface):
    """A surface of SVG."""

    def __init__(self, width_px: int, height_px: int, background: Colour | None = None) -> None:
        super().__init__(width_px, height_px)
        self._shapes: list[str] = []
        self._marks: list[str] = []
        if background is not None:
            self.box((0.0, 0.0, width_px, height_px), fill=background)

    def line(self, points: Sequence[XY], colour: Colour, width_px: float = 1.0) -> None:
        self._shapes.append(f'<path d="{_path(points)}"{_painted(None, colour, width_px)}/>')

    def dashed(self, points: Sequence[XY], colour: Colour, width_px: float = 1.0) -> None:
        paint = f'{_painted(None, colour, width_px)} stroke-dasharray="6 6"'
        self._shapes.append(f'<path d="{_path(points)}"{paint}/>')

    def polygon(self, points: Sequence[XY], *, fill: Colour | None = None, edge: Colour | None = None,
                width_px: float = 1.0) -> None:  # fmt: skip
        self._shapes.append(f'<path d="{_path(points)}z"{_painted(fill, edge, width_px)}/>')

    def circle(self, centre: XY, radius_px: float, *, fill: Colour | None = None, edge: Colour | None = None,
               width_px: float = 1.0) -> None:  # fmt: skip
        x, y = self._share(centre)
        self._marks.append(f'<circle cx="{x}" cy="{y}" r="{radius_px:g}"{_painted(fill, edge, width_px)}/>')

    def box(self, box: Box, *, fill: Colour | None = None, edge: Colour | None = None) -> None:
        left, top, right, bottom = box
        place = f'x="{left:.1f}" y="{top:.1f}" width="{right - left:.1f}" height="{bottom - top:.1f}"'
        self._shapes.append(f"<rect {place}{_painted(fill, edge, 1.0)}/>")

    def text(self, at: XY, text: str, colour: Colour, size_px: float, anchor: str = "la",
             halo: Colour | None = None, *, is_minor: bool = False) -> None:  # fmt: skip
        x, y = self._share(at)
        shift = f' dy="{_SHIFTS_EM[anchor[1]] * size_px:.1f}"' if _SHIFTS_EM[anchor[1]] else ""
        side = f' text-anchor="{_ANCHORS[anchor[0]]}"' if anchor[0] != "l" else ""
        order, more = ' paint-order="stroke"' if halo else "", "minor" if is_minor else ""
        how = f'{shift}{side} font-size="{size_px:g}"{order}{_painted(colour, halo, HALO_PX, more)}'
        self._marks.append(f'<text x="{x}" y="{y}"{how}>{escape(printable(text))}</text>')

    def text_box(self, at: XY, text: str, size_px: float, anchor: str = "la") -> Box:
        """Return the box in which `text` would stand, in the widest of the fonts that may be there."""
        x0, y0, x1, y1 = super().text_box((0.0, 0.0), text, size_px, anchor)
        return (at[0] + x0 * WIDEST, at[1] + y0, at[0] + x1 * WIDEST, at[1] + y1)

    def save(self, path: Path, name: str = "") -> None:
        """Write a file of its own."""
        path.write_text(self.markup(name, alone=True), encoding="utf-8")

    def markup(self, name: str, *, alone: bool = False, css_class: str = "figure") -> str:
        """Return the SVG.

        Args:
            name: what the figure shows, for those who cannot see it; "" hides from them what says nothing.
            alone: it is a file of its own, with its style.
        """
        width, height = self.width_px, self.height_px
        space = f' xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}"' if alone else ""
        style = f"<style>{SHAPES_STYLE}{dark_style()}</style>" if alone else ""
        label = f'role="img" aria-label={quoteattr(printable(name))}' if name else 'aria-hidden="true"'
        inner = f'<svg class="shapes" width="100%" height="100%" viewBox="0 0 {width} {height}"'
        return (
            f'<svg class="{css_class}"{space} {label}>{style}\n'
            f'{inner} preserveAspectRatio="none">{"".join(self._shapes)}</svg>\n{"".join(self._marks)}</svg>\n'
        )

    def _share(self, at: XY) -> tuple[str, str]:
        """Return a place as shares of the figure, which holds at any width."""
        return f"{100.0 * at[0] / self.width_px:.2f}%", f"{100.0 * at[1] / self.height_px:.2f}%"


def _path(points: Sequence[XY]) -> str:
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)


def _painted(fill: Colour | None, edge: Colour | None, width_px: float, more: str = "") -> str:
    """Return colours as attributes, and the classes that the style for the dark knows them by."""
    known = [f"{kind}{_hex(colour)}" for kind, colour in (("f", fill), ("s", edge)) if colour]
    classes = " ".join([*known, more]).strip()
    edged = f'{_colour("stroke", edge)} stroke-width="{width_px:g}"' if edge else ""
    return f'{_colour("fill", fill)}{edged} class="{classes}"'


def _colour(kind: str, colour: Colour | None) -> str:
    if colour is None:
        return f' {kind}="none"'
    opacity = f' {kind}-opacity="{colour[3] / 255:.2f}"' if len(colour) == 4 else ""
    return f' {kind}="#{_hex(colour)}"{opacity}'


def _hex(colour: Colour) -> str:
    return "{:02x}{:02x}{:02x}".format(*colour[:3])


_NOT_XML = re.compile("[^\t\n\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def printable(text: str) -> str:
    """Leave out the characters that neither XML nor a page may hold."""
    return _NOT_XML.sub("", text)
