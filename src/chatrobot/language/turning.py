"""Frames that mean a turn on the spot, by an angle or to a heading."""

from __future__ import annotations

import math

from chatrobot.language.arcs import is_left
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import DIAGONALS, DIRECTIONS, GO, SIDES, TURN, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.numbers import is_chinese
from chatrobot.language.slots import check_all_used
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Face, Step, Turn


def is_turn(frame: Frame, state: State) -> bool:
    """Whether a frame means a turn on the spot, which `left` alone does not tell."""
    if frame.verb in TURN or (frame.rot and frame.verb not in GO):
        return True
    if frame.rot and {"in_place", "around"} & frame.flags and "length" not in frame.q:
        return True
    if "bearing" in frame.flags and {"length", "time"} & set(frame.q) and "angle" in frame.q:
        return False
    if "angle" in frame.q or "turns" in frame.q:
        return frame.direction not in DIAGONALS.values() and "diagonal" not in frame.flags
    if "rate" in frame.q:
        return True
    if frame.verb in ("slide", "shift") or "sideways" in frame.flags or "no_turn" in frame.flags:
        return False
    if frame.direction in SIDES and "length" not in frame.q and "diagonal" not in frame.flags:
        return not (frame.verb in GO and "time" in frame.q)
    return not frame.moves and frame.has_extent and "time" in frame.q and state.last == "turn"


def turn(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """The turn on the spot that a frame means; `state` is brought up to date.

    Raises:
        Unclear: where the side is missing, or a length is said with it.
    """
    if "length" in frame.q or "speed" in frame.q:
        raise Unclear("length_for_turn", frame.text)
    if "from_heading" in frame.flags:
        return [_from_heading(frame, state, pace)]
    check_all_used(frame, "turn")
    goes_on = "more" in frame.flags and state.last == "turn"
    rate, seconds = pace.rate(frame) or (pace.before_radps if goes_on else None), frame.q.get("time")
    around = "around" in frame.flags and seconds is None
    angle_rad = _said_angle_rad(frame, around)
    left = _side(frame, state, around)
    if left is None and rate is not None and rate > pace.profile.limits.max_rate_radps:
        left = True  # too fast to either side: the rehearsal says so
    if left is None:
        if angle_rad is None or not _same_either_way(angle_rad):
            raise Unclear("which_side", frame.text)
        left = True
    state.last, state.left = "turn", left
    if angle_rad is None and seconds is not None:
        return [Turn(duration_s=seconds.number, left=left, rate_radps=rate)]
    if angle_rad is None and "rate" in frame.q and frame.q["rate"].role:
        angle_rad = frame.q["rate"].number
    if angle_rad is None:
        angle_rad = pace.turn_rad * (0.5 if "bit" in frame.flags else 1.0)
    if seconds is not None:
        rate = angle_rad / seconds.number
    return [Turn(angle_rad, left=left, rate_radps=rate)]


def _side(frame: Frame, state: State, around: bool) -> bool | None:
    """Whether it is to the left, as said here or before; None where nothing says so."""
    left = is_left(frame)
    goes_on = "more" in frame.flags or ("bit" in frame.flags and frame.joined == "then")  # 再转一点
    if left is None and (not frame.moves or (state.last == "turn" and goes_on)):
        left = state.left
    return True if left is None and around else left


def _said_angle_rad(frame: Frame, around: bool) -> float | None:
    """The angle that is said; a full turn where turning itself is what is counted."""
    angle = _whole_angle(frame)
    if angle is not None:
        return angle.number
    whole = frame.verb == "spin" or (frame.verb == "turn" and ("in_place" in frame.flags or bool(frame.rot)))
    counted = "times" in frame.q or (around and frame.verb == "spin")
    return 2 * math.pi if whole and counted else None


def _from_heading(frame: Frame, state: State, pace: Pace) -> Face:
    """从最开始的方向算，左转四十度: the heading to have, not how far to turn."""
    plain = frame.copy()
    plain.flags.discard("from_heading")
    check_all_used(plain, "turn")
    angle, left = _whole_angle(plain), is_left(plain)
    if angle is None or left is None or set(plain.q) - {"angle", "turns", "rate"}:
        raise Unclear("unclear_motion", frame.text)
    yaw = angle.number if left else -angle.number
    state.last = "turn"
    if state.home is None:
        return Face(math.remainder(yaw, 2 * math.pi), frame="start", rate_radps=pace.rate(plain))
    yaw += state.home.yaw_rad
    return Face(math.remainder(yaw, 2 * math.pi), frame="odom", rate_radps=pace.rate(plain))


def _whole_angle(frame: Frame) -> Atom | None:
    """`One turn and 90 degrees` is their sum; `one turn, 360 degrees` says it twice."""
    angle, turns = frame.q.get("angle"), frame.q.get("turns")
    if angle is None or turns is None or not is_chinese(turns.text):
        return angle or turns
    if abs(angle.number - turns.number) < 1e-6:
        return angle
    if angle.number >= 2 * math.pi or turns.number < 2 * math.pi:
        raise Unclear("contradiction", f"{turns.text} {angle.text}")
    return quantity("angle", turns.number + angle.number, f"{turns.text} {angle.text}")


def _same_either_way(angle_rad: float) -> bool:
    half_turns = angle_rad / math.pi
    return half_turns >= 1 and abs(half_turns - round(half_turns)) < 1e-6


def face(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """To look to a side, or the way it looked at the start.

    Raises:
        Unclear: where neither is said.
    """
    if set(frame.q) - {"angle", "turns", "rate", "percent", "faster"}:
        raise Unclear("unclear_motion", frame.text)
    if ("original_heading" in frame.flags or "to_start" in frame.flags) and not frame.has_extent:
        if state.home is not None and not state.steps:
            return [Face(state.home.yaw_rad, frame="odom", rate_radps=pace.rate(frame))]
        return [Face(0.0, frame="start", rate_radps=pace.rate(frame))]
    if frame.direction in SIDES:
        angle = frame.q.get("angle") or frame.q.get("turns")
        usual = pace.turn_rad * (0.5 if {"bit", "more"} & frame.flags else 1)
        return [
            Turn(
                angle.number if angle else usual, left=frame.direction == "left", rate_radps=pace.rate(frame)
            )
        ]
    if frame.direction == "back":
        return [Turn(math.pi, rate_radps=pace.rate(frame))]
    if frame.direction in DIAGONALS.values():
        angle_rad = DIRECTIONS[frame.direction]
        return [Turn(abs(angle_rad), left=angle_rad > 0, rate_radps=pace.rate(frame))]
    raise Unclear("which_side", frame.text)
