"""The sides of a shape: told in a clause of their own (`a hexagon with 30 cm sides, turn right`), or left to drive."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from chatrobot.language.frames import STILL, Frame
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn

_AT_CORNERS = frozenset({"after_each", "each", "all"})


def tells_side(parts: Sequence[Frame], rest: Sequence[Frame]) -> bool:
    """Whether the turn that `rest` begins with has no amount and says which way the shape of `parts` turns.

    Raises:
        Unclear: where it may be a turn after the shape, or the shape turns the other way.
    """
    turn = rest[0]
    is_turn = turn.verb == "turn" or (
        not turn.verb and bool(turn.flags & _AT_CORNERS)
    )  # `left at each corner`
    bare = is_turn and turn.sided and not (turn.q or turn.shape or turn.place or turn.roles)
    if not bare or turn.joined == "then" or turn.flags - _AT_CORNERS:
        return False
    at_corners = bool(turn.flags)
    sides = {_side(part) for part in parts if part.sided}
    if sides:
        if at_corners and sides != {_side(turn)}:
            raise Unclear("contradiction", turn.text)
        return at_corners
    goes_on = len(rest) > 1 and rest[1].joined != "then" and (rest[1].moves or rest[1].verb in STILL)
    if not at_corners and (goes_on or turn.joined in ("and", "strong")):
        raise Unclear(
            "unclear_motion", turn.text
        )  # `a square, turn right, go 1 m`: its side, or a turn after it?
    return True


def _side(frame: Frame) -> str:
    return frame.rot or frame.direction


def rest_of_shape(steps: list[Step], sides: int) -> list[Step] | None:
    """What is missing to a whole circle, or to a polygon of equal sides and turns; `sides` if it was named by them."""
    last = steps[-1]
    if len(steps) == 1 and isinstance(last, Arc) and not sides:
        left = 2 * math.pi - last.angle_rad
        return [dataclasses.replace(last, angle_rad=left)] if left > 1e-3 else None
    if len(steps) == 1 and isinstance(last, Turn) and last.angle_rad and not sides:
        times = round(2 * math.pi / last.angle_rad)
        return [last] * (times - 1) or None if abs(times * last.angle_rad - 2 * math.pi) < 1e-6 else None
    side, turn = steps[:2] if len(steps) > 1 else (None, None)
    if not isinstance(side, Drive) or not isinstance(turn, Turn) or not turn.angle_rad:
        return None
    whole = [side, turn] * (sides or round(2 * math.pi / turn.angle_rad))
    fits = abs(len(whole) / 2 * turn.angle_rad - 2 * math.pi) < 1e-6 and whole[: len(steps)] == steps
    return whole[len(steps) :] or None if fits else None
