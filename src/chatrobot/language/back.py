"""The way back: from one motion that is the last (`then slide back`, `and back`), or to the start."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from chatrobot.core.geometry import wrap_angle
from chatrobot.language.changes import a_bit_of
from chatrobot.language.context import Context
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.frames import DIRECTIONS, GO, SIDES, Frame
from chatrobot.language.inverse import inverse, is_sideways
from chatrobot.language.last_motion import driven_steps
from chatrobot.language.leading import pose_after
from chatrobot.language.manner import Pace
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import FAR_RAD, NEAR_M, PACES
from chatrobot.plan.steps import Arc, Drive, Go, Step, Turn, Wait

_NEAR_SHARE = 0.05
"""A way that is told in full may miss the start by so much of it."""


def slid_back(whole: Frame, context: Context, pace: Pace) -> list[Step] | None:
    """`Then slide back`, `a bit further left`, after a slide: no turn.

    Raises:
        Unclear: `a bit back`, after a turn, and `left again`, after a drive ahead: is it to drive or to turn?
    """
    last = context.dialogue.last_motion
    step = last.plan.steps[-1] if last is not None and last.plan is not None else None
    if (whole.verb, whole.rot, whole.pace, whole.q) == ("", "", "", {}) and (
        (isinstance(step, Turn) and (whole.direction, whole.flags) == ("back", {"bit"}))
        or (isinstance(step, Drive) and not is_sideways(step) and _says_again_to_a_side(whole))
    ):
        raise Unclear("which_way", whole.text)
    slid = [*map(is_sideways, driven_steps(last))] == [True]
    if not slid or whole.q:
        return None
    if (whole.verb, whole.direction) == ("slide", "back") and not whole.flags:
        return retraced(context, pace.speed(whole))
    a_bit = whole.flags in ({"bit"}, {"bit", "more"}) and whole.verb in ("", "go", "shift") and not whole.rot
    if not a_bit or whole.direction not in SIDES:
        return None
    bit = a_bit_of(context.dialogue, whole, pace)
    return [replace(bit, direction_rad=DIRECTIONS[whole.direction])] if isinstance(bit, Drive) else None


def _says_again_to_a_side(whole: Frame) -> bool:
    """`Left again`, not `the same to the left`."""
    words = {word for code in LANGUAGES for word in load_table(code, "selections").get("once_again", ())}
    return whole.direction in SIDES and whole.flags == {"again"} and bool(words & {*whole.texts})


def driven_back(whole: Frame, context: Context, pace: Pace) -> list[Step] | None:
    """`And back`, after one drive straight ahead, or to a place: as far as that, or where it came from."""
    last = context.dialogue.last_motion
    steps = driven_steps(last)
    step = steps[0] if len(steps) == 1 else None
    more = set(whole.q) - PACES or whole.flags or whole.rot or whole.shape
    bare = whole.direction == "back" and not more
    if context.dialogue.usual.distance_m is not None:
        return None  # a person set how far that is
    if not bare or whole.verb not in ("", *GO) or last is None:
        return None
    if whole.place:  # `back to the mesa, just reverse`, where it came from there
        place = context.dialogue.places.get(whole.place)
        if place is None or isinstance(step, Go) or place.pose.distance_to(last.start_pose) > NEAR_M:
            return None
    if isinstance(step, Go):
        return [replace(Go.to_pose(last.start_pose), yaw_rad=None, speed_mps=pace.speed(whole))]
    ahead = isinstance(step, Drive) and step.direction_rad == 0.0 and step.until is None and step.distance_m
    is_way = ahead or (isinstance(step, Arc) and not step.backward)
    return inverse([step], pace.speed(whole)) if step is not None and is_way else None


def retraced(context: Context, speed_mps: float | None) -> list[Step]:
    """What was driven last, the way back."""
    return inverse(list(driven_steps(context.dialogue.last_motion)), speed_mps)


def only_turned(context: Context) -> bool:
    """Whether the last motion turned on the spot where it all began: there `and back` is a turn."""
    steps = driven_steps(context.dialogue.last_motion)
    turned = all(isinstance(step, (Turn, Wait)) for step in steps)
    return bool(steps) and turned and context.state.pose.distance_to(context.dialogue.start_pose) <= NEAR_M


def only_slid(context: Context) -> bool:
    """Whether the last motion slid sideways from where it all began: the way back is a slide as well, and no turn."""
    last, start = context.dialogue.last_motion, context.dialogue.start_pose
    steps = driven_steps(last)
    if last is None or len(steps) != 1 or not is_sideways(steps[0]):
        return False
    off_rad = wrap_angle(last.start_pose.yaw_rad - start.yaw_rad)
    return last.start_pose.distance_to(start) <= NEAR_M and abs(off_rad) <= FAR_RAD / 4


def part_way_back(whole: Frame, context: Context, pace: Pace) -> list[Step] | None:
    """`Half of the way home`: that part of the straight way to the start, which lies ahead or behind; else None.

    Raises:
        Unclear: it lies to a side, or the last motion did not begin at the start, and either may be meant.
    """
    part, dialogue = whole.q.get("number"), context.dialogue
    if part is None or not 0.0 < part.number < 1.0 or "to_start" not in whole.flags or len(whole.q) > 1:
        return None
    last, (way_m, off_rad) = dialogue.last_motion, _way_to_start(context)
    if last is not None and last.start_pose.distance_to(last.end_pose) > NEAR_M:
        way_m = way_m if last.start_pose.distance_to(dialogue.start_pose) <= NEAR_M else 0.0
    is_behind = abs(off_rad) > math.pi / 2
    if way_m <= NEAR_M or min(abs(off_rad), math.pi - abs(off_rad)) > FAR_RAD / 4:
        raise Unclear("how_far", whole.text)
    return [
        Drive(part.number * way_m, direction_rad=math.pi if is_behind else 0.0, speed_mps=pace.speed(whole))
    ]


def straight_to_start(whole: Frame, context: Context, pace: Pace) -> list[Step] | None:
    """`Reverse to the start`, `slide back to the start`: that way all the way; None where it only says `back`.

    None while it moves, too: how far it is then is known once it stands.

    Raises:
        Unclear: it is to slide or to reverse there, and the start lies elsewhere.
    """
    says_only_back = any(text.split()[-1:] == ["back"] for text in whole.texts)
    way_m, off_rad = _way_to_start(context)
    if way_m <= NEAR_M or context.state.moving:
        return None
    if "sideways" in whole.flags:
        if abs(abs(off_rad) - math.pi / 2) > FAR_RAD / 4:
            raise Unclear("which_side", whole.text)
        return [Drive(way_m, direction_rad=math.copysign(math.pi / 2, off_rad), speed_mps=pace.speed(whole))]
    reverses = whole.direction == "back" and not says_only_back
    is_behind = math.pi - abs(off_rad) <= FAR_RAD / 4
    if reverses and not is_behind:
        raise Unclear("which_way", whole.text)
    if not is_behind or not (reverses or "backing" in whole.flags):
        return None
    return [Drive(way_m, direction_rad=math.pi, speed_mps=pace.speed(whole))]


def _way_to_start(context: Context) -> tuple[float, float]:
    """How far the start is, metres, and where it lies from the robot's front, radians."""
    pose, start = context.state.pose, context.dialogue.start_pose
    return pose.distance_to(start), wrap_angle(pose.bearing_to(start) - pose.yaw_rad)


def check_leads_to_start(last: Frame, steps: Sequence[Step], context: Context) -> None:
    """`Two metres back to the start`, told in full: it must end there, where it begins or where all began.

    Raises:
        Unclear: it ends elsewhere.
    """
    if "to_start" not in last.flags or "length" not in last.q or not steps or isinstance(steps[-1], Go):
        return
    pose = context.state.pose
    end = pose_after(steps, pose)
    near_m = NEAR_M + _NEAR_SHARE * last.q["length"].number
    if end is not None and min(map(end.distance_to, (pose, context.dialogue.start_pose))) > near_m:
        raise Unclear("contradiction", last.text)


def goes_back_and_again(frames: Sequence[Frame]) -> bool:
    """`Go back and do it again`: the way back first."""
    if len(frames) != 2 or frames[1].flags != {"again"} or frames[1].moves or frames[1].q:
        return False
    back = frames[0]
    return not (back.q.keys() - PACES or back.flags - {"to_start"}) and (
        back.verb == "return" or (back.verb == "go" and back.direction == "back")
    )


def goes_to_start(whole: Frame) -> bool:
    """Whether the whole of it is a way back to where it began."""
    reverses = whole.direction == "back" or "backing" in whole.flags
    paced = whole.q.keys() <= PACES if reverses else not whole.q
    return (whole.verb == "return" or "to_start" in whole.flags) and paced and not whole.place


def names_its_own(whole: Frame) -> bool:
    """Whether a motion of its own comes before the way back: `1 m forward, then back to the start`, `return left`."""
    if whole.has_extent and {"original_heading", "to_start"} & whole.flags:
        return True
    return goes_to_start(whole) and whole.direction not in ("", "back")
