"""Records a real run of the console and draws it as an animated SVG, docs/images/run.svg (`make pictures` does, too).

SMIL alone moves it, so that it plays inside an <img>. Where nothing plays SMIL, the last frame is shown.

python -m scripts.moving_picture
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import escape

import pyte
from pyte.screens import Char
from scripts.terminal_picture import FAINT_SGR, INK, PAPER, braille_dots, colour, grey
from tests.console.terminal import Terminal

FILE = Path(__file__).resolve().parents[1] / "docs" / "images" / "run.svg"
COLUMNS, ROWS = 92, 23
SAID = ("forward 1 m, then turn left 90 degrees", "go to the kitchen")
FRAME_S, KEY_S, HOLD_S = 0.2, 0.045, 3.0
CELL_W, CELL_H, FONT_PX, PAD, TITLE_H = 8.4, 17, 14, 14, 28
FULL, EIGHTHS = "█", "▏"


class Run(NamedTuple):
    """Cells of a row that look alike, from column `x` on."""

    x: int
    cells: int
    text: str
    ink: tuple[int, int, int]
    paper: tuple[int, int, int]
    bold: bool


Row = tuple[Run, ...]


class Recorded(Terminal):
    """A terminal that knows when what came."""

    def __init__(self, *arguments: Any, **how: Any) -> None:
        super().__init__(*arguments, **how)
        self.heard: list[tuple[float, int]] = []

    def look(self, timeout_s: float = 0.0) -> bool:
        before = len(self.raw)
        alive = super().look(timeout_s)
        if len(self.raw) > before:
            self.heard.append((time.monotonic(), len(self.raw)))
        return alive

    def person_types(self, text: str) -> None:
        """A letter after the other, as a person does."""
        for letter in text:
            self.type(letter)
            self.rest(KEY_S)
        self.type("\r")

    def rest(self, duration_s: float) -> None:
        """Go on looking for so long."""
        until_s = time.monotonic() + duration_s
        while (left_s := until_s - time.monotonic()) > 0.0:
            self.look(left_s)


def record() -> list[list[Row]]:
    """The frames of a run: a drive, a way through the flat, and a stop in the middle of it."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "chatrobot", "--config-dir", folder]
        with Recorded(command, columns=COLUMNS, rows=ROWS) as terminal:
            terminal.wait_for("Ctrl-D")
            began_s = time.monotonic()
            terminal.rest(0.8)
            terminal.person_types(SAID[0])
            terminal.wait_for("✓", timeout_s=60.0)
            terminal.rest(1.2)
            terminal.person_types(SAID[1])
            terminal.wait_for(r" 3\d %", timeout_s=60.0)
            terminal.person_types("stop")
            terminal.wait_for("Stopped", timeout_s=60.0)
            terminal.rest(1.5)
            return list(_frames(terminal, began_s))


def _frames(terminal: Recorded, began_s: float) -> Iterator[list[Row]]:
    screen = pyte.Screen(COLUMNS, ROWS)
    stream = pyte.ByteStream(screen)
    fed, frame_s = 0, began_s
    for heard_s, length in [*terminal.heard, (float("inf"), len(terminal.raw))]:
        while frame_s < min(heard_s, terminal.heard[-1][0] + FRAME_S):
            if heard_s > began_s:
                yield [_row(screen.buffer[y]) for y in range(ROWS)]
            frame_s += FRAME_S
        stream.feed(FAINT_SGR.sub(grey, terminal.raw[fed:length]))
        fed = length


def _row(cells: Any) -> Row:
    found, x = [], 0
    for look, group in groupby((cells[x] for x in range(COLUMNS)), key=_look):
        letters = [char.data for char in group]  # behind a wide letter comes an empty one
        found.append(Run(x, len(letters), "".join(letters), *look[:3]))
        x += len(letters)
    return tuple(run for run in found if run.text.strip() or run.paper != PAPER)


def _look(char: Char) -> tuple[tuple[int, int, int], tuple[int, int, int], bool, str]:
    """What makes cells be drawn as one: colours, weight, and whether they are letters, dots or bars."""
    ink, paper = colour(char.fg, INK), colour(char.bg, PAPER)
    if char.reverse:
        ink, paper = paper, ink
    is_dots, is_bar = "\u2800" <= char.data <= "\u28ff", FULL <= char.data <= EIGHTHS
    return ink, paper, bool(char.bold), "dots" if is_dots else "bar" if is_bar else "text"


def draw(frames: list[list[Row]]) -> str:
    """The animated SVG: every row as often as it differs, each shown in its frames."""
    width, height = COLUMNS * CELL_W + 2 * PAD, ROWS * CELL_H + 2 * PAD + TITLE_H
    whole_s = len(frames) * FRAME_S + HOLD_S
    shown: dict[tuple[int, Row], list[int]] = {}
    for number, frame in enumerate(frames):
        for y, row in enumerate(frame):
            if row:
                shown.setdefault((y, row), []).append(number)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" font-size="{FONT_PX}"'
        ' font-family="DejaVu Sans Mono,Menlo,Consolas,monospace" fill-rule="evenodd">\n'
        "<title>ChatRobot: a drive, a way through the flat, and a stop in the middle of it</title>\n"
        f'<rect width="100%" height="100%" rx="8" fill="{_hex(PAPER)}"/>\n'
    )
    lights = "".join(
        f'<circle cx="{18 + 18 * index}" cy="16" r="5" fill="{ink}"/>'
        for index, ink in enumerate(("#ed6a5e", "#f5bf4f", "#61c554"))
    )
    rows = [_versions(y, row, numbers, len(frames), whole_s) for (y, row), numbers in shown.items()]
    return f"{head}{lights}\n" + "\n".join(rows) + "\n</svg>\n"


def _versions(y: int, row: Row, numbers: list[int], count: int, whole_s: float) -> str:
    """One look of a row, with the times at which it shows. It shows without them if it belongs to the last frame."""
    shown, is_last = set(numbers), numbers[-1] == count - 1
    times, values = [0.0], ["visible" if 0 in shown else "hidden"]
    for number in range(1, count):
        value = "visible" if number in shown else "hidden"
        if value != values[-1]:
            times.append(number * FRAME_S / whole_s)
            values.append(value)
    inside = "".join(_run(y, run) for run in row)
    if len(values) == 1:
        return f"<g>{inside}</g>"
    return (
        f'<g visibility="{"visible" if is_last else "hidden"}"><animate attributeName="visibility" dur="{whole_s:g}s"'
        f' repeatCount="indefinite" calcMode="discrete" keyTimes="{";".join(f"{at:.4g}" for at in times)}"'
        f' values="{";".join(values)}"/>{inside}</g>'
    )


def _run(y: int, run: Run) -> str:
    left, top, width = PAD + run.x * CELL_W, PAD + TITLE_H + y * CELL_H, run.cells * CELL_W
    box = "" if run.paper == PAPER else _rect(left, top, width, CELL_H, run.paper)
    if "\u2800" <= run.text[0] <= "\u28ff":
        return box + _dots(left, top, run)
    if FULL <= run.text[0] <= EIGHTHS:
        filled = sum((0x2590 - ord(letter)) / 8 for letter in run.text) * CELL_W
        return box + _rect(left, top + 4, filled, CELL_H - 8, run.ink)
    text = run.text.strip()
    if not text:
        return box
    left += (len(run.text) - len(run.text.lstrip())) * CELL_W
    cells = run.cells - (len(run.text) - len(text))
    weight = ' font-weight="bold"' if run.bold else ""
    return (
        f'{box}<text x="{left:.5g}" y="{top + CELL_H * 0.76:.5g}" fill="{_hex(run.ink)}"{weight} xml:space="preserve"'
        f' textLength="{cells * CELL_W:.5g}">{escape(text)}</text>'
    )


def _dots(left: float, top: float, run: Run) -> str:
    dots = [
        f"M{left + CELL_W * (index + 0.25 + 0.5 * x):.4g} {top + CELL_H * (0.125 + 0.25 * y):.4g}h0"
        for index, letter in enumerate(run.text)
        for x, y in braille_dots(letter)
    ]
    return (
        f'<path d="{"".join(dots)}" stroke="{_hex(run.ink)}" stroke-width="2.7" stroke-linecap="round"/>'
        * bool(dots)
    )


def _rect(x: float, y: float, width: float, height: float, ink: tuple[int, int, int]) -> str:
    return f'<rect x="{x:.5g}" y="{y:.5g}" width="{width:.4g}" height="{height:g}" fill="{_hex(ink)}"/>'


def _hex(ink: tuple[int, int, int]) -> str:
    return "#{:02x}{:02x}{:02x}".format(*ink)


if __name__ == "__main__":
    FILE.write_text(draw(record()), encoding="utf-8")
