"""The side of a shape told in a clause of its own: `a hexagon with 30 cm sides, turn right`, 拐角都往右拐."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.frames import STILL, Frame
from chatrobot.language.unclear import Unclear

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
