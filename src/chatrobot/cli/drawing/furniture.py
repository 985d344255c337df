"""What of a world is worth its name on a map: what is no wall, and is not named as a place beside it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from chatrobot.cli.drawing.orientation import XY
from chatrobot.sim.world import World

WALL_M = 0.15
"""What is no thicker is a wall, and says by its line what it is."""


def furniture(world: World) -> Iterator[tuple[str, tuple[XY, ...]]]:
    """Names and outlines."""
    places = {name.casefold() for name in world.places}
    for name, outline in world.outline():
        if name.casefold() not in places and thickness_m(outline) > WALL_M:
            yield name, outline


def thickness_m(outline: Sequence[XY]) -> float:
    """Of a rectangle its shorter side; of other shapes how wide one of the same area and longest side would be."""
    sides = [*pairwise(outline), (outline[-1], outline[0])]
    area = abs(sum(ax * by - bx * ay for (ax, ay), (bx, by) in sides)) / 2.0
    longest = max(math.dist(a, b) for a, b in sides)
    return area / longest if longest > 0.0 else 0.0
