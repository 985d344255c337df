"""Frames → steps: what is shared by several clauses, repeats, pauses in between, and the order of things."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from chatrobot.language.actions import act
from chatrobot.language.arrange import arranged
from chatrobot.language.clauses import is_times_only
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import SIDES, STILL, TURN, Frame, merged
from chatrobot.language.manner import Pace
from chatrobot.language.shapes import draw
from chatrobot.language.tokens import quantity
from chatrobot.language.unclear import Unclear
from chatrobot.language.undoing import inverse
from chatrobot.plan.steps import MAX_REPEAT, Arc, Drive, Go, Repeat, Say, Step, Turn, Wait

_MIDDLE = frozenset({"中间", "当中"})


@dataclass
class Memory:
    """What this dialogue knows.

    Places by name, words that a person defined, and what the last motion left.
    """

    places: Mapping[str, Go] = field(default_factory=dict)
    words: Mapping[str, tuple[Step, ...]] = field(default_factory=dict)
    state: State = field(default_factory=State)


@dataclass
class Script:
    """The steps so far, a unit a clause (a repeated clause counts once a time)."""

    pace: Pace
    memory: Memory
    units: list[list[Step]] = field(default_factory=list)
    state: State = field(default_factory=State)

    def steps(self) -> list[Step]:
        return [step for unit in self.units for step in unit]


def write(frames: list[Frame], pace: Pace, memory: Memory) -> list[Step]:
    """The steps of an utterance.

    Raises:
        Unclear: where a clause cannot be acted on.
    """
    frames = arranged(_shared(frames))
    if any("units_said" in frame.flags for frame in frames):
        said = {flag for frame in frames for flag in frame.flags & {"units_said", "units_cm"}}
        frames = [f for f in frames if f.moves or f.has_extent]
        for frame in frames:
            frame.flags |= said
    frames = _shape_first(frames)
    _check_amounts(frames)
    paced = _paced(frames, pace)
    if paced is not None:
        return paced
    count, frames = _leading_count(frames)
    script = Script(pace, memory, state=memory.state)
    body = _loop_end(frames) if count is not None else len(frames)
    _take_all(script, frames[:body])
    if count is not None:
        script.units = _repeated(script.units, count)
        _take_all(script, frames[body:])
    steps = script.steps()
    if not steps:
        raise Unclear("nothing_to_do")
    _check_unsaid(script.state.unsaid, frames)
    return steps


def _check_unsaid(unsaid: list[Frame], frames: list[Frame]) -> None:
    """A drive without an amount beside clauses that have one is most likely a clause that was misread: ask."""
    if any(frame.has_extent for frame in frames):
        for frame in unsaid:
            if frame.joined not in ("then", "and"):
                raise Unclear("how_far", frame.text)


def _shared(frames: list[Frame]) -> list[Frame]:
    """`…, both forward`, 都往左转: a clause that holds for all the others."""
    kept: list[Frame] = []
    for frame in frames:
        if (
            "all" not in frame.flags
            or frame.q
            or not (frame.direction or frame.rot or frame.pace)
            or frame.shape
        ):
            kept.append(frame)
            continue
        for other in kept:
            if other.verb in STILL or is_times_only(other) or other.flags & {"between", "after_each"}:
                continue
            if not (other.direction or other.rot):
                other.direction, other.rot = frame.direction, frame.rot
                if frame.verb and not other.verb:
                    other.verb = frame.verb
            other.pace = other.pace or frame.pace
    return kept


def _check_amounts(frames: list[Frame]) -> None:
    """走直线，八十厘米，倒着走: a way said right after an amount may be how, or what comes next.

    Raises:
        Unclear: for a drive without an amount that is only set off by a comma from one that has it.
    """
    for last, frame in itertools.pairwise(frames):
        bare = not (frame.q or frame.shape or frame.place or frame.rot or frame.words or frame.flags)
        plain = frame.verb in ("", "go") and bool(frame.direction) and frame.direction not in SIDES
        if bare and plain and frame.joined == "weak" and "length" in last.q and last.verb in ("", "go"):
            raise Unclear("unclear_motion", f"{last.text} {frame.text}")


def _paced(frames: list[Frame], pace: Pace) -> list[Step] | None:
    """`Every 50 cm stop for a second, two metres in total`: as many legs as fit, pauses between them."""
    whole = next((f for f in frames if "total" in f.flags and {"length", "angle", "turns"} & set(f.q)), None)
    name = next((n for n in ("length", "angle", "turns") if whole and n in whole.q), "")
    leg = next((f for f in frames if whole and f is not whole and name in f.q), None)
    if whole is None:
        whole, leg = _covered(frames)
    if whole is None or len(frames) == 1 or "count" in whole.q or any(f.shape for f in frames):
        return None
    pause = next((f for f in frames if f.verb in STILL and "time" in f.q), None)
    name = name or next(n for n in ("length", "angle", "turns") if n in whole.q)
    if leg is None or pause is None or len(frames) > 3:
        raise Unclear("unclear_motion", whole.text)
    count = whole.q[name].number / leg.q[name].number
    if abs(count - round(count)) > 1e-6 or not 1 <= round(count) <= MAX_REPEAT:
        raise Unclear("bad_count", leg.text)
    drive = whole.copy()
    drive.q[name] = leg.q[name]
    drive.direction, drive.rot = whole.direction or leg.direction, whole.rot or leg.rot
    drive.verb = "" if name == "length" else "turn"
    drive.flags.discard("each")
    steps = act(drive, State(), pace)
    rest = act(Frame(verb="wait", q={"time": pause.q["time"]}), State(), pace)
    return [*(steps + rest) * (round(count) - 1), *steps]


def _covered(frames: list[Frame]) -> tuple[Frame | None, Frame | None]:
    """前进一米，每走半米停一秒: the way, and the piece of it after which there is a pause."""
    if len(frames) != 3 or frames[2].verb not in STILL or "each" not in frames[1].flags:
        return None, None
    for name in ("length", "angle", "turns"):
        if name in frames[0].q and name in frames[1].q and "each" not in frames[0].flags:
            return frames[0], frames[1]
    return None, None


def _shape_first(frames: list[Frame]) -> list[Frame]:
    """`2 m by 1 m rectangle`: measures said before the name of the shape belong to it."""
    out: list[Frame] = []
    for frame in frames:
        at = len(out)
        while frame.shape and frame.joined in ("none", "weak", "and") and at and _is_measure(out[at - 1]):
            at -= 1
        out.insert(at, frame)
    return out


def _is_measure(frame: Frame) -> bool:
    bare = not frame.moves or (
        frame.verb in ("go", "") and not (frame.direction or frame.shape or frame.place)
    )
    lone_rotation = bool(frame.rot) and not (frame.verb or frame.q or frame.direction or frame.shape)
    return (bare and "length" in frame.q and "time" not in frame.q) or lone_rotation


def _leading_count(frames: list[Frame]) -> tuple[int | None, list[Frame]]:
    """`Twice: …`, `the following three times: …`."""
    if (
        len(frames) > 1
        and is_times_only(frames[0])
        and frames[1].joined in ("colon", "weak", "none", "strong")
    ):
        return _count(frames[0]), frames[1:]
    return None, frames


def _loop_end(frames: list[Frame]) -> int:
    """Where the announced loop ends: `twice: A, B. Then C`, `twice (A, B), then C`, `…, and after all that C`."""
    ends = (k for k, f in enumerate(frames) if k and f.opens and f.joined == "then")
    return next(ends, len(frames))


def _take_all(script: Script, frames: list[Frame]) -> None:
    i = 0
    while i < len(frames):
        i = _take(script, frames, i)


def _count(frame: Frame) -> int:
    quantity = frame.q.get("times") or frame.q["count"]
    value = quantity.number
    if value != value or not 1 <= value <= MAX_REPEAT or value != int(value):
        raise Unclear("bad_count", quantity.text)
    return int(value)


def _take(script: Script, frames: list[Frame], i: int) -> int:
    frame = frames[i]
    if "still_axis" in frame.flags and not frame.moves:
        return i + 1
    if _lists_lengths(frames, i) or _is_heading_back(script, frame):
        return i + 1
    if "count" in frame.q and not frame.has_extent and not frame.flags and i + 1 < len(frames):
        following = frames[i + 1]
        if "length" in following.q and not following.verb and following.joined != "then":
            both = merged(frame, following)
            if both is not None:
                _act(script, both)
                return i + 2
    if "trip" in (*frame.flags, *frame.roles, *[a.role for a in frame.q.values()]):
        after = frames[i + 1] if i + 1 < len(frames) else None
        trip = _with_measure(frame, after) if after is not None else None
        if trip is None and after is not None and not after.moves:
            trip = merged(frame, after)
        _round_trips(script, trip or frame)
        return i + 1 + (trip is not None)
    if frame.shape:
        end, steps = draw(frames, i, script.pace)
        _finish(script, [steps])
        return end
    if _is_moves_only(script, frame):
        script.units = _repeated(script.units, _count(frame))
    elif is_times_only(frame) or (
        "again" in frame.flags and not frame.moves and {"times", "count"} & set(frame.q)
    ):
        script.units = _repeated(script.units, _count(frame) + bool({"extra", "more"} & frame.flags))
    elif "total" in frame.flags and "times" in frame.q and not frame.has_extent and script.units:
        script.units = _repeated(_period(script.units), _count(frame))
    elif "until" in frame.flags and frame.has_extent and len(script.units) > 1:
        _fill_up(script, frame)
    elif "halfway" in frame.flags:
        _insert_halfway(script, frame)
        goes_on = i + 1 < len(frames) and frames[i + 1].verb == "go" and not frames[i + 1].has_extent
        return i + 1 + (goes_on and not frames[i + 1].direction)
    elif "at_point" in frame.flags:
        if i + 1 >= len(frames) or frames[i + 1].verb not in STILL:
            raise Unclear("unclear_motion", frame.text)
        _insert_at(script, frame, frames[i + 1])
        return i + 2
    elif frame.flags & {"short_of", "overshot"} and not frame.moves and not frame.q and i + 1 < len(frames):
        pass
    elif "overshot" in frame.flags and not (frame.direction or frame.verb == "return"):
        return _take_back(script, frames, i)
    elif _is_plain_again(frame):
        if not script.units:
            raise Unclear("nothing_before", frame.text)
        agains = sum(1 for _ in itertools.takewhile(_is_plain_again, reversed(frames[:i])))
        script.units += [list(unit) for unit in script.units[: len(script.units) // (agains + 1)]]
    elif frame.verb in STILL and {"each", "all"} & frame.flags and script.units:
        frame.flags.add("after_each")
        _insert(script, frame)
    elif frame.flags & {"between", "after_each"}:
        _insert(script, frame)
    else:
        _act(script, frame)
    return i + 1


def _is_plain_again(frame: Frame) -> bool:
    """`again`: each one adds what was said before it once."""
    return "again" in frame.flags and not frame.moves and not frame.has_extent


def _is_moves_only(script: Script, frame: Frame) -> bool:
    """这样来四下: so often, what was said before."""
    count = frame.q.get("count")
    bare = not (frame.direction or frame.rot or frame.has_extent or frame.shape) and frame.verb in (
        "",
        "make",
    )
    return count is not None and count.role == "move" and bare and bool(script.units)


def _act(script: Script, frame: Frame) -> None:
    count, each = 1, frame
    split = "split" in frame.flags and "each" not in frame.flags
    if "count" in frame.q and "length" in frame.q:
        count = _count(Frame(q={"times": frame.q["count"]}))
        each = frame.copy()
        del each.q["count"]
        if split:
            each.q["length"] = quantity("length", frame.q["length"].number / count, frame.q["length"].text)
    elif "count" in frame.q and frame.q["count"].role == "move":
        each = frame.copy()
        del each.q["count"]
        each.flags.add("bit")
    elif "count" in frame.q:
        raise Unclear("how_long_a_step", frame.q["count"].text)
    if "times" in frame.q:
        count *= _count(Frame(q={"times": frame.q["times"]}))
        if split:
            each = _part(each, count)
    each = _relative_to_last(each, script)
    script.state.steps = script.steps()  # what was repeated, too: the way back is as long as all of it
    steps = _known(each, script) or act(each, script.state, script.pace)
    script.state.steps.extend(steps * count)
    script.units.extend([steps] * count if steps else [])


def _part(frame: Frame, count: int) -> Frame:
    part = frame.copy()
    for name in ("length", "angle", "turns", "time"):
        if name in part.q:
            part.q[name] = quantity(name, part.q[name].number / count, part.q[name].text)
    return part


def _with_measure(trip: Frame, following: Frame) -> Frame | None:
    """`to and fro five times, half a metre each way`: the measure said after the trips."""
    bare = not following.verb and not following.shape and not following.place and not following.rot
    if not bare or trip.has_extent or following.joined == "then":
        return None
    both = trip.copy()
    both.flags |= following.flags
    both.q = {**following.q, **both.q}
    both.direction = both.direction or following.direction
    both.roles += following.roles
    return both


def _relative_to_last(frame: Frame, script: Script) -> Frame:
    """`…, then a metre more twice as fast`: relative to the speed said before, if there was one."""
    if "faster" not in frame.q:
        return frame
    before = next(
        (s for s in reversed(script.state.steps) if isinstance(s, (Drive, Arc)) and s.speed_mps), None
    )
    if before is None or before.speed_mps is None:
        return frame
    frame = frame.copy()
    factor = frame.q.pop("faster")
    frame.q["speed"] = quantity("speed", factor.number * before.speed_mps, factor.text)
    return frame


def _lists_lengths(frames: list[Frame], i: int) -> bool:
    """`Three legs: half a metre, one metre, 1.5 m`: the count only announces the list."""
    frame = frames[i]
    if "count" not in frame.q or frame.has_extent:
        return False
    count = int(frame.q["count"].number)
    listed = frames[i + 1 : i + 1 + count]
    return len(listed) == count and all("length" in f.q and not f.verb for f in listed)


def _round_trips(script: Script, frame: Frame) -> None:
    """`Three round trips of one metre`."""
    each = frame.copy()
    trips = 1
    for name in ("count", "times"):
        if name in each.q:
            trips = _count(Frame(q={"times": each.q.pop(name)}))
    each.flags -= {"trip", "each"}
    if not each.has_extent:
        if not script.units:
            raise Unclear("how_long_a_step", frame.text)
        if len(script.units) > 1 and _is_there_and_back(script.steps()):
            script.units = _repeated(script.units, trips)
            return
        out = script.units.pop()
    elif each.verb in TURN or each.rot:
        raise Unclear("unclear_motion", frame.text)
    else:
        each.roles.clear()
        out = act(each, script.state, script.pace)
    for _ in range(trips):
        script.units += [out, inverse(out)]


def _is_there_and_back(steps: list[Step]) -> bool:
    """Whether drives, seen without turning, end where they began."""
    drives = [s for s in steps if isinstance(s, Drive) and s.distance_m]
    if len(drives) < len([s for s in steps if not isinstance(s, Wait)]):
        return False
    x = sum((s.distance_m or 0.0) * math.cos(s.direction_rad) for s in drives)
    y = sum((s.distance_m or 0.0) * math.sin(s.direction_rad) for s in drives)
    return math.hypot(x, y) < 1e-6


def _is_heading_back(script: Script, frame: Frame) -> bool:
    """`… until you face the way you started`: as often as it takes to a full turn."""
    if "until" not in frame.flags or "original_heading" not in frame.flags:
        return False
    period = _period(script.units)
    turned = abs(total_turn([s for unit in period for s in unit]))
    rounds = round(2 * math.pi / turned) if turned else 0
    if rounds < 1 or abs(rounds * turned - 2 * math.pi) > 1e-6:
        raise Unclear("condition", frame.text)
    script.units = _repeated(period, rounds)
    return True


def _period(units: list[list[Step]]) -> list[list[Step]]:
    """The shortest beginning that, repeated, gives all units."""
    for length in range(1, len(units) + 1):
        if len(units) % length == 0 and units[:length] * (len(units) // length) == units:
            return units[:length]
    return units


def _known(frame: Frame, script: Script) -> list[Step]:
    """The steps of a word that was defined, or the way to a place that was named; else none."""
    if frame.verb == "defined":
        return list(script.memory.words[frame.words])
    if not frame.place:
        return []
    if frame.verb not in ("", "go", "return", "make", "shift", "halt") or frame.has_extent or frame.rot:
        raise Unclear("unclear_motion", frame.text)
    go = script.memory.places.get(frame.place)
    if go is None:
        raise Unclear("place_unusable", frame.place)
    script.state.last = "go"
    return [replace(go, speed_mps=script.pace.speed(frame))]


def _finish(script: Script, units: list[list[Step]]) -> None:
    for unit in units:
        script.state.steps.extend(unit)
    script.units.extend(units)


def _insert(script: Script, frame: Frame) -> None:
    """A pause or a motion between the units, or after each of them."""
    if not frame.moves and set(frame.q) == {"time"}:
        frame = Frame(verb="wait", q=frame.q, flags=frame.flags, texts=frame.texts)
    steps = act(frame, script.state, script.pace)
    script.units = [part for unit in script.units for part in _full_turns(unit)]
    moving = [u for u in script.units if not all(isinstance(s, Wait) for s in u)]
    in_the_middle = "between" in frame.flags and _MIDDLE & {text[:2] for text in frame.texts}
    if len(moving) == len(script.units) == 1 and in_the_middle and "after_each" not in frame.flags:
        _insert_halfway(script, frame)  # 前进两米，中间停三秒
        return
    if len(moving) < 2 and not ("after_each" in frame.flags and moving):
        raise Unclear("between_what", frame.text)
    pause = all(isinstance(s, (Wait, Say)) for s in steps)
    units: list[list[Step]] = []
    for k, unit in enumerate(moving):
        units.append(unit)
        if k + 1 < len(moving) or ("after_each" in frame.flags and not pause):
            units.append(steps)
    script.units = units


def _fill_up(script: Script, frame: Frame) -> None:
    """转一圈歇两秒，转满三圈为止: the units again until the whole amount is done."""
    period = _period(script.units)
    steps = [step for unit in period for step in unit]
    wanted = frame.q.get("angle") or frame.q.get("turns") or frame.q.get("length")
    if wanted is None:
        raise Unclear("condition", frame.text)
    if wanted.value == "length":
        done = sum(s.distance_m or 0.0 for s in steps if isinstance(s, Drive))
    else:
        done = abs(total_turn(steps))
    rounds = wanted.number / done if done else 0.0
    if abs(rounds - round(rounds)) > 1e-6 or not 1 <= round(rounds) <= MAX_REPEAT:
        raise Unclear("condition", frame.text)
    script.units = _repeated(period, round(rounds))


def _insert_halfway(script: Script, frame: Frame) -> None:
    """往前两米，到一半的时候停两秒: the last motion in two halves."""
    halves = _halves(script.units[-1][0]) if script.units and len(script.units[-1]) == 1 else None
    if halves is None:
        raise Unclear("between_what", frame.text)
    inner = frame.copy()
    inner.flags -= {"halfway", "between"}
    if not inner.moves and set(inner.q) == {"time"}:
        inner.verb = "wait"
    steps = act(inner, State(), script.pace)
    script.units[-1:] = [[halves[0]], steps, [halves[1]]]


def _insert_at(script: Script, place: Frame, stop: Frame) -> None:
    """前进两米，走到一米的地方停三秒: a stop on the way, not another metre."""
    last = script.units[-1][0] if script.units and len(script.units[-1]) == 1 else None
    at_m = place.q["length"].number if "length" in place.q else 0.0
    if not isinstance(last, Drive) or last.distance_m is None or not 0 < at_m < last.distance_m - 1e-6:
        raise Unclear("unclear_motion", place.text)
    if place.moves or set(place.q) != {"length"}:
        raise Unclear("unclear_motion", place.text)
    before, after = replace(last, distance_m=at_m), replace(last, distance_m=last.distance_m - at_m)
    script.units[-1:] = [[before], act(stop, State(), script.pace), [after]]


def _halves(step: Step) -> tuple[Step, Step] | None:
    if isinstance(step, Drive) and step.until is None:
        metres = step.distance_m / 2 if step.distance_m else None
        seconds = step.duration_s / 2 if step.duration_s else None
        return replace(step, distance_m=metres, duration_s=seconds), replace(
            step, distance_m=metres, duration_s=seconds
        )
    if isinstance(step, (Turn, Arc)) and step.angle_rad:
        return replace(step, angle_rad=step.angle_rad / 2), replace(step, angle_rad=step.angle_rad / 2)
    return None


def _take_back(script: Script, frames: list[Frame], i: int) -> int:
    """多走了二十厘米，退回来: so much of it undone."""
    following = frames[i + 1] if i + 1 < len(frames) else None
    if following is None or not frames[i].has_extent or following.has_extent:
        raise Unclear("unclear_motion", frames[i].text)
    if following.verb not in ("return", "go", "turn", ""):
        raise Unclear("unclear_motion", frames[i].text)
    _act(script, Frame(verb="return", q=frames[i].q, texts=frames[i].texts))
    return i + 2


def _full_turns(unit: list[Step]) -> list[list[Step]]:
    """Several full turns in one, as one unit each: a pause fits between them."""
    if len(unit) == 1 and isinstance(unit[0], Turn) and unit[0].angle_rad:
        rounds = unit[0].angle_rad / (2 * math.pi)
        if rounds > 1.5 and abs(rounds - round(rounds)) < 1e-6:
            return [[replace(unit[0], angle_rad=2 * math.pi)]] * round(rounds)
    return [unit]


def _repeated(units: list[list[Step]], count: int) -> list[list[Step]]:
    """The units so often; a pause at the very end, after which nothing comes, is left out."""
    if not units:
        raise Unclear("nothing_before")
    whole = [step for unit in units for step in unit]
    if count * len(whole) > 400:
        return [[Repeat(count, tuple(whole))]]
    out = [list(unit) for unit in units * count]
    if count > 1 and all(isinstance(step, Wait) for step in out[-1]):
        out.pop()
    return out


def total_turn(steps: list[Step]) -> float:
    """Signed sum of the turns that have an angle, radians."""
    return sum((s.angle_rad or 0.0) * (1 if s.left else -1) for s in steps if isinstance(s, Turn))
