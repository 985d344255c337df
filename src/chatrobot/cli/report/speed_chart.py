"""How fast the robot was told to be and was, over time, under its limits, on any surface."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from operator import itemgetter

from chatrobot.cli.drawing.ground import AMBER, FAINT, GRID, GRID_STRONG, INK, WHITE, Rgb
from chatrobot.cli.drawing.surface import Box, Surface
from chatrobot.cli.report.drive import Drive
from chatrobot.cli.report.map_figure import MARK_COLOURS, MEASURED, MOST_MARKS

COMMANDED, LIMIT = (31, 119, 214), AMBER
_STEPS_S = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 14_400, 43_200)
_STEPS = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
_MOST_LINES = 4
_LEAST_STEP_PX = 150
"""Between two times: on a phone it is a third of this."""
_COLUMN_PX = 1.0
"""What is narrower than this is told by its lowest and highest value."""
_HEAD_PX, _FOOT_PX, _BETWEEN_PX = 20, 22, 26
Sample = tuple[float, float]
Say = Callable[[str], str]


def draw_speeds(drive: Drive, surface: Surface, box: Box, say: Say) -> None:
    """Draw both charts into a part of a surface: the speed, and below it the rate of turn."""
    left, top, right, bottom = box
    height = (bottom - top - 2 * _HEAD_PX - _FOOT_PX - _BETWEEN_PX / 2) / 2.0
    commands, odometry = drive.recording.commands, drive.recording.odometry or drive.recording.truth
    fastest, quickest = drive.limits.get("max_speed_mps"), drive.limits.get("max_rate_radps")
    first = (left, top + _HEAD_PX, right, top + _HEAD_PX + height)
    second = (left, first[3] + _BETWEEN_PX / 2 + _HEAD_PX, right, bottom - _FOOT_PX)
    speeds = _Chart(drive, surface, first, fastest, say("chart_speed"))
    speeds.draw(
        [(t_s, _speed_mps(*twist)) for t_s, twist in commands],
        [(t_s, _speed_mps(*sample[4:])) for t_s, sample in odometry],
    )
    rates = _Chart(drive, surface, second, math.degrees(quickest) if quickest else None, say("chart_rate"))
    rates.draw(
        [(t_s, math.degrees(twist.wz_radps)) for t_s, twist in commands],
        [(t_s, math.degrees(sample.wz_radps)) for t_s, sample in odometry],
    )
    rates.name_times()


def _speed_mps(vx_mps: float, vy_mps: float, _wz_radps: float) -> float:
    """How fast, below zero for backwards."""
    speed = math.hypot(vx_mps, vy_mps)
    return -speed if vx_mps < 0.0 and abs(vx_mps) > abs(vy_mps) else speed


class _Chart:
    def __init__(
        self, drive: Drive, surface: Surface, box: Box, most_value: float | None, title: str
    ) -> None:
        self._drive, self._surface, self._box = drive, surface, box
        is_known = most_value is not None and math.isfinite(most_value) and most_value > 0.0
        self._limit = most_value if is_known else None
        self._title = title
        self._duration_s = max(1.0, drive.recording.duration_s)
        self._low = self._high = 0.0

    def draw(self, commanded: Sequence[Sample], measured: Sequence[Sample]) -> None:
        """Draw the frame, what was commanded and what was measured."""
        values = [value for _, value in (*commanded, *measured) if math.isfinite(value)]
        most = max((self._limit or 0.0) * 1.12, *(abs(v) * 1.08 for v in values), 0.1)
        is_below = any(value < -0.02 * most for value in values)
        self._low, self._high = (-most if is_below else -0.06 * most), most
        self._frame()
        self._line(measured, MEASURED, 2.2)
        self._line(commanded, COMMANDED, 1.0)
        for mark in self._drive.marks[:MOST_MARKS]:
            for x in map(self._x, mark.times_s[:MOST_MARKS]):
                self._surface.dashed(
                    [(x, self._box[1]), (x, self._box[3])], (*MARK_COLOURS[mark.kind], 200), 1.2
                )

    def _x(self, t_s: float) -> float:
        return self._box[0] + (self._box[2] - self._box[0]) * min(1.0, t_s / self._duration_s)

    def _y(self, value: float) -> float:
        share = (value - self._low) / (self._high - self._low)
        return self._box[3] - (self._box[3] - self._box[1]) * min(1.0, max(0.0, share))

    def _frame(self) -> None:
        left, top, right, bottom = self._box
        self._surface.box(self._box, fill=WHITE)
        for t_s in self._times():
            self._surface.line([(self._x(t_s), top), (self._x(t_s), bottom)], GRID)
        for value in self._values():
            y = self._y(value)
            self._surface.line([(left, y), (right, y)], GRID if value else GRID_STRONG)
            if value and abs(abs(value) - (self._limit or 0.0)) > 0.1 * self._high:
                self._surface.text((right - 4, y), f"{value:g}", FAINT, 12, "rm", halo=(*WHITE, 215))
        self._surface.text((left, top - 6), self._title, INK, 13, "ls")
        for value in (self._limit, -self._limit) if self._limit is not None else ():
            if self._low <= value <= self._high:
                y = self._y(value)
                self._surface.dashed([(left, y), (right, y)], LIMIT, 1.4)
                place, anchor = ((left + 4, y + 3), "la") if value > 0.0 else ((left + 4, y - 4), "ls")
                self._surface.text(place, f"{value:.3g}", LIMIT, 12, anchor, halo=(*WHITE, 215))

    def _values(self) -> Iterable[float]:
        """Give the values that lines are drawn at, some of each side of zero at most."""
        step = next((step for step in _STEPS if (self._high - self._low) / step <= _MOST_LINES), _STEPS[-1])
        return (i * step for i in range(math.ceil(self._low / step), math.floor(self._high / step) + 1))

    def _line(self, samples: Sequence[Sample], colour: Rgb, width_px: float) -> None:
        for piece in _pieces(samples):
            points = [(self._x(t_s), self._y(value)) for t_s, value in piece]
            thinned = list(_thinned(points))
            if len(thinned) > 1:
                self._surface.line(thinned, colour, width_px)

    def _times(self) -> Iterable[float]:
        width_px = self._box[2] - self._box[0]
        fits = (step for step in _STEPS_S if step / self._duration_s * width_px >= _LEAST_STEP_PX)
        step = next(fits, 86_400)
        return range(0, math.floor(self._duration_s) + 1, step)

    def name_times(self) -> None:
        """Write the times below."""
        for t_s in self._times():
            anchor = "la" if t_s == 0 else "ma"
            if self._x(t_s) < self._box[2] - 16:
                self._surface.text((self._x(t_s), self._box[3] + 6), clock(t_s), FAINT, 12, anchor)


_GAP_S = 1.0


def _pieces(samples: Sequence[Sample]) -> Iterable[list[Sample]]:
    """Give the samples without the gaps between them, in which nothing was known."""
    piece: list[Sample] = []
    for sample in samples:
        if piece and sample[0] - piece[-1][0] > _GAP_S:
            yield piece
            piece = []
        if math.isfinite(sample[1]):
            piece.append(sample)
    if piece:
        yield piece


def _thinned(points: Sequence[Sample]) -> Iterable[Sample]:
    """Give of each column of pixels the first, lowest, highest and last point, each once and in their order."""
    column: list[Sample] = []
    for point in (*points, None):
        if point is not None and (not column or int(point[0] / _COLUMN_PX) == int(column[0][0] / _COLUMN_PX)):
            column.append(point)
            continue
        height = itemgetter(1)
        ends = {column[0], column[-1], min(column, key=height), max(column, key=height)} if column else set()
        yield from sorted(ends)
        column = [point] if point is not None else []


def clock(t_s: float, decimals: int = 0) -> str:
    """Write a time as minutes and seconds: `1:05`, `1:05.2`."""
    tenths = round(t_s * 10**decimals)
    minutes, rest = divmod(tenths, 60 * 10**decimals)
    width = 2 if not decimals else 3 + decimals
    return f"{minutes}:{rest / 10**decimals:0{width}.{decimals}f}"
