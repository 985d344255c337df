"""What a figure is drawn on, whether it becomes pixels (`canvas`) or SVG (`svg`)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from chatrobot.cli.drawing.fonts import font_for

MEASURE_SCALE = 3
"""Letters are measured three times as large, as pixels draw them."""
DASH_PX = 6.0
XY = tuple[float, float]
Colour = tuple[int, int, int] | tuple[int, int, int, int]
Box = tuple[float, float, float, float]


class Surface(ABC):
    """Coordinates are pixels of the finished picture, y downwards. Colours may have an alpha."""

    def __init__(self, width_px: int, height_px: int) -> None:
        self.width_px, self.height_px = width_px, height_px

    @abstractmethod
    def line(self, points: Sequence[XY], colour: Colour, width_px: float = 1.0) -> None:
        """Draw a polyline with round joints and ends."""

    @abstractmethod
    def dashed(self, points: Sequence[XY], colour: Colour, width_px: float = 1.0) -> None:
        """Draw a dashed polyline."""

    @abstractmethod
    def polygon(self, points: Sequence[XY], *, fill: Colour | None = None, edge: Colour | None = None,
                width_px: float = 1.0) -> None:  # fmt: skip
        """Draw a polygon."""

    @abstractmethod
    def circle(self, centre: XY, radius_px: float, *, fill: Colour | None = None, edge: Colour | None = None,
               width_px: float = 1.0) -> None:  # fmt: skip
        """Draw a circle."""

    @abstractmethod
    def box(self, box: Box, *, fill: Colour | None = None, edge: Colour | None = None) -> None:
        """Draw a rectangle."""

    @abstractmethod
    def text(self, at: XY, text: str, colour: Colour, size_px: float, anchor: str = "la",
             halo: Colour | None = None, *, is_minor: bool = False) -> None:  # fmt: skip
        """Write `text`. `anchor` as pillow has it; what is minor is left out where there is little room."""

    @abstractmethod
    def save(self, path: Path, name: str = "") -> None:
        """Write the picture; `name` says what it shows, where its form has room for that.

        Raises:
            OSError: the file cannot be written.
        """

    def text_box(self, at: XY, text: str, size_px: float, anchor: str = "la") -> Box:
        """Return the box in which `text` would stand; without a size where no font has its letters."""
        x0, y0, x1, y1 = _box(text, round(size_px * MEASURE_SCALE), anchor)
        return (at[0] + x0, at[1] + y0, at[0] + x1, at[1] + y1)

    def fitting(self, text: str, width_px: float, size_px: float) -> str:
        """Return `text` on one line, cut where it would be wider."""
        shown = " ".join(text.split())
        while len(shown) > 1 and self.text_box((0.0, 0.0), shown, size_px)[2] > width_px:
            shown = f"{shown[:-2].rstrip()}…"
        return shown


@lru_cache(maxsize=1024)
def _box(text: str, size_px: int, anchor: str) -> Box:
    """Measure a text once: an animation asks for the same ones at every frame."""
    font = font_for(text, size_px)
    if font is None:
        return (0.0, 0.0, 0.0, 0.0)
    x0, y0, x1, y1 = (value / MEASURE_SCALE for value in font.getbbox(text, anchor=anchor))
    return (x0, y0, x1, y1)
