"""Frames → steps: one after the other, with what repeats, interrupts or takes back those before it."""

from __future__ import annotations

import itertools

from chatrobot.language.arrange import arranged
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import SIDES, STILL, TURN, Frame
from chatrobot.language.inverse import flipped
from chatrobot.language.joining import is_times_only, merged
from chatrobot.language.manner import Pace
from chatrobot.language.pauses import follows_passes, insert, insert_at, insert_halfway, paced_legs
from chatrobot.language.repeats import (
    by_turns,
    counts_moves,
    fill_up,
    is_heading_back,
    is_moves_only,
    is_plain_again,
    is_repetition,
    is_way_back,
    leading_count,
    lists_lengths,
    loop_end,
    period,
    repeated,
    repeats_all,
    round_trips,
    with_measure,
)
from chatrobot.language.script import Memory, Script, act_out, count_of
from chatrobot.language.shapes import draw
from chatrobot.language.tokens import quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Step

_ROLE = {**dict.fromkeys(("square", "triangle", "polygon", "star"), "side"), "circle": "radius"}
"""The one measure of a shape whose sides are all as long."""

_ALIKE = frozenset({"again", "same_way", "instead"})


def write(frames: list[Frame], pace: Pace, memory: Memory) -> list[Step]:
    """The steps of an utterance.

    Raises:
        Unclear: where a clause cannot be acted on.
    """
    frames = arranged(frames)
    _check_amounts(frames)
    _check_opener(frames)
    _check_beside(frames)
    _check_places(frames)
    legs = paced_legs(frames, pace)
    if legs is not None:
        return legs
    in_all = bool(frames) and counts_moves(frames[0])
    count, frames = leading_count(frames)
    script = Script(pace, memory, state=memory.state)
    body = loop_end(frames) if count is not None else len(frames)
    pause = frames[body - 1] if count is not None and body > 2 and follows_passes(frames[body - 1]) else None
    _take_all(script, frames[: body - (pause is not None)])
    if count is not None:
        in_all = in_all and len(script.units) > 1
        script.units = by_turns(script.units, count) if in_all else repeated(script.units, count)
        if pause is not None:  # `twice: A, B, resting 2 s after each repetition`
            insert(script, pause, counted=True)
        _take_all(script, frames[body:])
    steps = script.steps()
    if not steps:
        raise Unclear("nothing_to_do")
    _check_unsaid(script.state.unsaid, frames)
    return steps


def _check_beside(frames: list[Frame]) -> None:
    """`Meanwhile turn left` alone is a turn; `while turning left, …` is none before what comes.

    Raises:
        Unclear: where a turn is said to be beside something, and is joined with no motion; for two drives at a time.
    """
    for before, frame in itertools.pairwise(frames):
        both = "length" in frame.q and "length" in before.q and not (before.rot or before.verb in TURN)
        if "while" in frame.flags and both and frame.direction in SIDES and frame.verb not in TURN:
            # `1 m forward and 1 m right at the same time`: aslant?
            raise Unclear("unclear_motion", frame.text)
    for frame in frames:
        if (
            "while" in frame.flags
            and frame.verb in TURN
            and not frame.q.keys() & {"length", "radius", "speed"}
        ):
            if len(frames) > 1:
                raise Unclear("unclear_motion", frame.text)
            frame.flags.discard("while")


def _check_places(frames: list[Frame]) -> None:
    """`To the charger, but sideways`: the way there has turns.

    Raises:
        Unclear: for such a place.
    """
    for frame in frames:
        if frame.place and "sideways" in frame.flags:
            raise Unclear("unclear_motion", frame.text)


def _check_unsaid(unsaid: list[Frame], frames: list[Frame]) -> None:
    """A drive without an amount beside clauses that have one, or as something before, was most likely misread: ask."""
    for frame in unsaid:
        if "again" in frame.flags:  # `…, then the same backwards`
            raise Unclear("how_far", frame.text)
        if any("same_amount" in other.flags for other in frames):
            raise Unclear("how_far", frame.text)  # `the same amount diagonally, front-left at 45 deg`
    if any(frame.has_extent for frame in frames):
        for frame in unsaid:
            if frame.joined not in ("then", "and"):
                raise Unclear("how_far", frame.text)


def _check_amounts(frames: list[Frame]) -> None:
    """走直线，八十厘米，倒着走: a way said right after an amount may be how, or what comes next.

    Raises:
        Unclear: for a drive without an amount that is only set off by a comma from one that has it; for a turn
            with two angles.
    """
    for last, frame in itertools.pairwise(frames):
        if _is_second_angle(last, frame):
            raise Unclear("contradiction", f"{last.text} {frame.text}")
        angle_back = set(last.q) & {"angle", "turns"} and not last.moves and frame.direction == "back"
        if angle_back and frame.joined == "none":  # `10 degrees back` after a drive
            raise Unclear("unclear_motion", f"{last.text} {frame.text}")
        bare = not (frame.q or frame.shape or frame.place or frame.rot or frame.words or frame.flags)
        plain = frame.verb in ("", "go") and bool(frame.direction) and frame.direction not in SIDES
        if bare and plain and frame.joined == "weak" and "length" in last.q and last.verb in ("", "go"):
            raise Unclear("unclear_motion", f"{last.text} {frame.text}")


def _is_second_angle(last: Frame, frame: Frame) -> bool:
    """`turn right 90 degrees, 30 degrees`: an angle beside that of the same turn, and no motion of its own."""
    loose = frame.joined in ("weak", "none") and not (
        frame.moves or frame.words or frame.flags or frame.roles
    )
    return loose and last.verb in TURN and "angle" in last.q and "angle" in frame.q and not last.shape


def _check_opener(frames: list[Frame]) -> None:
    """`Right, go forward 1 m`: a word to begin with, or a turn? Beside `left, …` it is a turn.

    Raises:
        Unclear: where it is the only side named so.
    """
    sides = {
        frame.direction for frame in frames if len(frame.texts) == 1 and frame.joined in ("start", "weak")
    }
    if len(frames) == 2 and sides == set(SIDES) and not any(f.verb or f.q for f in frames):
        raise Unclear(
            "unclear_motion", ", ".join(f.text for f in frames)
        )  # `left, right …`: named, or turned to?
    if len(frames) < 2 or frames[0].texts != ["right"] or frames[0].q or frames[1].joined != "weak":
        return
    named = [frame for frame in frames if frame.direction in SIDES and not (frame.verb or frame.has_extent)]
    told = frames[1].verb or (frames[1].direction and frames[1].has_extent)
    if len(named) == 1 and told and not frames[1].texts[0].endswith("ing"):
        raise Unclear("unclear_motion", f"right, {frames[1].text}")


def _take_all(script: Script, frames: list[Frame]) -> None:
    i = 0
    while i < len(frames):
        i = _take(script, frames, i)


def _take(script: Script, frames: list[Frame], i: int) -> int:
    """Writes what `frames[i]` means, with the frames after it that belong to it; the index of the next one."""
    for taken in (_announced, _counted_legs, _trips, _shape, _repeat, _on_the_way, _overshot, _interlude):
        end = taken(script, frames, i)
        if end is not None:
            return end
    act_out(script, frames[i])
    return i + 1


def _announced(script: Script, frames: list[Frame], i: int) -> int | None:
    """What is no motion of its own: `without turning`, `three legs: …`, `… until you face the way you started`."""
    frame = frames[i]
    aside = "still_axis" in frame.flags and not frame.moves
    return i + 1 if aside or lists_lengths(frames, i) or is_heading_back(script, frame) else None


def _counted_legs(script: Script, frames: list[Frame], i: int) -> int | None:
    """`Three legs of half a metre`: the count, then the length."""
    frame = frames[i]
    if "count" not in frame.q or frame.has_extent or frame.flags or i + 1 >= len(frames):
        return None
    following = frames[i + 1]
    if "length" not in following.q or following.verb or following.joined == "then":
        return None
    both = merged(frame, following)
    if both is None:
        return None
    act_out(script, both)
    return i + 2


def _trips(script: Script, frames: list[Frame], i: int) -> int | None:
    frame = frames[i]
    if "trip" not in (*frame.flags, *frame.roles, *[a.role for a in frame.q.values()]):
        return None
    after = frames[i + 1] if i + 1 < len(frames) else None
    trip = with_measure(frame, after) if after is not None else None
    if trip is None and after is not None and not after.moves:
        trip = merged(frame, after)
    round_trips(script, trip or frame)
    end = i + 1 + (trip is not None)
    back = frames[end] if end < len(frames) else None
    if back is not None and back.verb == "return" and back.has_extent and back.joined != "then":
        raise Unclear("contradiction", f"{frame.text} {back.text}")  # 每趟去一米、回半米
    return end + (back is not None and is_way_back(trip or frame, back))


def _shape(script: Script, frames: list[Frame], i: int) -> int | None:
    if not frames[i].shape:
        return None
    frames = _sized_as_before(frames, i, script.state)
    end, steps = draw(frames, i, script.pace)
    after = frames[end] if end < len(frames) else None
    if script.units and after is not None and is_repetition(after) and not repeats_all(after):
        raise Unclear("unclear_motion", after.text)  # the shape, or all of it?
    script.add(steps)
    return end


def _sized_as_before(frames: list[Frame], i: int, state: State) -> list[Frame]:
    """`The same but a triangle`: with the sides of what was driven before.

    Raises:
        Unclear: where that had none.
    """
    frame = frames[i]
    if not frame.flags & _ALIKE or any("length" in other.q for other in frames[i:]):
        return frames
    role = _ROLE.get(frame.shape.split("_")[0], "")
    if role not in state.sizes:
        raise Unclear("which_size", frame.text)
    sized = frame.copy()
    sized.q["length"] = quantity("length", state.sizes[role], role)
    sized.roles.append(role)
    sized.flags -= _ALIKE
    return [*frames[:i], sized, *frames[i + 1 :]]


def _repeat(script: Script, frames: list[Frame], i: int) -> int | None:
    """`four times`, `repeat that twice`, `three times in all`, `… until three turns are full`."""
    frame, units = frames[i], script.units
    counted = bool({"times", "count"} & set(frame.q))
    if "total" in frame.flags and counted and not frame.has_extent and len(period(units)) < len(units):
        script.units = repeated(period(units), count_of(frame))  # so often in all, of what was told twice
    elif counts_moves(frame) and len(units) > 1 and not frame.moves:
        script.units = by_turns(units, count_of(frame))  # `left 20 cm, right 20 cm, six moves in all`
    elif is_moves_only(script, frame):
        script.units = repeated(units, count_of(frame))
    elif is_times_only(frame) or ("again" in frame.flags and not frame.moves and counted):
        script.units = repeated(units, count_of(frame) + bool({"extra", "more"} & frame.flags))
    elif "total" in frame.flags and "times" in frame.q and not frame.has_extent and units:
        script.units = repeated(period(units), count_of(frame))
    elif "until" in frame.flags and frame.has_extent and len(units) > 1:
        fill_up(script, frame)
    else:
        return None
    return i + 1


def _on_the_way(script: Script, frames: list[Frame], i: int) -> int | None:
    """`halfway wait 2 s`, 走到一米的地方停三秒: a pause that cuts the last motion in two."""
    frame, after = frames[i], frames[i + 1] if i + 1 < len(frames) else None
    if "halfway" in frame.flags:
        goes_on = after is not None and after.verb == "go" and not (after.has_extent or after.direction)
        insert_halfway(script, frame, goes_on=goes_on)
        return i + 1 + goes_on
    if "at_point" in frame.flags:
        if after is None or after.verb not in STILL:
            raise Unclear("unclear_motion", frame.text)
        insert_at(script, frame, after)
        return i + 2
    return None


def _overshot(script: Script, frames: list[Frame], i: int) -> int | None:
    """多走了二十厘米，退回来: so much of it undone."""
    frame, after = frames[i], frames[i + 1] if i + 1 < len(frames) else None
    if frame.flags & {"short_of", "overshot"} and not frame.moves and not frame.q and after is not None:
        return i + 1
    if "overshot" not in frame.flags or frame.direction or frame.verb == "return":
        return None
    if after is None or not frame.has_extent or after.has_extent:
        raise Unclear("unclear_motion", frame.text)
    if after.verb not in ("return", "go", "turn", ""):
        raise Unclear("unclear_motion", frame.text)
    act_out(script, Frame(verb="return", q=frame.q, texts=frame.texts))
    return i + 2


def _interlude(script: Script, frames: list[Frame], i: int) -> int | None:
    """`again`, each one adding once what was said before it; and what comes between the motions, or after each."""
    frame = frames[i]
    if frame.flags == {"again", "mirrored", "other_way"} and not (frame.moves or frame.q):
        steps = [step for unit in script.units for step in unit]
        mirrored = [flipped(step) for step in steps]
        if sum(a != b for a, b in zip(steps, mirrored, strict=True)) > 1:  # all of it: not the last one alone
            script.add(mirrored)
            return i + 1
    if is_plain_again(frame):
        if not script.units:
            raise Unclear("nothing_before", frame.text)
        agains = sum(1 for _ in itertools.takewhile(is_plain_again, reversed(frames[:i])))
        script.units += [list(unit) for unit in script.units[: len(script.units) // (agains + 1)]]
        return i + 1
    if frame.verb in STILL and {"each", "all"} & frame.flags and script.units:
        frame.flags.add("after_each")
    elif not frame.flags & {"between", "after_each"}:
        return None
    insert(script, frame, counted=i > 0 and is_times_only(frames[i - 1]))
    return i + 1
