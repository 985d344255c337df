"""Directions told by the hours of a clock face or the points of the compass."""

from __future__ import annotations

import math

from chatrobot.language.driving import check_sideways, drive
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import GO, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Drive, Face, Step, Turn


def by_clock(frame: Frame, pace: Pace) -> list[Step]:
    """To an hour, twelve being ahead: a drive that way where a way to go is said, else a turn to it.

    Raises:
        Unclear: for no hour, or for twelve, which it faces already.
    """
    hour = frame.q["clock"].number
    if not 0 < hour <= 12:
        raise Unclear("bad_number", frame.q["clock"].text)
    angle = -hour * math.pi / 6
    angle = angle + 2 * math.pi if angle <= -math.pi - 1e-9 else angle
    if "length" in frame.q or "time" in frame.q or frame.verb in ("slide", "shift"):
        check_sideways("left", pace)
        length, seconds = frame.q.get("length"), frame.q.get("time")
        distance = length.number if length else None if seconds else pace.distance_m
        time_s = seconds.number if seconds and not length else None
        return [Drive(distance, duration_s=time_s, direction_rad=angle, speed_mps=pace.speed(frame))]
    if abs(angle) < 1e-9:
        raise Unclear("already_facing", frame.text)
    return [Turn(abs(angle), left=angle > 0, rate_radps=pace.rate(frame))]


def by_compass(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """To a point of the compass, facing it; going backward, away from what it faces.

    Raises:
        Unclear: where another direction is said beside it.
    """
    heading = frame.q["heading"].number
    plain = frame.copy()
    del plain.q["heading"]
    going = plain.has_extent or plain.verb in GO or plain.direction == "back"
    backward = going and plain.direction == "back"
    yaw = math.remainder(heading + (math.pi if backward else 0.0), 2 * math.pi)
    face = Face(yaw, frame="start", rate_radps=pace.rate(plain) if not going else None)
    if not going or {"angle", "turns"} & set(plain.q):
        if {"angle", "turns", "length"} & set(plain.q):
            raise Unclear("contradiction", frame.text)
        return [face]
    if plain.direction not in ("", "forward", "back") or "sideways" in plain.flags:
        raise Unclear("contradiction", frame.text)
    plain.verb = "go"
    plain.direction = plain.direction or "forward"
    return [face, *drive(plain, state, pace)]
