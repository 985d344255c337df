"""What refers to earlier turns: again, the other way, half of that, undo, back, places, a total."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, TurnRecord
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import DIRECTIONS, GO, SIDES, Frame
from chatrobot.language.lexicon import cut, lexicon
from chatrobot.language.manner import Pace
from chatrobot.language.normalise import normalise
from chatrobot.language.numbers import is_chinese
from chatrobot.language.tokens import quantity, tokenise
from chatrobot.language.unclear import Unclear
from chatrobot.language.undoing import inverse
from chatrobot.plan.steps import Arc, Drive, Face, Go, RawTwist, Repeat, Step, Turn, Wait

_CHANGES = frozenset(
    {"again", "other_way", "more", "bit", "instead", "same_way", "all", "total", "short_of", "first"}
)


def refer(frames: Sequence[Frame], context: Context, pace: Pace) -> list[Step] | None:
    """The steps of an utterance that refers to an earlier one; None where it does not.

    Raises:
        Unclear: where there is nothing to refer to.
    """
    if _goes_on_the_same_way(frames):
        return None
    if len(frames) == 2 and frames[0].verb == "undo" and frames[1].verb == "return" and not frames[1].q:
        frames = frames[:1]
    whole = _whole(frames)
    if whole is None:
        return None
    last = context.dialogue.last_motion
    if whole.verb == "undo":
        return _undone(whole, context, turning=any(frame.verb == "turn" for frame in frames[1:]))
    if "same_way" in whole.flags and (
        whole.verb in ("return", "", "go", "uturn") or whole.direction == "back"
    ):
        return _same_way_back(context)
    if "short_of" in whole.flags:
        return _remainder(whole, context, pace)
    if "original_heading" in whole.flags and ("to_start" in whole.flags or whole.verb == "return"):
        start = context.dialogue.start_pose
        return [Go(start.x_m, start.y_m, start.yaw_rad, frame="odom", speed_mps=pace.speed(whole))]
    if whole.has_extent and {"original_heading", "to_start"} & whole.flags:
        return None  # a motion of its own comes before
    if "original_heading" in whole.flags and whole.verb in ("face", "turn", "", "return", "go"):
        if set(whole.q) - {"rate", "percent", "faster"}:
            raise Unclear("unclear_motion", whole.text)  # 转回来一半: not all the way
        return [Face(context.dialogue.start_pose.yaw_rad, frame="odom", rate_radps=pace.rate(whole))]
    if whole.verb == "face" and "to_start" in whole.flags:
        raise Unclear("unclear_motion", whole.text)  # to drive there or to look there?
    if (whole.verb == "return" or "to_start" in whole.flags) and not whole.q and not whole.place:
        if whole.direction and whole.direction != "back":
            return None
        start = context.dialogue.start_pose
        return [Go(start.x_m, start.y_m, frame="odom", speed_mps=pace.speed(whole))]
    on = "more" in whole.flags or any(text.endswith(("more", "further", "farther")) for text in whole.texts)
    if on and "bit" in whole.flags <= {"bit", "more"} and not (whole.moves or whole.q or whole.roles):
        return [_a_bit_of(_last(last), whole, pace)]
    if "again" in whole.flags and "both" in whole.texts[-1:] and not (whole.moves or whole.q):
        both = [turn.plan for turn in context.dialogue.turns if turn.plan is not None][-2:]
        if len(both) < 2:
            raise Unclear("nothing_before", whole.text)
        return [step for plan in both for step in plan.steps]
    if _is_change(whole):
        return _changed(_last(last), whole, pace)
    return None


def _undone(whole: Frame, context: Context, *, turning: bool) -> list[Step]:
    """`undo that`; `undo both`, `undo the last three`: so many turns that moved, the last one first.

    `turning`: it is said to have been a turn.
    """
    counts = [whole.q[name] for name in ("number", "count", "times") if name in whole.q]
    both = any(text.split()[-1] in ("both", "two") for text in whole.texts)
    count = counts[0].number if counts else 2.0 if both else 1.0
    moved = _not_undone(context)
    if count != int(count) or count < 1 or set(whole.q) - {"number", "count", "times", "speed"}:
        raise Unclear("unclear_motion", whole.text)
    if len(moved) < count:
        raise Unclear("nothing_before", whole.text)
    steps = [step for turn in moved[-int(count) :] if turn.plan for step in turn.plan.steps]
    if turning and not all(isinstance(step, Turn) for step in steps):
        raise Unclear("unclear_motion", whole.text)
    return inverse(steps)


def _not_undone(context: Context) -> list[TurnRecord]:
    """The turns that moved and still count: `undo` twice takes back two of them."""
    moved: list[TurnRecord] = []
    for turn in context.dialogue.turns:
        if turn.plan is None:
            continue
        said = tokenise(normalise(turn.text), lexicon(), {})
        undoes = any((atom.kind, atom.value) == ("verb", "undo") for atom in said)
        before = [step for record in moved[-1:] if record.plan for step in record.plan.steps]
        if undoes and before and list(turn.plan.steps) == inverse(before):
            moved.pop()
        else:
            moved.append(turn)
    return moved


def _a_bit_of(last: _Last, whole: Frame, pace: Pace) -> Step:
    """`a bit more`: the last motion's way, a little."""
    step = last.plan_steps[-1]
    defaults = pace.profile.defaults
    if len(last.plan_steps) == 1 and isinstance(step, Drive):
        return dataclasses.replace(step, distance_m=defaults.distance_m / 2, duration_s=None)
    if len(last.plan_steps) == 1 and isinstance(step, Turn):
        return dataclasses.replace(step, angle_rad=defaults.turn_rad / 2, duration_s=None)
    raise Unclear("nothing_before", whole.text)


def _goes_on_the_same_way(frames: Sequence[Frame]) -> bool:
    """`another 45 the same way`: on, not back; the flag has then done its work."""
    found = False
    for frame in frames:
        amount = frame.has_extent or "number" in frame.q or {"more", "bit"} & frame.flags
        if "same_way" in frame.flags and amount and frame.verb != "return" and not frame.direction:
            frame.flags.discard("same_way")
            found = True
    return found


@dataclasses.dataclass(frozen=True)
class _Last:
    plan_steps: tuple[Step, ...]


def _last(record: TurnRecord | None) -> _Last:
    if record is None or record.plan is None:
        raise Unclear("nothing_before")
    return _Last(record.plan.steps)


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


def _is_change(whole: Frame) -> bool:
    if "same_amount" in whole.flags:
        return False
    if "again" in whole.flags and "count" in whole.q:
        raise Unclear("nothing_before", whole.text)
    if whole.shape or whole.place or whole.verb not in ("", "make", "again"):
        repeats = (
            "again" in whole.flags
            and whole.verb in (*GO, "turn")
            and (not whole.direction or whole.verb == "go")
            and not whole.has_extent
        )
        bare = not whole.has_extent and not whole.direction
        mirrored = "other_way" in whole.flags and bare and whole.verb in (*GO, "turn", "spin", "curve")
        scaled = (
            "scale" in whole.q
            and whole.verb in (*GO, "turn")
            and not whole.direction
            and not whole.has_extent
        )
        if not (repeats or mirrored or scaled) or whole.shape or whole.place:
            return False
    if "times" in whole.q and "more" in whole.flags and not whole.has_extent:
        return True
    if "other_way" in whole.flags or "again" in whole.flags:
        return True
    return bool({"fold", "scale", "faster"} & set(whole.q)) and not whole.has_extent


def _changed(last: _Last, whole: Frame, pace: Pace) -> list[Step]:
    whole = _speed_said(whole, last)
    fold = whole.q.get("fold")
    if fold is not None and is_chinese(fold.text):
        whole = whole.copy()
        del whole.q["fold"]
        name = "speed" if "速" in fold.text else "scale"
        usual = pace.speed_mps or pace.profile.defaults.speed_mps
        whole.q[name] = quantity(name, fold.number * (usual if name == "speed" else 1.0), fold.text)
    factor = whole.q["scale"].number if "scale" in whole.q else 1.0
    if "percent" in whole.q and not whole.pace:
        factor = whole.q["percent"].number
    if "number" in whole.q or "count" in whole.q or "clock" in whole.q:
        raise Unclear("no_unit", next(whole.q[n].text for n in ("number", "count", "clock") if n in whole.q))
    steps = [_step(step, whole, factor, pace) for step in last.plan_steps]
    count = whole.q.get("times")
    if count is not None:
        if count.number != int(count.number) or not 1 <= count.number <= 100:
            raise Unclear("bad_count", count.text)
        return steps * int(count.number)
    if any(name in whole.q for name in ("length", "angle", "turns", "time")):
        steps = _resized(steps, whole)
    return steps


def _speed_said(whole: Frame, last: _Last) -> Frame:
    """`once more but at 0.5`, after a motion whose speed was said: a speed."""
    number = whole.q.get("number")
    paced = any(isinstance(s, (Drive, Arc)) and s.speed_mps for s in last.plan_steps)
    if number is None or not paced or not 0 < number.number < 1 or whole.q.keys() != {"number"}:
        return whole
    whole = whole.copy()
    del whole.q["number"]
    whole.q["speed"] = quantity("speed", number.number, number.text)
    return whole


def _step(step: Step, whole: Frame, factor: float, pace: Pace) -> Step:
    if isinstance(step, Repeat):
        return Repeat(step.count, tuple(_step(inner, whole, factor, pace) for inner in step.steps))
    opposite = "other_way" in whole.flags
    side = whole.rot or (whole.direction if whole.direction in SIDES else "")
    if isinstance(step, Drive):
        angle = step.direction_rad
        if whole.direction:
            angle = DIRECTIONS[whole.direction]
        elif opposite:
            angle = math.remainder(angle + math.pi, 2 * math.pi)
        distance = step.distance_m * factor if step.distance_m else None
        seconds = step.duration_s * factor if step.duration_s else None
        return dataclasses.replace(
            step,
            distance_m=distance,
            duration_s=seconds,
            direction_rad=angle,
            speed_mps=_speed(step.speed_mps, whole, pace),
        )
    if isinstance(step, Turn):
        if whole.direction and not side:
            raise Unclear("contradiction", whole.text)
        left = side == "left" if side else step.left != opposite
        angle_rad = step.angle_rad * factor if step.angle_rad else None
        seconds = step.duration_s * factor if step.duration_s else None
        said = pace.rate(whole)
        return dataclasses.replace(
            step, angle_rad=angle_rad, duration_s=seconds, left=left, rate_radps=said or step.rate_radps
        )
    if isinstance(step, Arc):
        left = side == "left" if side else step.left != opposite
        return dataclasses.replace(
            step, left=left, radius_m=step.radius_m * factor, speed_mps=_speed(step.speed_mps, whole, pace)
        )
    if isinstance(step, RawTwist) and not side:
        sign = -1.0 if opposite else 1.0
        return RawTwist(
            sign * step.vx_mps, sign * step.vy_mps, sign * step.wz_radps, step.duration_s * factor
        )
    if isinstance(step, (Go, Face)) and (factor != 1.0 or opposite or side):
        raise Unclear("nothing_before", whole.text)
    return step


def _speed(old: float | None, whole: Frame, pace: Pace) -> float | None:
    if not whole.pace and not {"speed", "fold", "faster"} & set(whole.q):
        return old
    usual = old or pace.speed_mps or pace.profile.defaults.speed_mps
    if "faster" in whole.q:
        return whole.q["faster"].number * usual
    if whole.pace == "slow":
        return usual * 0.5
    if whole.pace == "fast":
        return min(usual * 1.7, pace.profile.limits.max_speed_mps)
    return pace.speed(whole)


def _resized(steps: list[Step], whole: Frame) -> list[Step]:
    """`the same but two metres`: a new amount, where exactly one step takes it."""
    length, angle, seconds = (
        whole.q.get("length"),
        whole.q.get("angle") or whole.q.get("turns"),
        whole.q.get("time"),
    )
    out: list[Step] = []
    taken = 0
    for step in steps:
        if length and isinstance(step, Drive):
            step, taken = dataclasses.replace(step, distance_m=length.number, duration_s=None), taken + 1
        elif angle and isinstance(step, Turn):
            step, taken = dataclasses.replace(step, angle_rad=angle.number, duration_s=None), taken + 1
        elif seconds and isinstance(step, Drive):
            step, taken = dataclasses.replace(step, duration_s=seconds.number, distance_m=None), taken + 1
        elif seconds and isinstance(step, Turn):
            step, taken = dataclasses.replace(step, duration_s=seconds.number, angle_rad=None), taken + 1
        elif seconds and isinstance(step, Wait):
            step, taken = Wait(seconds.number), taken + 1
        out.append(step)
    if taken != 1:
        raise Unclear("nothing_before", whole.text)
    return out


def _same_way_back(context: Context) -> list[Step]:
    plans = [
        turn.plan for turn in context.dialogue.turns if turn.plan is not None and turn.outcome == "completed"
    ]
    steps = [step for plan in plans for step in plan.steps]
    if not steps:
        raise Unclear("nothing_before")
    return inverse(steps)


def _remainder(whole: Frame, context: Context, pace: Pace) -> list[Step]:
    """`Not enough, I want a total of 1.2 m`: what is missing to it, the same way."""
    last = context.dialogue.last_motion
    steps = _last(last).plan_steps
    assert last is not None
    moved = last.end_pose.relative_to(last.start_pose)
    step = steps[-1]
    if "length" in whole.q and isinstance(step, Drive) and len(steps) == 1:
        done = math.hypot(moved.x_m, moved.y_m)
        if "to_start" in whole.flags or "total" in whole.flags:
            done = max(done, last.end_pose.distance_to(_run_start(context, step)))
        if "again" in whole.flags:
            raise Unclear("contradiction", whole.text)  # more, or a total?
        missing = whole.q["length"].number - (0.0 if "more" in whole.flags else done)
        if missing > 0.005:
            return [
                Drive(
                    missing, direction_rad=step.direction_rad, speed_mps=pace.speed(whole) or step.speed_mps
                )
            ]
        return [Drive(-missing, direction_rad=math.remainder(step.direction_rad + math.pi, 2 * math.pi))]
    angle = whole.q.get("angle") or whole.q.get("turns")
    if angle and isinstance(step, Turn) and len(steps) == 1:
        missing = angle.number - abs(moved.yaw_rad)
        return [Turn(abs(missing), left=step.left if missing > 0 else not step.left)]
    raise Unclear("nothing_before", whole.text)


def _run_start(context: Context, step: Drive) -> Pose:
    """Where the unbroken run of drives in one direction began that the last turn belongs to."""
    start = context.state.pose
    for turn in reversed(context.dialogue.turns):
        if turn.plan is None:
            continue
        same = all(isinstance(s, Drive) and s.direction_rad == step.direction_rad for s in turn.plan.steps)
        if not same:
            break
        start = turn.start_pose
    return start


def _said_unit_m(text: str) -> float | None:
    """The last unit of length in what was said: `another 30` after `50 cm` are centimetres."""
    words = lexicon().words
    units = [
        float(value)
        for unit in cut(normalise(text))
        for kind, value in words.get((unit,), ())
        if kind == "unit_length"
    ]
    return units[-1] if units else None


def state_after(context: Context) -> State:
    """What the last motion leaves for an ellipsis like `thirty more`."""
    last = context.dialogue.last_motion
    state = State(home=context.dialogue.start_pose if last is not None else None)
    if last is None or last.plan is None:
        return state
    for step in reversed(last.plan.steps):
        if isinstance(step, Drive):
            state.last = "drive"
            if step.distance_m:
                state.length = quantity("length", step.distance_m, f"{step.distance_m:g} m")
                said = (_said_unit_m(turn.text) for turn in reversed(context.dialogue.turns))
                state.unit_m = next((unit for unit in said if unit), None)
            state.direction = next(
                (
                    n
                    for n, a in DIRECTIONS.items()
                    if abs(math.remainder(a - step.direction_rad, 2 * math.pi)) < 1e-6
                ),
                "forward",
            )
            break
        if isinstance(step, Turn):
            state.last, state.left = "turn", step.left
            if step.angle_rad:
                state.angle = quantity("angle", step.angle_rad, f"{math.degrees(step.angle_rad):g}°")
            break
    return state
