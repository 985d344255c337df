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
        self._motion_view, self._words, self._world = motion_view, words, world
        self.shows_map = True
        self._map: MapText | None = None
        self._map_of: tuple[XY, ...] | None = None

    def fragments(self, width: int, latched: bool = False, model_wait_s: float | None = None) -> Fragments:
        """Draw the bar in `width` cells: one line while the robot stands, the map's height while it moves.

        Args:
            thinking_s: for how long a model has been asked; None where none is.
        """
        if latched:
            return [("class:status-bar.alarm", f" {self._words.say('latched')} ")]
        if not self._motion_view.is_moving:
            return self._standing(width, model_wait_s)
        has_map = self.shows_map and self._motion_view.is_measured and width >= LEAST_WIDTH
        room = width - MAP_COLUMNS - 2 if has_map else width
        lines = [_cut(line, room) for line in self._words_beside(room, model_wait_s)]
        if has_map:
            lines = self._with_map(lines)
        joined: Fragments = []
        for number, line in enumerate(lines):
            joined += ([("", "\n")] if number else []) + line
        return joined

    def _standing(self, width: int, model_wait_s: float | None) -> Fragments:
        is_measured, state = self._motion_view.is_measured, self._thinking(model_wait_s)
        if not state and (is_measured or self._motion_view.is_paused):
            state = self._words.say("paused" if self._motion_view.is_paused else "standing")
        where = self._words.pose(self._motion_view.pose) if is_measured else self._words.say("not_measured")
        words = f" {state} · {where}" if state else f" {where}"
        hints = self._words.say("strip_idle").split("  ")
        while hints and cell_len(f"{words}   {'  '.join(hints)}") > width:
            hints.pop()
        return _cut([("class:status-bar.dim", f"{words}   {'  '.join(hints)}".rstrip())], width)

    def _thinking(self, model_wait_s: float | None) -> str:
        return self._words.say("thinking", seconds=int(model_wait_s)) if model_wait_s is not None else ""

    def _words_beside(self, room: int, model_wait_s: float | None) -> list[Fragments]:
        motion_view, say = self._motion_view, self._words.say
        facts = [
            say("at_pose", pose=self._words.pose(motion_view.pose)),
            say("speed", speed=f"{motion_view.twist.speed_mps:.2f}"),
        ]
        if not motion_view.is_measured:
            facts = [say("not_measured")]
        if abs(motion_view.twist.wz_radps) > math.radians(1.0):
            facts.append(say("rate", rate=f"{math.degrees(motion_view.twist.wz_radps):+.0f}"))
        more = (
            [say("nearest", distance=f"{motion_view.nearest_m:.2f}")]
            if motion_view.nearest_m is not None
            else []
        )
        if motion_view.battery_percent is not None:
            more.append(say("battery", percent=f"{motion_view.battery_percent:.0f}"))
        if model_wait_s is not None:
            more.append(self._thinking(model_wait_s))
        label = f" {say('moving')}  "
        bar_cells = max(LEAST_BAR_CELLS, min(BAR_CELLS, room - cell_len(label) - PERCENT_CELLS))
        head: Fragments = [("class:status-bar.key", label)]
        if motion_view.fraction is not None:  # of what has no known end there is no share
            head += _bar(motion_view.fraction, bar_cells)
        if motion_view.of > 1:
            head.append(("", f"  {say('step', step=max(1, motion_view.step), of=motion_view.of)}"))
        lines: list[Fragments] = [head, [("", f" {' · '.join(facts)}")]]
        if more:
            lines.append([("class:status-bar.dim", f" {' · '.join(more)}")])
        lines.append([("class:status-bar.dim", f" {say('strip_hint')}")])
        return lines

    def _with_map(self, lines: list[Fragments]) -> list[Fragments]:
        beside = [[], *lines, *([] for _ in range(MAP_ROWS))]
        return [
            [("", " "), *map_fragments(row), ("", " "), *words]
            for row, words in zip(self._map_lines(), beside)
        ]

    def _map_lines(self) -> MapLines:
        """Draw the map of this plan, its still part once a plan, so that it does not jump while it is driven."""
        motion_view = self._motion_view
        if self._map is None or self._map_of is not motion_view.path:
            points = Orientation(self._world).points((*motion_view.path, *motion_view.trail[:1]))
            extent = extent_around(points, margin_m=0.5, least_m=2.5)
            self._map = MapText(
                self._world, extent, columns=MAP_COLUMNS, rows=MAP_ROWS, path=motion_view.path
            )
            self._map_of = motion_view.path
        return self._map.lines(trail=motion_view.trail, pose=motion_view.pose)


def map_fragments(row: list[tuple[str, str]]) -> Fragments:
    """One line of a map in prompt_toolkit's styles."""
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


def _cut(line: Fragments, width: int) -> Fragments:
    """Cut the line to `width` cells: a toolbar that wraps would push the prompt about."""
    left, cut = width, Fragments()
    for style, text in line:
        kept = text
        while cell_len(kept) > left:
            kept = kept[:-1]
        cut.append((style, kept))
        left -= cell_len(kept)
        if kept != text:
            break
    return cut
