"""A pillow image drawn three times too large and made smaller at the end, and the fonts on it."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

SCALE = 3
DASH_PX = 6.0
XY = tuple[float, float]
Colour = tuple[int, int, int] | tuple[int, int, int, int]
Box = tuple[float, float, float, float]


class Canvas:
    """Coordinates are pixels of the finished picture, y downwards. Colours may have an alpha."""

    def __init__(self, width_px: int, height_px: int, background: Colour) -> None:
        self.width_px, self.height_px = width_px, height_px
        self._image = Image.new("RGB", (width_px * SCALE, height_px * SCALE), background)
        self._draw = ImageDraw.Draw(self._image, "RGBA")

    def line(self, points: Sequence[XY], colour: Colour, width_px: float = 1.0) -> None:
        """Draw a polyline with round joints and ends."""
        width = max(1, round(width_px * SCALE))
        self._draw.line(_scaled(points), fill=colour, width=width, joint="curve")
        if width > SCALE:
            for x, y in (points[0], points[-1]):
                self.circle((x, y), width_px / 2.0, fill=colour)

    def dashed(self, a: XY, b: XY, colour: Colour, width_px: float = 1.0) -> None:
        """Draw a dashed line."""
        length = max(1e-9, ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5)
        at = 0.0
        while at < length:
            ends = (at / length, min(1.0, (at + DASH_PX) / length))
            self.line([(a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t) for t in ends], colour, width_px)
            at += 2.0 * DASH_PX

    def polygon(self, points: Sequence[XY], *, fill: Colour | None = None, edge: Colour | None = None,
                width_px: float = 1.0) -> None:  # fmt: skip
        """Draw a polygon."""
        if fill is not None:
            self._draw.polygon(_scaled(points), fill=fill)
        if edge is not None:
            self.line([*points, points[0], points[1]], edge, width_px)

    def circle(self, centre: XY, radius_px: float, *, fill: Colour | None = None, edge: Colour | None = None,
               width_px: float = 1.0) -> None:  # fmt: skip
        """Draw a circle."""
        x, y, r = centre[0] * SCALE, centre[1] * SCALE, radius_px * SCALE
        self._draw.ellipse(
            (x - r, y - r, x + r, y + r), fill=fill, outline=edge, width=max(1, round(width_px * SCALE))
        )

    def box(self, box: Box, *, fill: Colour | None = None, edge: Colour | None = None) -> None:
        """Draw a rectangle."""
        self._draw.rectangle([v * SCALE for v in box], fill=fill, outline=edge, width=SCALE)

    def text(
        self,
        at: XY,
        text: str,
        colour: Colour,
        size_px: float,
        anchor: str = "la",
        halo: Colour | None = None,
    ) -> None:
        """Write `text`; nothing at all where no font has its letters. `anchor` as pillow has it."""
        font = font_for(text, round(size_px * SCALE))
        if font is not None:
            self._draw.text(
                (at[0] * SCALE, at[1] * SCALE), text, fill=colour, font=font, anchor=anchor,
                stroke_width=round(2.5 * SCALE) if halo else 0, stroke_fill=halo,
            )  # fmt: skip

    def text_box(self, at: XY, text: str, size_px: float, anchor: str = "la") -> Box:
        """Return the box in which `text` would stand."""
        font = font_for(text, round(size_px * SCALE))
        if font is None:
            return (*at, *at)
        x0, y0, x1, y1 = self._draw.textbbox((at[0] * SCALE, at[1] * SCALE), text, font=font, anchor=anchor)
        return (x0 / SCALE, y0 / SCALE, x1 / SCALE, y1 / SCALE)

    def save(self, path: Path) -> None:
        """Write the PNG.

        Raises:
            OSError: the file cannot be written.
        """
        small = self._image.resize((self.width_px, self.height_px), Image.Resampling.LANCZOS)
        small.save(path, "PNG", optimize=True)


def _scaled(points: Sequence[XY]) -> list[XY]:
    return [(x * SCALE, y * SCALE) for x, y in points]


Font = ImageFont.FreeTypeFont | ImageFont.ImageFont

_HAN_FILES = (
    "NotoSansCJK*", "NotoSansSC*", "SourceHanSans*", "wqy-microhei*", "wqy-zenhei*", "DroidSansFallback*",
    "PingFang*", "Hiragino*GB*", "STHeiti*", "msyh*", "simhei*", "uming*", "ukai*",
)  # fmt: skip
_MONO_FILES = (
    "DejaVuSansMono.ttf",
    "LiberationMono-Regular*",
    "UbuntuMono*",
    "NotoSansMono-Regular*",
    "Menlo*",
)


def latin(size_px: int) -> Font:
    """Return the font for everything but Chinese."""
    return ImageFont.load_default(size_px)


def han(size_px: int) -> Font | None:
    """Return a font that has Chinese, None on a system without one."""
    path = _find(_HAN_FILES)
    return ImageFont.truetype(str(path), size_px) if path is not None else None


def mono(size_px: int) -> Font | None:
    """Return a font whose letters are all as wide as each other, and which has braille; None where there is none."""
    path = _find(_MONO_FILES)
    return ImageFont.truetype(str(path), size_px) if path is not None else None


def is_latin(text: str) -> bool:
    """Tell whether `latin` has every character of `text`."""
    return all(ord(char) < 0x250 or char in "–—‘’“”…°·×" for char in text)


def font_for(text: str, size_px: int) -> Font | None:
    """Return a font that can show `text`, None where there is none."""
    return latin(size_px) if is_latin(text) else han(size_px)


@cache
def _find(patterns: tuple[str, ...]) -> Path | None:
    for pattern in patterns:
        for folder in _folders():
            found = next((path for path in sorted(folder.rglob(pattern)) if path.is_file()), None)
            if found is not None:
                return found
    return None


def _folders() -> Iterator[Path]:
    data = Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local/share")
    folders = (
        *(data / "fonts", Path.home() / ".fonts", Path("/usr/share/fonts"), Path("/usr/local/share/fonts")),
        *(Path("/System/Library/Fonts"), Path("/Library/Fonts"), Path("C:/Windows/Fonts")),
    )
    return (folder for folder in folders if folder.is_dir())
