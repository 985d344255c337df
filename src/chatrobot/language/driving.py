"""Frames that mean a straight drive: which way, how far or how long, how fast."""

from __future__ import annotations

import math

from chatrobot.language.ellipsis import State
from chatrobot.language.frames import DIAGONALS, DIRECTIONS, GO, SIDES, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.slots import check_all_used
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Drive, Step


def drive(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """The straight drive a frame means; `state` is brought up to date.

    Raises:
        Unclear: where the way is missing or contradicts itself.
    """
    bearing = "bearing" in frame.flags and "angle" in frame.q
    check_all_used(frame, "heading" if bearing or frame.direction in DIAGONALS.values() else "drive")
    if bearing and frame.direction not in SIDES:
        raise Unclear("which_side", frame.text)
    direction = _way(frame, state)
    _check_said_enough(frame, state)
    check_sideways(direction, pace)
    state.last, state.direction = "drive", direction
    angle = DIRECTIONS[direction]
    if "angle" in frame.q and direction in DIAGONALS.values():
        angle = _heading_angle(direction, frame.q["angle"].number)
    if bearing:
        angle = math.copysign(frame.q["angle"].number, angle)
    return [_leg(frame, angle, state, pace)]


def _way(frame: Frame, state: State) -> str:
    """The direction that is said or goes without saying."""
    direction = frame.direction
    if "diagonal" in frame.flags and direction not in DIAGONALS.values():
        raise Unclear("which_diagonal", frame.text)
    aimed = any(text.endswith(("到", " to")) for text in frame.texts)
    if not direction and not frame.has_extent and aimed:
        raise Unclear("which_place", frame.text)
    if not direction and (frame.verb == "slide" or "sideways" in frame.flags):
        raise Unclear("which_side", frame.text)
    if not direction:
        if (frame.verb in GO and frame.verb != "shift") or "more" in frame.flags or not frame.verb:
            goes_on = state.last == "drive" and (not frame.verb or "more" in frame.flags)
            direction = state.direction if goes_on else "forward"
        elif frame.has_extent and frame.verb:
            direction = "forward"
    if not direction:
        raise Unclear("which_way", frame.text)
    if "sideways" in frame.flags and direction in ("forward", "back"):
        raise Unclear("contradiction", frame.text)
    return direction


def _check_said_enough(frame: Frame, state: State) -> None:
    """A lone amount or a lone word is a drive only where it goes on with one."""
    if not frame.has_extent and not frame.direction and frame.joined == "none":
        raise Unclear("which_way", frame.text)
    if not frame.moves and set(frame.q) == {"time"} and not _goes_on_for_a_time(state):
        raise Unclear("unclear_motion", frame.text)
    ellipsis = "again" in frame.flags or ("more" in frame.flags and state.last == "drive")
    if not frame.moves and not frame.has_extent and not ellipsis:
        raise Unclear("unclear_motion", frame.text)


def _goes_on_for_a_time(state: State) -> bool:
    """`2 s ahead, then 3 s`; but not `2 m ahead, then 10 s`: to wait, or to go on?"""
    if state.last != "drive":
        return False
    before = state.steps[-1] if state.steps else None
    return before.distance_m is None if isinstance(before, Drive) else state.length is None


def _leg(frame: Frame, angle: float, state: State, pace: Pace) -> Drive:
    """The drive at `angle` to the robot's front, radians, by what is said of length, time and speed."""
    goes_on = "more" in frame.flags and state.last == "drive"
    as_before = goes_on and frame.pace != "default"  # `another 50 cm at normal speed`
    speed = pace.speed(frame) or (pace.before_mps if as_before else None)
    length, seconds, said = frame.q.get("length"), frame.q.get("time"), frame.q.get("speed")
    if length is None and said is not None and said.role and seconds is None:
        return Drive(said.number, direction_rad=angle, speed_mps=speed)
    if length is not None:
        if seconds is not None and said is None:
            speed = length.number / seconds.number
        elif seconds is not None and said is not None:
            covered_m = said.number * seconds.number
            if abs(covered_m - length.number) > 0.1 * length.number:
                raise Unclear("contradiction", frame.text)
        return Drive(length.number, direction_rad=angle, speed_mps=speed)
    if seconds is not None:
        return Drive(duration_s=seconds.number, direction_rad=angle, speed_mps=speed)
    state.unsaid.append(frame)
    distance = pace.distance_m * (0.5 if "bit" in frame.flags else 1.0)
    return Drive(distance, direction_rad=angle, speed_mps=speed)


def _heading_angle(direction: str, angle: float) -> float:
    if not 0 < angle < math.pi / 2:
        raise Unclear("bad_number", f"{math.degrees(angle):g}°")
    front, side = direction.split("_")
    signed = angle if front == "forward" else math.pi - angle
    return signed if side == "left" else -signed


def check_sideways(direction: str, pace: Pace) -> None:
    """This robot can go that way without turning.

    Raises:
        Unclear: as a refusal, where it cannot.
    """
    if direction not in ("forward", "back") and not pace.profile.can_go_sideways:
        raise Unclear("cannot_go_sideways", direction, refused=True)
