"""Frames → steps: what is shared by several clauses, repeats, pauses in between, and the order of things."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from chatrobot.language.actions import State, act
from chatrobot.language.clauses import is_times_only
from chatrobot.language.frames import STILL, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.shapes import draw
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import MAX_REPEAT, Go, Repeat, Say, Step, Turn, Wait


@dataclass
class Memory:
    """What this dialogue knows: places by name, words that a person defined, and what the last motion left."""

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
    frames = _shared(frames)
    count, frames = _leading_count(frames)
    script = Script(pace, memory, state=memory.state)
    i = 0
    while i < len(frames):
        i = _take(script, frames, i)
    if count is not None:
        script.units = _repeated(script.units, count)
    steps = script.steps()
    if not steps:
        raise Unclear("nothing_to_do")
    return steps


def _shared(frames: list[Frame]) -> list[Frame]:
    """`…, both forward`, 都往左转: a clause that holds for all the others."""
    kept: list[Frame] = []
    for frame in frames:
        if "all" not in frame.flags or frame.q or not (frame.direction or frame.rot or frame.pace) or frame.shape:
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


def _leading_count(frames: list[Frame]) -> tuple[int | None, list[Frame]]:
    """`Twice: …`, `the following three times: …`."""
    if len(frames) > 1 and is_times_only(frames[0]) and frames[1].joined in ("colon", "weak", "none", "strong"):
        return _count(frames[0]), frames[1:]
    return None, frames


def _count(frame: Frame) -> int:
    quantity = frame.q.get("times") or frame.q["count"]
    value = quantity.number
    if value != value or not 1 <= value <= MAX_REPEAT or value != int(value):
        raise Unclear("bad_count", quantity.text)
    return int(value)


def _take(script: Script, frames: list[Frame], i: int) -> int:
    frame = frames[i]
    if frame.shape:
        end, steps = draw(frames, i, script.pace)
        _finish(script, frame, [steps])
        return end
    if is_times_only(frame) or ("again" in frame.flags and not frame.moves and {"times", "count"} & set(frame.q)):
        script.units = _repeated(script.units, _count(frame))
    elif "again" in frame.flags and not frame.moves and not frame.has_extent:
        if not script.units:
            raise Unclear("nothing_before", frame.text)
        script.units.append(script.units[-1])
    elif frame.flags & {"between", "after_each"}:
        _insert(script, frame)
    else:
        _act(script, frame)
    return i + 1


def _act(script: Script, frame: Frame) -> None:
    count, each = 1, frame
    if "count" in frame.q and "length" in frame.q:
        count = _count(Frame(q={"times": frame.q["count"]}))
        each = frame.copy()
        del each.q["count"]
    elif "count" in frame.q:
        raise Unclear("how_long_a_step", frame.q["count"].text)
    if "times" in frame.q:
        count *= _count(Frame(q={"times": frame.q["times"]}))
    steps = _known(each, script) or act(each, script.state, script.pace)
    script.state.steps.extend(steps * count)
    script.units.extend([steps] * count if steps else [])


def _known(frame: Frame, script: Script) -> list[Step]:
    """The steps of a word that was defined, or the way to a place that was named; else none."""
    if frame.verb == "defined":
        return list(script.memory.words[frame.words])
    if not frame.place:
        return []
    if frame.verb not in ("", "go", "return", "make", "shift", "halt") or frame.has_extent or frame.rot:
        raise Unclear("unclear_motion", frame.text)
    go = script.memory.places[frame.place]
    script.state.last = "go"
    return [replace(go, speed_mps=script.pace.speed(frame))]


def _finish(script: Script, frame: Frame, units: list[list[Step]]) -> None:
    for unit in units:
        script.state.steps.extend(unit)
    script.units.extend(units)


def _insert(script: Script, frame: Frame) -> None:
    """A pause or a motion between the units, or after each of them."""
    steps = act(frame, script.state, script.pace)
    moving = [u for u in script.units if not all(isinstance(s, Wait) for s in u)]
    if len(moving) < 2 and not ("after_each" in frame.flags and moving):
        raise Unclear("between_what", frame.text)
    pause = all(isinstance(s, (Wait, Say)) for s in steps)
    units: list[list[Step]] = []
    for k, unit in enumerate(moving):
        units.append(unit)
        if k + 1 < len(moving) or ("after_each" in frame.flags and not pause):
            units.append(steps)
    script.units = units


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
