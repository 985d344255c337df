"""Frames that mean a curve: an arc by any two of its measures, or a twist held for a time."""

from __future__ import annotations

import math

from chatrobot.language.frames import DIAGONALS, SIDES, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.tokens import quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, RawTwist, Step, Turn


def is_left(frame: Frame) -> bool | None:
    """The side a frame names; None where it names none."""
    side = frame.rot or frame.direction2 or (frame.direction if frame.direction in SIDES else "")
    if not side and frame.is_arc and frame.direction in DIAGONALS.values():
        side = frame.direction.split("_")[1]
    return None if not side else side == "left"


def about(frame: Frame, pace: Pace) -> list[Step]:
    """Turn around on the spot; as a half circle where a radius is said."""
    left = is_left(frame)
    if "radius" in frame.q and left is not None:
        return [Arc(frame.q["radius"].number, math.pi, left=left, speed_mps=pace.speed(frame))]
    said = frame.q.get("angle") or frame.q.get("turns")
    if frame.is_arc or "length" in frame.q or (said and abs(said.number - math.pi) > 1e-6):
        raise Unclear("unclear_motion", frame.text)
    rate = pace.rate(frame)
    if "time" in frame.q:
        rate = math.pi / frame.q["time"].number
    return [Turn(math.pi, left=left is not False, rate_radps=rate)]


def arc(frame: Frame, pace: Pace) -> list[Step]:
    left = is_left(frame)
    if left is None:
        raise Unclear("which_side", frame.text)
    if frame.verb in ("slide", "shift") or {"no_turn", "sideways"} & frame.flags:
        raise Unclear("contradiction", frame.text)  # along a curve, or without turning?
    backward = frame.direction.startswith("back")
    angle = frame.q.get("angle") or frame.q.get("turns")
    length, seconds = frame.q.get("length"), frame.q.get("time")
    speed, rate = frame.q.get("speed"), frame.q.get("rate")
    if rate and (speed or "while" in frame.flags) and seconds:
        signed = rate.number if left else -rate.number
        forward = speed.number if speed else pace.speed(frame) or pace.profile.defaults.speed_mps
        return [RawTwist(-forward if backward else forward, 0.0, signed, seconds.number)]
    radius = frame.q["radius"].number if "radius" in frame.q else None
    if radius is not None and length is not None:
        if angle is not None and abs(angle.number * radius - length.number) > 0.1 * length.number:
            raise Unclear("contradiction", frame.text)
        angle = quantity("angle", length.number / radius, length.text)
    elif radius is not None:
        pass
    elif length is not None and ("radius" in frame.roles or "diameter" in frame.roles):
        radius = length.number / (2 if "diameter" in frame.roles and "radius" not in frame.roles else 1)
    elif length is not None and angle is not None:
        radius = length.number / angle.number
    elif length is not None:
        radius = length.number / (math.pi / 2)
    if radius is None and seconds is not None:
        forward = pace.speed(frame) or pace.profile.defaults.speed_mps
        turned = angle.number / seconds.number if angle else pace.profile.defaults.rate_radps
        return [RawTwist(-forward if backward else forward, 0.0, turned if left else -turned, seconds.number)]
    if radius is None and {"again", "more"} & frame.flags:
        raise Unclear("which_size", frame.text)  # `the same arc`, where none was driven
    if radius is None:
        radius = pace.profile.defaults.distance_m
    sweep = angle.number if angle else math.pi / 2
    said = pace.speed(frame)
    if seconds is not None and said is None:
        said = radius * sweep / seconds.number
    turns_left = left != (
        backward and "while" in frame.flags
    )  # `back 1 m while turning left`: its heading does
    return [Arc(radius, sweep, left=turns_left, backward=backward, speed_mps=said)]
