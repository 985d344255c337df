"""A map in characters: braille dots, two by four to a cell, with the robot as an arrow.

Shared by the live status bar and `/map big`. What it gives is lines of (layer, text) runs; each display has its
own colours for the layers `wall`, `path`, `trail`, `place` and `robot`; "" is background.
"""

from __future__ import annotations

import functools
import math
import operator
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, pairwise

from chatrobot.cli.drawing.extent import XY, Extent, Orientation
from chatrobot.core.geometry import Pose
from chatrobot.sim.world import World

Run = tuple[str, str]
MapLines = list[list[Run]]
Cell = tuple[int, int]
Layers = dict[str, dict[Cell, int]]

ARROWS = "→↗↑↖←↙↓↘"
PLACE_MARK = "•"
_BLANK = 0x2800
_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
_LAYERS = ("wall", "path", "trail")


def arrow(yaw_rad: float) -> str:
    """Return the arrow that points nearest to `yaw_rad` on a map whose x runs to the right and y up."""
    return ARROWS[round(yaw_rad / (math.pi / 4.0)) % 8]


class MapText:
    """A world within an extent on so many cells. What stands still is drawn once.

    Args:
        names: write the names of places on the map, and those of furniture where there is room.
    """

    def __init__(
        self,
        world: World,
        extent: Extent,
        *,
        columns: int,
        rows: int,
        path: Iterable[XY] = (),
        names: bool = False,
    ) -> None:
        self._columns, self._rows = columns, rows
        self._orientation = Orientation(world)
        self._dots_per_m = min(columns * 2 / extent.width_m, rows * 4 / extent.height_m)
        self._extent = extent
        self._left = (columns * 2 - extent.width_m * self._dots_per_m) / 2.0
        self._top = (rows * 4 - extent.height_m * self._dots_per_m) / 2.0
        self._still: Layers = {layer: {} for layer in _LAYERS}
        for _, outline in world.outline():
            self._line("wall", (*outline, outline[0]), self._still)
        self._line("path", tuple(path), self._still)
        self._letters: dict[Cell, Run] = {}
        if names:
            for name, pose in world.places.items():
                if extent.holds(*self._orientation.point(pose.x_m, pose.y_m)):
                    self._name(name, pose)
            for name, outline in furniture(world):
                self._furniture_name(name, outline)

    def lines(self, *, trail: Sequence[XY] = (), pose: Pose | None = None) -> MapLines:
        """Draw the map now: `rows` lines of runs, each line `columns` cells wide."""
        layers = {layer: dict(cells) for layer, cells in self._still.items()}
        self._line("trail", trail, layers)
        letters = dict(self._letters)
        if pose is not None and self._extent.holds(*self._orientation.point(pose.x_m, pose.y_m)):
            heading_rad = self._orientation.heading_rad(pose.yaw_rad)
            self._put(letters, self._cell(pose.x_m, pose.y_m), ("robot", arrow(heading_rad)))
        rows = (
            [self._one((column, row), layers, letters) for column in range(self._columns)]
            for row in range(self._rows)
        )
        return [
            [(layer, "".join(text for _, text in run)) for layer, run in groupby(cells, lambda cell: cell[0])]
            for cells in rows
        ]

    def _one(self, cell: Cell, layers: Layers, letters: dict[Cell, Run]) -> Run:
        if cell in letters:
            return letters[cell]
        here = {layer: bits for layer in _LAYERS if (bits := layers[layer].get(cell, 0))}
        if not here:
            return "", " "
        return [*here][-1], chr(_BLANK + functools.reduce(operator.or_, here.values()))

    # --- putting things on ---

    def _dot(self, x_m: float, y_m: float) -> tuple[float, float]:
        right_m, up_m = self._orientation.point(x_m, y_m)
        return (
            self._left + (right_m - self._extent.min_x_m) * self._dots_per_m,
            self._top + (self._extent.max_y_m - up_m) * self._dots_per_m,
        )

    def _cell(self, x_m: float, y_m: float) -> Cell:
        x, y = self._dot(x_m, y_m)
        return min(self._columns - 1, int(x) // 2), min(self._rows - 1, int(y) // 4)

    def _line(self, layer: str, points: Sequence[XY], layers: Layers) -> None:
        cells = layers[layer]
        for a, b in pairwise(points if len(points) != 1 else (*points, *points)):
            (ax, ay), (bx, by) = self._dot(*a), self._dot(*b)
            # A wall far longer than the map has its ends out of sight.
            count = min(4096, max(1, math.ceil(max(abs(bx - ax), abs(by - ay)))))
            for i in range(count + 1):
                x, y = int(ax + (bx - ax) * i / count), int(ay + (by - ay) * i / count)
                if 0 <= x < self._columns * 2 and 0 <= y < self._rows * 4:
                    cell = (x // 2, y // 4)
                    cells[cell] = cells.get(cell, 0) | _DOTS[y % 4][x % 2]

    def _name(self, name: str, pose: Pose) -> None:
        column, row = self._cell(pose.x_m, pose.y_m)
        width = sum(map(_width, name))
        start = column + 1 if column + 1 + width <= self._columns else column - width
        span = range(min(start, column), max(start + width, column + 1))
        has_room = span.start >= 0 and not any((i, row) in self._letters for i in span)
        self._put(self._letters, (column, row), ("place", PLACE_MARK))
        if has_room:
            self._write("place", name, (start, row))

    def _furniture_name(self, name: str, outline: Sequence[XY]) -> None:
        """Write a name in the middle of the thing, else right, left, above or below; nowhere where there is no room."""
        dots = [self._dot(*point) for point in outline]
        left, right = (int(end(x for x, _ in dots)) // 2 for end in (min, max))
        top, bottom = (int(end(y for _, y in dots)) // 4 for end in (min, max))
        width = sum(map(_width, name))
        middle, row = (left + right + 1 - width) // 2, (top + bottom) // 2
        beside = ((right + 1, row), (left - width, row), (middle, top - 1), (middle, bottom + 1))
        for start, line in ((middle, row), *beside):
            if self._has_room(range(start, start + width), line):
                self._write("wall", name, (start, line))
                return

    def _has_room(self, span: range, row: int) -> bool:
        is_on_map = 0 <= row < self._rows and span.start >= 0 and span.stop <= self._columns
        taken = {*self._letters, *(cell for cells in self._still.values() for cell in cells)}
        return is_on_map and not any((column, row) in taken for column in span)

    def _write(self, layer: str, name: str, start: Cell) -> None:
        column, row = start
        for char in name:
            self._put(self._letters, (column, row), (layer, char))
            column += _width(char)

    @staticmethod
    def _put(letters: dict[Cell, Run], cell: Cell, run: Run) -> None:
        """Put one character; a wide one takes the next cell too, and half a wide one goes with its other half."""
        column, row = cell
        before = letters.get((column - 1, row))
        if letters.get(cell) == ("place", "") and before is not None:
            letters[(column - 1, row)] = (before[0], " ")
        old = letters.get(cell)
        if old is not None and old[1] and _width(old[1]) == 2 and _width(run[1]) == 1:
            letters[(column + 1, row)] = (old[0], " ")
        letters[cell] = run
        if _width(run[1]) == 2:
            letters[(column + 1, row)] = (run[0], "")


def _width(char: str) -> int:
    return 2 if unicodedata.east_asian_width(char) in "WF" else 1


WALL_M = 0.15
"""What is no thicker is a wall, and says by its line what it is."""


def furniture(world: World) -> Iterator[tuple[str, tuple[XY, ...]]]:
    """Give the names and outlines of what is neither a wall nor a place."""
    places = {name.casefold() for name in world.places}
    for name, outline in world.outline():
        if name.casefold() not in places and thickness_m(outline) > WALL_M:
            yield name, outline


def thickness_m(outline: Sequence[XY]) -> float:
    """Return a rectangle's shorter side; of other shapes the width of one of the same area and longest side."""
    sides = [*pairwise(outline), (outline[-1], outline[0])]
    area = abs(sum(ax * by - bx * ay for (ax, ay), (bx, by) in sides)) / 2.0
    longest = max(math.dist(a, b) for a, b in sides)
    return area / longest if longest > 0.0 else 0.0
