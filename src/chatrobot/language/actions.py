"""One frame → the steps it means."""

from __future__ import annotations

from chatrobot.language.arcs import about, arc
from chatrobot.language.bearings import by_clock, by_compass
from chatrobot.language.driving import drive
from chatrobot.language.ellipsis import State, completed
from chatrobot.language.frames import GO, RETURNS, STILL, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.returning import goes_back, partly_back, turned_back, way_back
from chatrobot.language.slots import OUTLINES, check_all_used, check_extents
from chatrobot.language.turning import face, is_turn, turn
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Face, Step, Turn, Wait


def act(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """The steps of a frame; `state` is brought up to date.

    Raises:
        Unclear: where something needed is missing or impossible.
    """
    frame = completed(frame, state)
    check_extents(frame)
    _check_known(frame, state)
    if goes_back(frame, state):
        back = Frame(verb="return", pace=frame.pace, q=dict(frame.q))
        turned = [] if frame.verb else turned_back(state)
        return turned or way_back(back, state, pace)
    if "to_start" in frame.flags and frame.direction and "length" in frame.q:
        frame = frame.copy()
        frame.flags.discard("to_start")  # the way to it is told in full
    if "asked_distance" in frame.flags:
        return []  # only worked out; what is done with it comes after
    return _acted(frame, state, pace)


def _check_known(frame: Frame, state: State) -> None:
    """What a single motion cannot mean: measures of a drawn shape, a `there`, a condition."""
    side = "side" in frame.roles and "length" in frame.q and not frame.turning  # 这次边长半米: of what?
    if side or OUTLINES & set(frame.roles):
        raise Unclear("unknown_part", frame.text)
    turned = bool(state.steps) and isinstance(state.steps[-1], (Turn, Face)) and frame.has_extent
    told = frame.direction or frame.rot or "clock" in frame.q or turned  # `turn left, then 1 m that way`
    back = frame.direction == "back" and not frame.has_extent  # `go back there`: to some place
    if "there" in frame.flags and frame.verb not in STILL and (back or not told):
        raise Unclear("which_place", frame.text)
    if "overshot" in frame.flags and not (
        frame.q or frame.verb
    ):  # `too far left`: where it is, not where to go
        raise Unclear("unclear_motion", frame.text)
    if "until" in frame.flags and not frame.has_extent and frame.verb != "face":
        raise Unclear("condition", frame.text)


def _acted(frame: Frame, state: State, pace: Pace) -> list[Step]:
    if "heading" in frame.q:
        return by_compass(frame, state, pace)
    if "clock" in frame.q:
        return by_clock(frame, pace)
    if frame.verb in STILL:
        return _still(frame)
    if frame.verb == "return" and {"length", "angle", "turns"} & set(frame.q) and not frame.direction:
        return partly_back(frame, state, pace)
    told = bool(frame.direction) and "length" in frame.q
    to_start = "to_start" in frame.flags and frame.verb in (*GO, "", "uturn") and not told
    if RETURNS in frame.flags:
        back = way_back(Frame(verb="return", pace=frame.pace), state, pace)
        return [*back, *face(frame, state, pace)]
    if frame.verb == "return" or to_start:
        bare = frame.verb == "return" and not ({*frame.q} - {"times"} or frame.flags or frame.direction)
        return (turned_back(state) if bare and state.steps else []) or way_back(frame, state, pace)
    if frame.verb == "face" or "original_heading" in frame.flags:
        return face(frame, state, pace)
    if frame.verb == "uturn":
        return about(frame, pace)
    if frame.is_arc:
        return arc(frame, pace)
    if is_turn(frame, state):
        return turn(frame, state, pace)
    return drive(frame, state, pace)


def _still(frame: Frame) -> list[Step]:
    check_all_used(frame, "still")
    if "time" in frame.q:
        return [Wait(frame.q["time"].number)]
    if frame.verb == "halt":
        return []
    if "bit" in frame.flags or frame.text:
        return [Wait(1.0)]
    raise Unclear("how_long", frame.text)
