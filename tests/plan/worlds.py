"""Small worlds of rectangles with an exact signed distance, so that nothing here depends on the simulator."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from chatrobot.plan.known_world import Floats
from chatrobot.sim.shapes import Polygon
from chatrobot.sim.world import Bounds

Box = tuple[float, float, float, float]
"""min x, min y, max x, max y, in metres."""


class BoxWorld:
    def __init__(self, boxes: Sequence[Box], area: Sequence[tuple[float, float]] = ()) -> None:
        self.boxes = np.array(boxes, dtype=float).reshape(-1, 4)
        self.allowed_area = Polygon(tuple(area)) if area else None

    @property
    def is_empty(self) -> bool:
        return len(self.boxes) == 0

    @property
    def bounds(self) -> Bounds | None:
        if self.is_empty:
            return None
        low, high = self.boxes[:, :2].min(axis=0), self.boxes[:, 2:].max(axis=0)
        return Bounds(float(low[0]), float(low[1]), float(high[0]), float(high[1]))

    def clearance_m(self, points: Floats) -> Floats:
        if self.is_empty:
            return np.full(len(points), 1e6)
        clearance: Floats = self._distances(points).min(axis=1)
        return clearance

    def obstacle_names_at(self, x_m: float, y_m: float) -> tuple[str, ...]:
        return (f"box {int(self._distances(np.array([[x_m, y_m]])).argmin())}",)

    def _distances(self, points: Floats) -> Floats:
        x, y = points[:, 0:1], points[:, 1:2]
        gap_x = np.maximum(self.boxes[:, 0] - x, x - self.boxes[:, 2])
        gap_y = np.maximum(self.boxes[:, 1] - y, y - self.boxes[:, 3])
        outside = np.hypot(np.maximum(gap_x, 0.0), np.maximum(gap_y, 0.0))
        distances: Floats = np.where((gap_x > 0) | (gap_y > 0), outside, np.maximum(gap_x, gap_y))
        return distances


NOTHING = BoxWorld([])
WALL_AHEAD = BoxWorld([(2.0, -3.0, 2.1, 3.0)])


def flat(door_m: float = 0.8) -> BoxWorld:
    """8 m x 6 m, the start inside at (0, 0); a wall at x = 4 with a door whose middle is at y = 3."""
    west, south, east, north = -1.0, -1.0, 7.0, 5.0
    low, high = 3.0 - door_m / 2, 3.0 + door_m / 2
    outer = [
        (west - 0.1, south - 0.1, east + 0.1, south),
        (west - 0.1, north, east + 0.1, north + 0.1),
        (west - 0.1, south, west, north),
        (east, south, east + 0.1, north),
    ]
    return BoxWorld([*outer, (3.95, south, 4.05, low), (3.95, high, 4.05, north), (1.5, 1.0, 2.5, 1.6)])
