"""A pyte screen as a PNG: what a terminal window would show, with its colours."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pyte
from PIL import Image, ImageDraw
from pyte.screens import Char

from chatrobot.cli.drawing import fonts

SCALE = 2
FONT_PX, CELL_W, CELL_H = 15, 9.03, 19
PAD, TITLE_H = 18, 34
PAPER, BAR, INK = (24, 27, 33), (38, 42, 50), (214, 219, 227)
NAMED = {
    "black": (60, 66, 78), "red": (240, 93, 94), "green": (120, 200, 110), "brown": (229, 192, 86),
    "blue": (92, 164, 240), "magenta": (198, 130, 230), "cyan": (86, 196, 205), "white": INK,
    "brightblack": (128, 137, 152), "default": INK,
}  # fmt: skip
FAINT = "8a93a3"
FAINT_SGR = re.compile(rb"\x1b\[2(;[0-9;]*)?m")
_GREY = b"\x1b[38;2;138;147;163m"
_MONO_FILES = (
    "DejaVuSansMono.ttf",
    "LiberationMono-Regular*",
    "UbuntuMono*",
    "NotoSansMono-Regular*",
    "Menlo*",
)
_DOT_BITS = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3))


def grey(sgr: re.Match[bytes]) -> bytes:
    """What stands for faint text, with the rest of what it was."""
    return _GREY + (b"\x1b[" + sgr.group(1)[1:] + b"m" if sgr.group(1) else b"")


def replay(raw: bytes, columns: int, rows: int) -> pyte.Screen:
    """The screen after `raw`. pyte knows no faint text: it becomes grey here."""
    screen = pyte.Screen(columns, rows)
    pyte.ByteStream(screen).feed(FAINT_SGR.sub(grey, raw))
    return screen


def draw_screen(screen: pyte.Screen, title: str, path: Path) -> None:
    """Draw the screen in a window with that title."""
    width, height = screen.columns * CELL_W + 2 * PAD, screen.lines * CELL_H + 2 * PAD + TITLE_H
    image = Image.new("RGBA", (round(width * SCALE), round(height * SCALE)), (0, 0, 0, 0))
    draw = ImageDraw.Draw(image)
    draw.rounded_rectangle((0, 0, image.width - 1, image.height - 1), radius=10 * SCALE, fill=PAPER)
    draw.rounded_rectangle((0, 0, image.width - 1, TITLE_H * SCALE), radius=10 * SCALE, fill=BAR)
    draw.rectangle((0, TITLE_H * SCALE / 2, image.width, TITLE_H * SCALE), fill=BAR)
    for number, colour in enumerate(((237, 106, 94), (245, 191, 79), (98, 197, 84))):
        x, y, r = (20 + number * 20) * SCALE, TITLE_H * SCALE / 2, 6 * SCALE
        draw.ellipse((x - r, y - r, x + r, y + r), fill=colour)
    font = fonts.latin(13 * SCALE)
    draw.text((image.width / 2, TITLE_H * SCALE / 2), title, fill=(160, 168, 180), font=font, anchor="mm")
    for y in range(screen.lines):
        for x in range(screen.columns):
            _cell(draw, PAD + x * CELL_W, TITLE_H + PAD + y * CELL_H, screen.buffer[y][x])
    image.save(path, "PNG", optimize=True)


def _cell(draw: ImageDraw.ImageDraw, x: float, y: float, char: Char) -> None:
    ink, paper = colour(char.fg, INK), colour(char.bg, PAPER)
    if char.reverse:
        ink, paper = paper, ink
    if paper != PAPER:
        draw.rectangle([v * SCALE for v in (x, y, x + CELL_W, y + CELL_H)], fill=paper)
    for letter in char.data.strip():
        if "\u2800" <= letter <= "\u28ff":
            _braille(draw, x, y, letter, ink)
        elif "█" <= letter <= "▏":
            share = (0x2590 - ord(letter)) / 8
            draw.rectangle([v * SCALE for v in (x, y + 4, x + CELL_W * share, y + CELL_H - 4)], fill=ink)
        else:
            _letter(draw, x, y, letter, ink, char.bold)


@cache
def _mono() -> fonts.Font | None:
    """A font whose letters are all as wide as each other, and which has braille."""
    return fonts.installed(_MONO_FILES, FONT_PX * SCALE)


def _letter(
    draw: ImageDraw.ImageDraw, x: float, y: float, letter: str, ink: tuple[int, int, int], bold: bool
) -> None:
    is_wide = ord(letter) >= 0x2E80
    font = fonts.han(FONT_PX * SCALE) if is_wide else _mono()
    if font is None:
        raise SystemExit(
            "no font for this: install DejaVu Sans Mono, and a Chinese one such as WenQuanYi Micro Hei"
        )
    baseline = ((x + (1 if is_wide else 0)) * SCALE, (y + CELL_H * 0.76) * SCALE)
    stroke = {"stroke_width": 0.35 * SCALE, "stroke_fill": ink} if bold else {}
    draw.text(baseline, letter, fill=ink, font=font, anchor="ls", **stroke)


def braille_dots(letter: str) -> list[tuple[int, int]]:
    """Column and row of each dot of a Braille letter."""
    return [at for bit, at in enumerate(_DOT_BITS) if (ord(letter) - 0x2800) & (1 << bit)]


def _braille(draw: ImageDraw.ImageDraw, x: float, y: float, letter: str, ink: tuple[int, int, int]) -> None:
    for column, row in braille_dots(letter):
        cx, cy, r = x + CELL_W * (0.25 + 0.5 * column), y + CELL_H * (0.125 + 0.25 * row), 1.65
        draw.ellipse([v * SCALE for v in (cx - r, cy - r, cx + r, cy + r)], fill=ink)


def colour(name: str, default: tuple[int, int, int]) -> tuple[int, int, int]:
    """A colour of pyte, as red, green and blue."""
    if name == "default":
        return default
    if name in NAMED:
        return NAMED[name]
    if name.startswith("bright") and name[6:] in NAMED:
        return NAMED[name[6:]]
    try:
        return int(name[0:2], 16), int(name[2:4], 16), int(name[4:6], 16)
    except ValueError:
        return default
