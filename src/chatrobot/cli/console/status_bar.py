"""The live status bar under the prompt: a small map and how far the robot is. Pure: a `MotionView` in, styled
text out."""

from __future__ import annotations

import math

from rich.cells import cell_len

from chatrobot.cli.console.motion_view import XY, MotionView
from chatrobot.cli.console.words import Words
from chatrobot.cli.drawing.extent import Orientation, extent_around
from chatrobot.cli.drawing.map_text import MapLines, MapText
from chatrobot.sim.world import World

Fragments = list[tuple[str, str]]

MAP_COLUMNS, MAP_ROWS = 24, 6
LEAST_WIDTH = 50
"""A terminal narrower than this has no room for a map beside the words."""

BAR_CELLS, LEAST_BAR_CELLS, PERCENT_CELLS = 20, 4, 6
_DIM = "class:status-bar.dim"
_EIGHTHS = " ▏▎▍▌▋▊▉"

STYLES = {
    "bottom-toolbar": "noreverse bg:default",
    "status-bar": "",
    "status-bar.dim": "#8a8a8a",
    "status-bar.key": "bold",
    "status-bar.bar": "#3a8fd6",
    "status-bar.rest": "#5a5a5a",
    "status-bar.alarm": "bold #ffffff bg:#c01828",
    "map.wall": "#8a8a8a",
    "map.path": "#3a8fd6",
    "map.trail": "#e2842a",
    "map.robot": "bold #e24c26",
    "map.place": "#0f9a8e",
    "prompt": "bold #3a8fd6",
}
"""For prompt_toolkit. The colours hold on dark and on light terminals."""


class StatusBar:
    """Draws the status bar. `shows_map` is what `/map` toggles."""

    def __init__(self, motion_view: MotionView, words: Words, world: World) -> None:
        self._view, self._words, self._world = motion_view, words, world
        self.shows_map = True
        self._map: MapText | None = None
        self._map_of: tuple[XY, ...] | None = None

    def show_world(self, world: World) -> None:
        """Draw that world from now on."""
        self._world = world
        self._map_of = None

    def fragments(self, columns: int, latched: bool = False, model_wait_s: float | None = None) -> Fragments:
        """Draw the bar in `columns` cells: one line while the robot stands, the map's height while it moves.

        Args:
            model_wait_s: for how long a model has been asked; None where none is.
        """
        if latched:
            return [("class:status-bar.alarm", f" {self._words.say('latched')} ")]
        thinking = "" if model_wait_s is None else self._words.say("thinking", seconds=int(model_wait_s))
        if not self._view.is_moving:
            return self._standing(columns, thinking)
        has_map = self.shows_map and self._view.is_measured and columns >= LEAST_WIDTH
        room = columns - MAP_COLUMNS - 2 if has_map else columns
        lines = [_cut(line, room) for line in self._moving(room, thinking)]
        if has_map:
            beside = [[], *lines, *([] for _ in range(MAP_ROWS))]
            rows = zip(self._map_lines(), beside)
            lines = [[("", " "), *_map_fragments(row), ("", " "), *words] for row, words in rows]
        joined: Fragments = []
        for number, line in enumerate(lines):
            joined += ([("", "\n")] if number else []) + line
        return joined

    def _standing(self, columns: int, state: str) -> Fragments:
        view, say = self._view, self._words.say
        if not state and (view.is_measured or view.is_paused):
            state = say("paused" if view.is_paused else "standing")
        where = self._words.pose(view.pose) if view.is_measured else say("not_measured")
        words = f" {state} · {where}" if state else f" {where}"
        hints = say("strip_idle").split("  ")
        while hints and cell_len(f"{words}   {'  '.join(hints)}") > columns:
            hints.pop()
        return _cut([(_DIM, f"{words}   {'  '.join(hints)}".rstrip())], columns)

    def _moving(self, room: int, thinking: str) -> list[Fragments]:
        view, say = self._view, self._words.say
        pose, speed = self._words.pose(view.pose), f"{view.twist.speed_mps:.2f}"
        facts = (
            [say("at_pose", pose=pose), say("speed", speed=speed)]
            if view.is_measured
            else [say("not_measured")]
        )
        if abs(view.twist.wz_radps) > math.radians(1.0):
            facts.append(say("rate", rate=f"{math.degrees(view.twist.wz_radps):+.0f}"))
        more = []
        if view.nearest_m is not None:
            more.append(say("nearest", distance=f"{view.nearest_m:.2f}"))
        if view.battery_percent is not None:
            more.append(say("battery", percent=f"{view.battery_percent:.0f}"))
        if thinking:
            more.append(thinking)
        label = f" {say('moving')}  "
        head: Fragments = [("class:status-bar.key", label)]
        if view.fraction is not None:  # of what has no known end there is no share
            cells = room - cell_len(label) - PERCENT_CELLS
            head += _bar(view.fraction, max(LEAST_BAR_CELLS, min(BAR_CELLS, cells)))
        if view.step_count > 1:
            head.append(("", f"  {say('step', step=max(1, view.step_number), of=view.step_count)}"))
        lines: list[Fragments] = [head, [("", f" {' · '.join(facts)}")]]
        return [*lines, *([(_DIM, f" {line}")] for line in (" · ".join(more), say("strip_hint")) if line)]

    def _map_lines(self) -> MapLines:
        """Draw the map of this plan, its still part once a plan, so that it does not jump while it is driven."""
        view = self._view
        if self._map is None or self._map_of is not view.path:
            points = Orientation(self._world).points((*view.path, *view.trail[:1]))
            extent = extent_around(points, margin_m=0.5, least_m=2.5)
            self._map = MapText(self._world, extent, columns=MAP_COLUMNS, rows=MAP_ROWS, path=view.path)
            self._map_of = view.path
        return self._map.lines(trail=view.trail, pose=view.pose)


def _map_fragments(row: list[tuple[str, str]]) -> Fragments:
    """Put one line of a map in prompt_toolkit's styles."""
    return [(f"class:map.{layer}" if layer else "", text) for layer, text in row]


def _bar(fraction: float, cells: int) -> Fragments:
    eighths = round(fraction * cells * 8)
    full, part = divmod(eighths, 8)
    done = "█" * full + (_EIGHTHS[part] if part else "")
    return [
        ("class:status-bar.bar", done),
        ("class:status-bar.rest", "─" * (cells - len(done))),
        ("", f" {fraction * 100:3.0f} %"),
    ]


def _cut(line: Fragments, columns: int) -> Fragments:
    """Cut the line to `columns` cells: a toolbar that wraps would push the prompt about."""
    left, cut = columns, Fragments()
    for style, text in line:
        kept = text
        while cell_len(kept) > left:
            kept = kept[:-1]
        cut.append((style, kept))
        left -= cell_len(kept)
        if kept != text:
            break
    return cut
