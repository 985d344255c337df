"""What refers to earlier turns: again, the other way, half of that, undo, back, places, a total."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from chatrobot.core.geometry import wrap_angle
from chatrobot.language.back import (
    driven_back,
    goes_back_and_again,
    goes_to_start,
    names_its_own,
    only_slid,
    only_turned,
    part_way_back,
    retraced,
    slid_back,
    straight_to_start,
)
from chatrobot.language.changes import a_bit_of, changed, is_change, steps_named
from chatrobot.language.context import Context, Dialogue
from chatrobot.language.data_files import load_table
from chatrobot.language.edits import mirrored
from chatrobot.language.frames import GO, SIDES, Frame
from chatrobot.language.inverse import flipped
from chatrobot.language.last_motion import check_answers_nothing, motion_meant, shapes_said, steps_of
from chatrobot.language.manner import Pace
from chatrobot.language.meant import is_correction
from chatrobot.language.measures import whole_number
from chatrobot.language.numbers import is_chinese
from chatrobot.language.repeats import repeats_all
from chatrobot.language.totals import back_as_far_in_all, to_total
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import FAR_RAD, PACES, Walked, all_taken_back, last_two, redone, undone
from chatrobot.plan.steps import Arc, Drive, Face, Go, Step, Turn
from chatrobot.robots.profile import RobotProfile

_ONE_MORE = frozenset({"again", "more", "extra", "same_amount"})
_COUNTED = frozenset({"both", "two", "three", "four", "five", "six", "2", "3", "4", "5", "6"})
"""What counts the turns that are meant."""


def refer(frames: Sequence[Frame], context: Context, pace: Pace) -> list[Step] | None:
    """The steps of an utterance that refers to an earlier one; None where it does not.

    Raises:
        Unclear: where there is nothing to refer to.
    """
    if _goes_on_the_same_way(frames, context.dialogue):
        return None
    check_answers_nothing(frames, context.dialogue)
    if context.dialogue.last_motion is not None:
        frames = _without_outcome(frames)
        if goes_back_and_again(frames):
            back = refer(frames[:1], context, pace)
            if back is None:
                raise Unclear("unclear_motion", " ".join(frame.text for frame in frames))
            return [*back, *steps_of(context.dialogue.last_motion)]
    whole = _whole(frames)
    if whole is None:
        return None
    if "short_of" in whole.flags:
        return to_total(whole, context, pace)
    start = part_way_back(whole, context, pace) or _to_the_start(whole, frames, context, pace)
    if start is not None or names_its_own(whole):
        return start
    more = (
        back_as_far_in_all(whole, context, pace)
        or slid_back(whole, context, pace)
        or driven_back(whole, context, pace)
    )
    more = more or _more_of_before(whole, context, pace)
    if more is not None:
        return more
    alike = _of_the_same_shape(whole, context)
    if alike is not None:
        return alike
    if "again" in whole.flags:
        _check_not_counted(whole, frames)
    if {"again", "more"} <= whole.flags and any("another" in frame.texts for frame in frames):
        raise Unclear("unclear_motion", whole.text)  # `again, another 20 cm`: so much more, or only so much?
    if _is_another_kind(whole, context) or not is_change(whole):
        return None
    return _changed(whole, context, pace)


def _to_the_start(whole: Frame, frames: Sequence[Frame], context: Context, pace: Pace) -> list[Step] | None:
    """The way back to where it began or looked; None where that is not wanted, or other motions come first.

    Raises:
        Unclear: where only a part of the way may be meant, or either of the two.
    """
    start, flags = context.dialogue.start_pose, whole.flags
    if "original_heading" in flags:
        return _faced_as_before(whole, context, pace)
    if whole.verb == "face" and "to_start" in flags:
        raise Unclear("unclear_motion", whole.text)  # to drive there or to look there?
    if not goes_to_start(whole) or (whole.direction and whole.direction != "back"):
        return None
    _check_not_counted(whole, frames)
    if {"bit", "halfway"} & flags and not is_chinese(whole.text):
        raise Unclear("how_far", whole.text)  # `come back a little`: not all the way
    if ("to_start" not in flags and only_turned(context)) or only_slid(context):
        return retraced(context, pace.speed(whole))
    go = Go(start.x_m, start.y_m, frame="odom", speed_mps=pace.speed(whole))
    return straight_to_start(whole, context, pace) or [go]


def _faced_as_before(whole: Frame, context: Context, pace: Pace) -> list[Step] | None:
    """The heading of before, and the place where it says so; None for what is told in full.

    Raises:
        Unclear: `turn back home`: to look there, or to drive there? 转回来一半: not all the way.
    """
    start = context.dialogue.start_pose
    if "to_start" in whole.flags or whole.verb == "return":
        return [Go(start.x_m, start.y_m, start.yaw_rad, frame="odom", speed_mps=pace.speed(whole))]
    if whole.has_extent:
        return None
    if whole.place:
        raise Unclear("unclear_motion", " ".join(dict.fromkeys(whole.texts)))
    if whole.verb not in ("face", "turn", "", "go"):
        return None
    if set(whole.q) - {"rate", "percent", "faster"}:
        raise Unclear("unclear_motion", whole.text)
    return [Face(_heading_before(whole, context.dialogue), frame="odom", rate_radps=pace.rate(whole))]


def _changed(whole: Frame, context: Context, pace: Pace) -> list[Step]:
    """The last motion as `whole` wants it now.

    Raises:
        Unclear: where it is not clear what was done, or what was meant.
    """
    last = motion_meant(context.dialogue)
    only_again = whole.flags == {"again"} and not (whole.q or whole.moves or whole.pace)
    undo_again = last is not context.dialogue.last_motion and only_again and context.dialogue.ledger.done
    parts = repeats_all(whole) and "again" in whole.flags and _is_one_of_several(context.dialogue)
    if is_correction(last) or undo_again or parts:
        raise Unclear("unclear_motion", whole.text)
    return changed(steps_named(whole, context.dialogue), whole, pace)


def _without_outcome(frames: Sequence[Frame]) -> Sequence[Frame]:
    """`That three more times, a square`, 再来三遍，走成正方形: the frames without the shape that comes of it."""
    if len(frames) != 2 or frames[1].joined in ("and", "then") or not frames[1].shape or frames[1].q:
        return frames
    again = "again" in frames[0].flags and "times" in frames[0].q and not frames[0].moves
    return frames[:1] if again and not any("this" in text.split() for text in frames[0].texts) else frames


def _heading_before(whole: Frame, dialogue: Dialogue) -> float:
    """The heading of the start, or the one before the last turn where that is asked for: `your previous heading`.

    Raises:
        Unclear: `turn back` may mean either.
    """
    start_rad, table = dialogue.start_pose.yaw_rad, load_table("en", "facing")
    said = {word for text in whole.texts for word in text.split()}
    off = (
        (t.start_pose.yaw_rad, wrap_angle(t.end_pose.yaw_rad - t.start_pose.yaw_rad)) for t in dialogue.turns
    )
    before_rad = next((yaw for yaw, by in reversed([*off]) if abs(by) > FAR_RAD / 4), start_rad)
    if is_chinese(whole.text) or said & set(table["of_the_start"]):
        return start_rad
    if said & set(table["of_before"]) or abs(wrap_angle(before_rad - start_rad)) < FAR_RAD / 4:
        return before_rad
    raise Unclear("unclear_motion", " ".join(dict.fromkeys(whole.texts)))


def _check_not_counted(whole: Frame, frames: Sequence[Frame]) -> None:
    """`Back by both`, `all four again, faster`: more turns than the last one, and nobody reads which.

    Raises:
        Unclear: naming them.
    """
    counted = (text for frame in frames for text in frame.texts if text.split()[-1] in _COUNTED)
    said = next(counted, "") if {"all", "both"} & whole.flags else ""
    said = said or (whole.text if "all" in whole.flags and whole.direction else "")
    if said:
        raise Unclear("unclear_motion", said)


def _is_another_kind(whole: Frame, context: Context) -> bool:
    """`Again 50 cm forward`, after a turn: a motion of its own, told in full."""
    last = context.dialogue.last_motion
    turned = last is not None and last.plan is not None and all(isinstance(s, Turn) for s in last.plan.steps)
    told = "length" in whole.q and whole.direction in ("forward", "back") and not whole.rot
    return turned and told and "again" in whole.flags and not {"other_way", "more"} & whole.flags


def _is_one_of_several(dialogue: Dialogue) -> bool:
    """Whether `the whole thing again` may mean more than the last motion, which was one of several."""
    plans = [turn.plan for turn in dialogue.turns if turn.plan is not None]
    return len(plans) > 1 and len(plans[-1].steps) == 1 and isinstance(plans[-1].steps[0], (Drive, Turn))


def walked(frames: Sequence[Frame], context: Context, pace: Pace) -> Walked | None:
    """What an utterance does that undoes earlier turns, or does again what was undone; None where it does neither.

    Raises:
        Unclear: where there is nothing to undo, or nobody knows the way any more.
    """
    if any(_goes_on(frame) for frame in frames):
        return None
    if len(frames) == 2 and frames[0].verb == "undo" and frames[1].verb == "return" and not frames[1].q:
        frames = frames[:1]
    whole = _whole(frames)
    found = _walked(whole, frames, context, pace.profile) if whole is not None else None
    return found.at_pace(whole, pace) if whole is not None and found is not None else None


def _walked(whole: Frame, frames: Sequence[Frame], context: Context, profile: RobotProfile) -> Walked | None:
    if whole.verb == "undo" and "same_way" in whole.flags:
        return all_taken_back(context, profile)
    if whole.verb == "undo":
        last, named = context.dialogue.last_motion, {each.verb for each in frames[1:]}
        if whole.shape and last is not None and whole.shape not in shapes_said(last.text):
            raise Unclear("nothing_before", whole.text)  # `undo the square`, after a circle
        kind = Turn if "turn" in named else Drive if named & GO else None
        return undone(whole, context, profile, kind=kind)
    if {"redo", "restore"} & whole.flags:
        again = redone(context, profile)
        if again and (whole.moves or set(whole.q) - PACES):
            raise Unclear("unclear_motion", whole.text)  # `redo that twice`: what was undone, or the undo?
        changes = whole.moves or whole.pace or whole.q
        if again is None and ("restore" in whole.flags or not changes):
            raise Unclear("nothing_undone")  # `redo that slower` still repeats the last motion
        return again
    back = whole.direction == "back" or (not whole.direction and whole.verb in ("return", "", "go", "uturn"))
    if "same_way" not in whole.flags or not back or whole.shape or {"again", "mirrored"} & whole.flags:
        return None
    return replace(all_taken_back(context, profile), walk=None)  # a way back, and a turn of its own


def _more_of_before(whole: Frame, context: Context, pace: Pace) -> list[Step] | None:
    """`a bit more`; `both again`: the last two turns."""
    both = "both" in whole.flags or any("both" in text.split() for text in whole.texts)
    if "again" in whole.flags and both and not whole.moves and whole.q.keys() <= {"times"}:
        count = whole_number(whole.q["times"].number, whole.q["times"].text) if whole.q else 1
        return last_two(context, whole.text, steps="both" in whole.flags) * count
    further = _further_round(whole, context)
    if further is not None or whole.moves or whole.q:
        return further
    on = "more" in whole.flags or any(text.endswith(("more", "further", "farther")) for text in whole.texts)
    alone = whole.flags == {"more"} and whole.texts == ["more"]  # `further` is a way of its own
    if on and ("bit" in whole.flags or alone) and whole.flags <= {"bit", "more"} and not whole.roles:
        return [a_bit_of(context.dialogue, whole, pace)]
    return None


def _of_the_same_shape(whole: Frame, context: Context) -> list[Step] | None:
    """`Another half circle to the right`, `the same arc`: as large as the one before, which was the whole motion."""
    last = context.dialogue.last_motion
    if last is None or last.plan is None or whole.q or whole.place or is_correction(last):
        return None
    if not _ONE_MORE & whole.flags or whole.flags - _ONE_MORE - {"other_way", "mirrored", "instead"}:
        return None
    steps, side = list(last.plan.steps), whole.rot or whole.direction
    if not (whole.shape in shapes_said(last.text) if whole.shape else _is_curve(whole, steps)):
        return None
    if side:
        return mirrored(steps, side == "left") if side in SIDES else None
    return [flipped(step) for step in steps] if "other_way" in whole.flags else steps


def _is_curve(whole: Frame, steps: Sequence[Step]) -> bool:
    return whole.verb == "curve" and len(steps) == 1 and isinstance(steps[0], Arc)


def _further_round(whole: Frame, context: Context) -> list[Step] | None:
    """`Another 90 degrees`, after a curve: on along it."""
    last, angle = context.dialogue.last_motion, whole.q.get("angle") or whole.q.get("turns")
    step = last.plan.steps[-1] if last is not None and last.plan is not None else None
    goes_on = (
        whole.flags == {"more"} and len(whole.q) == 1 and not (whole.rot or whole.direction or whole.shape)
    )
    if not isinstance(step, Arc) or angle is None or not goes_on or whole.verb not in ("", *GO):
        return None
    return [replace(step, angle_rad=angle.number)]


def _goes_on_the_same_way(frames: Sequence[Frame], dialogue: Dialogue) -> bool:
    """`another 45 the same way`: on, not back; the flag has then done its work.

    Raises:
        Unclear: where nothing has moved.
    """
    on = [frame for frame in frames if _goes_on(frame)]
    last = dialogue.last_motion
    if on and on[0] is frames[0] and last is None:
        raise Unclear("nothing_before", on[0].text)
    step = last.plan.steps[-1] if last is not None and last.plan is not None and last.plan.steps else None
    for frame in on:
        frame.flags.discard("same_way")
        if frame is frames[0] and isinstance(step, Drive) and not frame.rot:
            frame.flags.add("more")  # `2 m that way`, after it went back
    return bool(on)


def _goes_on(frame: Frame) -> bool:
    amount = frame.has_extent or "number" in frame.q or {"more", "bit"} & frame.flags
    return bool("same_way" in frame.flags and amount and frame.verb != "return" and not frame.direction)


def _whole(frames: Sequence[Frame]) -> Frame | None:
    """All frames as one bag, if they are fragments of one wish."""
    if not frames:
        return None
    whole = frames[0].copy()
    for frame in frames[1:]:
        if (
            frame.verb not in ("", "make", "turn", "go", "face")
            or frame.place
            or frame.shape
            or (frame.joined == "then" and not _is_only_again(whole))
        ):
            return None
        if any(name in whole.q for name in frame.q):
            return None
        if "to_start" in frame.flags and frame.joined in ("and", "then") and _is_only_again(whole):
            return None  # `once more, and then home`
        if (
            "to_start" in frame.flags
            and frame.verb == "go"
            and (whole.shape or whole.verb in ("spin", "uturn"))
        ):
            return None  # `draw a triangle and go home`, `turn around and go home`
        if "to_start" in whole.flags and frame.verb == "turn" and not (frame.direction or frame.q):
            raise Unclear("unclear_motion", whole.text)  # `back to where you were before the turn`
        if "again" in frame.flags and whole.has_extent and whole.moves:
            return None  # a motion of its own, then more of it
        if whole.direction and frame.direction and whole.direction != frame.direction:
            return None
        whole.direction = whole.direction or frame.direction
        whole.rot = whole.rot or frame.rot
        whole.pace = whole.pace or frame.pace
        whole.verb = whole.verb or frame.verb
        whole.q.update(frame.q)
        whole.flags |= frame.flags
    return whole


def _is_only_again(frame: Frame) -> bool:
    return "again" in frame.flags and not frame.moves and not frame.q
