"""What is put in between: pauses between motions or on the way, and legs with a pause after each."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from functools import cache

from chatrobot.language.actions import act
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import STILL, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.repeats import period
from chatrobot.language.script import Script
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import MAX_REPEAT, Arc, Drive, Say, Step, Turn, Wait

_MIDDLE = frozenset({"中间", "当中"})
_PASSES = frozenset({"每次", "两次"})


@cache
def _motions() -> frozenset[str]:
    return frozenset(word for code in LANGUAGES for word in load_table(code, "repeats").get("motions", ()))


def paced_legs(frames: list[Frame], pace: Pace) -> list[Step] | None:
    """`Every 50 cm stop for a second, two metres in total`: as many legs as fit, pauses between them."""
    whole = next((f for f in frames if "total" in f.flags and {"length", "angle", "turns"} & set(f.q)), None)
    name = next((n for n in ("length", "angle", "turns") if whole and n in whole.q), "")
    leg = next((f for f in frames if whole and f is not whole and name in f.q), None)
    if whole is None:
        whole, leg = _covered(frames)
    if whole is None or len(frames) == 1 or "count" in whole.q or any(f.shape for f in frames):
        return None
    if any("at_point" in frame.flags for frame in frames):
        return None  # 一共前进两米，走到一米的地方停三秒: one pause
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


def insert(script: Script, frame: Frame, *, counted: bool = False) -> None:
    """A pause or a motion between the units, or after each of them; `counted`: they were just repeated."""
    if not frame.moves and set(frame.q) == {"time"}:
        frame = Frame(verb="wait", q=frame.q, flags=frame.flags, texts=frame.texts)
    steps = act(frame, script.state, script.pace)
    script.units = [part for unit in script.units for part in _full_turns(unit)]
    moving = [u for u in script.units if not all(isinstance(s, Wait) for s in u)]
    in_the_middle = "between" in frame.flags and _MIDDLE & {text[:2] for text in frame.texts}
    if len(moving) == len(script.units) == 1 and in_the_middle and "after_each" not in frame.flags:
        insert_halfway(script, frame)  # 前进两米，中间停三秒
        return
    pause = all(isinstance(s, (Wait, Say)) for s in steps)
    sides = _sides(moving[0]) if len(moving) == len(script.units) == 1 and pause else []
    if sides:
        rests = len(sides) - ("after_each" not in frame.flags)
        script.units = [[*side[:1], *(steps if k < rests else ()), *side[1:]] for k, side in enumerate(sides)]
        return
    if len(moving) < 2 and not ("after_each" in frame.flags and moving):
        raise Unclear("between_what", frame.text)
    parted = "between" in frame.flags and _PASSES & {text[:2] for text in frame.texts}
    if parted or _parts_passes(frame, counted) or (counted and follows_passes(frame)):
        moving = _passes(moving)
    lead = len(moving) - _alike(moving) if pause and "between" in frame.flags else 0
    units: list[list[Step]] = []
    for k, unit in enumerate(moving):
        units.append(unit)
        if lead <= k < len(moving) - 1 or "after_each" in frame.flags:
            units.append(steps)
    script.units = units


def _alike(units: list[list[Step]]) -> int:
    """How many at the end are the same, of three or more; else all: `turn left, then 20 cm three times`."""
    alike = next((n for n, unit in enumerate(reversed(units)) if unit != units[-1]), len(units))
    return alike if alike > 2 else len(units)


def _sides(shape: list[Step]) -> list[list[Step]]:
    """The sides of a drawn shape, each with the turn behind it; none where it is no shape of three sides at least."""
    starts = [i for i, step in enumerate(shape) if isinstance(step, Drive)]
    if len(starts) < 3 or starts[0] != 0:
        return []
    return [shape[start:end] for start, end in itertools.pairwise((*starts, len(shape)))]


def _parts_passes(frame: Frame, counted: bool) -> bool:
    """`forward 1 m and back 1 m, three times, 5 s in between`: between the times, where no motion is named."""
    between = next((text for text in frame.texts if "between" in text.split()), "")
    return counted and "between" in frame.flags and bool(between) and not _motions() & set(between.split())


def follows_passes(frame: Frame) -> bool:
    """`…, resting 2 s after each repetition`: behind all that is done each time, or between the times."""
    said = {text.split()[-1] for text in frame.texts}
    return bool(frame.flags & {"after_each", "between"} and said & _words_for_passes())


@cache
def _words_for_passes() -> frozenset[str]:
    return frozenset(word for code in LANGUAGES for word in load_table(code, "repeats").get("passes", ()))


def _passes(units: list[list[Step]]) -> list[list[Step]]:
    """前进一米，右转，做四遍，每次之间停一秒: what is done each time, as one unit."""
    once = len(period(units))
    if not 1 < once < len(units):
        return units
    return [[step for unit in units[k : k + once] for step in unit] for k in range(0, len(units), once)]


def insert_halfway(script: Script, frame: Frame, *, goes_on: bool = False) -> None:
    """往前两米，到一半的时候停两秒: the last motion in two halves; the first alone where it stops there for good."""
    halves = _halves(script.units[-1][0]) if script.units and len(script.units[-1]) == 1 else None
    if halves is None:
        raise Unclear("between_what", frame.text)
    inner = frame.copy()
    inner.flags -= {"halfway", "between"}
    if not inner.moves and set(inner.q) == {"time"}:
        inner.verb = "wait"
    steps = act(inner, State(), script.pace)
    if isinstance(halves[0], Arc) and not all(isinstance(step, (Wait, Say)) for step in steps):
        raise Unclear("unclear_motion", frame.text)  # half of the circle, or something half way round?
    stays = inner.verb == "halt" and not steps and not goes_on
    script.units[-1:] = [[halves[0]]] if stays else [[halves[0]], steps, [halves[1]]]


def insert_at(script: Script, place: Frame, stop: Frame) -> None:
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
        return (replace(step, distance_m=metres, duration_s=seconds),) * 2
    if isinstance(step, (Turn, Arc)) and step.angle_rad:
        return (replace(step, angle_rad=step.angle_rad / 2),) * 2
    return None


def _full_turns(unit: list[Step]) -> list[list[Step]]:
    """Several full turns in one, as one unit each: a pause fits between them."""
    if len(unit) == 1 and isinstance(unit[0], Turn) and unit[0].angle_rad:
        rounds = unit[0].angle_rad / (2 * math.pi)
        if rounds > 1.5 and abs(rounds - round(rounds)) < 1e-6:
            return [[replace(unit[0], angle_rad=2 * math.pi)]] * round(rounds)
    return [unit]
