"""Frames that mean the way back, all of it or some of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.driving import drive
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import DIRECTIONS, SIDES, Frame
from chatrobot.language.inverse import inverse
from chatrobot.language.leading import pose_after
from chatrobot.language.manner import Pace
from chatrobot.language.numbers import is_chinese
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import PACES
from chatrobot.plan.steps import Drive, Go, Step, Turn, Wait

_BETWEEN = frozenset({"glue", "filler"})
"""What may stand between `back` and the place: `back to the kitchen`."""
_AT_START_M = 1e-6


def back_to_places(atoms: Sequence[Atom]) -> list[Atom]:
    """`go back home`: `back` right before a place says where to, and not that it drives backwards."""
    return [
        Atom("glue", "x", atom.text) if _leads_to_a_place(atoms, i) or _introduces_a_place(atoms, i) else atom
        for i, atom in enumerate(atoms)
    ]


def _introduces_a_place(atoms: Sequence[Atom], i: int) -> bool:
    """`go to waypoint oak`, `to the spot we called oak`: what the name stands for."""
    words = _kinds_of_places()
    end = i
    while end < len(atoms) and (atoms[end].text in words or atoms[end].kind in _BETWEEN):
        end += 1
    return atoms[i].text in words and end < len(atoms) and atoms[end].kind == "place"


@cache
def _kinds_of_places() -> frozenset[str]:
    tables = (load_table(code, "dialogue_forms").get("kinds_of_places", ()) for code in LANGUAGES)
    return frozenset(word for words in tables for word in words)


def _leads_to_a_place(atoms: Sequence[Atom], i: int) -> bool:
    if (atoms[i].kind, atoms[i].value) != ("dir", "back") or atoms[i].text.split()[-1:] != ["back"]:
        return False
    following = next((atom for atom in atoms[i + 1 :] if atom.kind not in _BETWEEN), None)
    return following is not None and following.kind == "place"


def goes_back(frame: Frame, state: State) -> bool:
    """`…, then back`: the way back, where there is a way to go back."""
    if state.last == "drive" and state.direction == "back":
        return False  # `back! back!`: on, and not to where it was
    sideways = bool(state.steps) and state.last == "drive" and state.direction in SIDES
    verbs = ("", "go", "slide", "shift") if sideways else ("", "go")
    bare = frame.verb in verbs and frame.direction == "back" and "bit" not in frame.flags
    amounts = [amount.text for amount in frame.q.values()]
    said = [text for text in frame.texts if text not in amounts]
    return bare and frame.q.keys() <= PACES and bool(state.steps) and "back" in said[-1 - bool(frame.pace) :]


def way_back(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """To where it all began: drives alone are undone one by one, after turns it goes straight there.

    Raises:
        Unclear: where more is said than a way back can have.
    """
    if set(frame.q) & {"length", "time"} and state.last == "drive" and not frame.direction:
        return _some_way_back(frame, state, pace)
    if set(frame.q) - PACES:
        raise Unclear("unclear_motion", frame.text)
    if "bit" in frame.flags and not is_chinese(frame.text):
        raise Unclear("how_far", frame.text)  # `…, then come back a little`
    speed = pace.speed(frame)
    drives: list[Step] = [step for step in _since_back(state.steps) if not isinstance(step, Wait)]
    straight = bool(drives) and all(isinstance(step, Drive) and step.until is None for step in drives)
    ahead = straight and all(isinstance(step, Drive) and step.direction_rad == 0.0 for step in drives)
    if frame.direction and not (frame.direction == "back" and "to_start" in frame.flags and ahead):
        raise Unclear("unclear_motion", frame.text)
    if (frame.has_extent and frame.verb != "return") or ("sideways" in frame.flags and ahead):
        raise Unclear("unclear_motion", frame.text)
    if "same_way" in frame.flags:
        return inverse(state.steps, speed)
    if straight and not _are_back(drives):
        return inverse(list(drives), speed)
    about = _has_turned_about(state) and all(isinstance(step, Turn) for step in drives)
    if state.home is not None and (about or not drives):
        return [Go(state.home.x_m, state.home.y_m, frame="odom", speed_mps=speed)]
    return [Go(0.0, 0.0, frame="start", speed_mps=speed)]


def _are_back(steps: Sequence[Step]) -> bool:
    """`40 cm right, 40 cm left, and you are back where you began`: whether drives lead to where they began."""
    end = pose_after(steps, ORIGIN)
    return end is not None and end.distance_to(ORIGIN) < _AT_START_M


def partly_back(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """退回来二十厘米: against the last motion, by so much.

    Raises:
        Unclear: for an angle where the last motion was no turn.
    """
    if "length" in frame.q:
        angle = DIRECTIONS[state.direction] if state.last == "drive" else 0.0
        if not is_chinese(frame.text):  # 退 is backwards, whichever way it looks
            about, aside = _has_turned_about(state), state.last == "drive" and state.direction in SIDES
            if (about or aside) and frame.text.startswith(("and back", "now back", "back")):
                raise Unclear("which_way", frame.text)
            angle = math.pi if about else angle
        opposite = math.remainder(angle + math.pi, 2 * math.pi)
        return [Drive(frame.q["length"].number, direction_rad=opposite, speed_mps=pace.speed(frame))]
    if state.left is None or state.last != "turn":
        raise Unclear("which_side", frame.text)
    amount = frame.q.get("angle") or frame.q["turns"]
    return [Turn(amount.number, left=not state.left, rate_radps=pace.rate(frame))]


def turned_back(state: State) -> list[Step]:
    """`turn left 10 degrees and back`: the turns undone where nothing else was done, half turns apart; else none."""
    turned = [step for step in _since_back(state.steps) if not isinstance(step, Wait)]
    return inverse(turned) if all(map(_turns_aside, turned)) else []


def _since_back(steps: Sequence[Step]) -> list[Step]:
    """What was done since it last stood as in the beginning: after `right 40 degrees and back, left 20`, the last."""
    ends = (pose_after(steps[:k], ORIGIN) for k in range(len(steps) - 1, 0, -1))
    back = (end is not None and _is_origin(end) for end in ends)
    k = next((len(steps) - 1 - i for i, is_back in enumerate(back) if is_back), 0)
    return list(steps[k:])


def _is_origin(pose: Pose) -> bool:
    return pose.distance_to(ORIGIN) < _AT_START_M and abs(math.remainder(pose.yaw_rad, 2 * math.pi)) < 1e-6


def _turns_aside(step: Step) -> bool:
    return isinstance(step, Turn) and bool(step.angle_rad) and not _is_about(step)


def _has_turned_about(state: State) -> bool:
    """`do a 180 and come back 50 cm`: the way back lies ahead now."""
    return bool(state.steps) and _is_about(state.steps[-1])


def _is_about(step: Step) -> bool:
    if not isinstance(step, Turn) or step.angle_rad is None:
        return False
    return abs(math.remainder(step.angle_rad - math.pi, 2 * math.pi)) < 1e-6


def _some_way_back(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """`…, then come back 50 cm`: so much of the last drive, undone."""
    opposite = math.remainder(DIRECTIONS[state.direction] + math.pi, 2 * math.pi)
    names = [n for n, a in DIRECTIONS.items() if abs(math.remainder(a - opposite, 2 * math.pi)) < 1e-6]
    back = frame.copy()
    back.verb, back.direction = "go", names[0]
    back.flags -= {"to_start", "again"}
    return drive(back, state, pace)
