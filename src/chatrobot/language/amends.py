"""`No, I meant left`, 不对，应该往左: what was just done is undone, and done as it should have been.

Only where the turn before has moved and come to its end; what the correction leaves unsaid is as it was. An amount by
itself (`no, 70 cm`) is a total, and is told elsewhere: what is missing to it is all that is moved.
"""

from __future__ import annotations

from chatrobot.language.context import Context
from chatrobot.language.frames import GO, SIDES, TURN, Frame
from chatrobot.language.inverse import inverse
from chatrobot.language.tokens import quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Drive, Step, Turn

MARK = "corrects"
"""The flag of a frame that begins with a correction, with nothing before it to be corrected."""

_ON = frozenset({"more", "again", "bit", "extra", "same_amount", "short_of", "same_way", "to_start", "there"})
"""Words by which one goes on from here: nothing is undone before them."""


def amended(frames: list[Frame], context: Context) -> list[Step]:
    """What undoes the turn before, where `frames` correct it; else nothing. The frames are completed from that turn.

    Raises:
        Unclear: where it cannot be told which part of that turn was wrong.
    """
    marked = [frame for frame in frames if MARK in frame.flags]
    for frame in marked:
        frame.flags.discard(MARK)
    turns = context.dialogue.turns
    done = bool(turns) and turns[-1].plan is not None and turns[-1].outcome == "completed"
    if not marked or not done or turns[-1].plan is None:
        return []
    first, steps = frames[0], list(turns[-1].plan.steps)
    if any(_ON & frame.flags or frame.verb in ("undo", "return") for frame in frames):
        return []
    if first.shape or first.place or first.words:
        return []
    if len(steps) != 1 or len(frames) != 1:
        raise Unclear("unclear_motion", first.text)
    if first.moves:
        _complete(first, steps[0])
    elif "other_way" not in first.flags or first.has_extent:
        return []
    return inverse(steps)


def _complete(frame: Frame, was: Step) -> None:
    """What the correction does not say is as it was: how far, how much."""
    if frame.has_extent:
        return
    if isinstance(was, Turn) and was.angle_rad and _names_side(frame) and frame.verb in ("", *TURN, "go"):
        frame.verb = "turn"
        frame.q["angle"] = quantity("angle", was.angle_rad, frame.text)
    elif isinstance(was, Drive) and was.until is None and frame.direction and frame.verb in ("", *GO):
        frame.verb = frame.verb or ("slide" if frame.direction in SIDES else "go")
        if was.distance_m:
            frame.q["length"] = quantity("length", was.distance_m, frame.text)
        if was.duration_s:
            frame.q["time"] = quantity("time", was.duration_s, frame.text)
        if was.speed_mps and not frame.pace and not {"speed", "percent", "fold", "faster"} & set(frame.q):
            frame.q["speed"] = quantity("speed", was.speed_mps, frame.text)
    else:
        raise Unclear("how_far", frame.text)


def _names_side(frame: Frame) -> bool:
    return bool(frame.rot) or frame.direction in SIDES
