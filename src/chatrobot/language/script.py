"""What is written so far, a unit a clause, and the clause that is added to it as it stands."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from chatrobot.language.actions import act
from chatrobot.language.around import AROUND
from chatrobot.language.changes import changed
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import PLACE_HEADING, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.standing import lies_on_the_way
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import MAX_REPEAT, Arc, Drive, Face, Go, Step, Turn, Wait


@dataclass
class Memory:
    """What this dialogue knows: places by name, words that a person defined, and what the last motion left."""

    places: Mapping[str, Go] = field(default_factory=dict)
    words: Mapping[str, tuple[Step, ...]] = field(default_factory=dict)
    state: State = field(default_factory=State)
    around: Callable[[Go], list[Go]] | None = None
    standing: Callable[[str, Mapping[str, Go]], Go | None] | None = None
    facing: Callable[[Go, Sequence[Step]], Face] | None = None


@dataclass
class Script:
    """The steps so far, a unit a clause (a repeated clause counts once a time)."""

    pace: Pace
    memory: Memory
    units: list[list[Step]] = field(default_factory=list)
    state: State = field(default_factory=State)

    def steps(self) -> list[Step]:
        """All the steps, in order."""
        return [step for unit in self.units for step in unit]

    def add(self, unit: list[Step]) -> None:
        """One more unit, which goes on from those before."""
        self.state.steps.extend(unit)
        self.units.append(unit)


_HOW = {"speed", "rate", "faster", "scale", "percent", "fold"}
_TO_A_PLACE = ("", "go", "return", "make", "shift", "halt")


def whole_count(said: Atom) -> int:
    """How often, as a whole number.

    Raises:
        Unclear: where it is none, or more than a plan can hold.
    """
    value = said.number
    if value != value or not 1 <= value <= MAX_REPEAT or value != int(value):
        raise Unclear("bad_count", said.text)
    return int(value)


def count_of(frame: Frame) -> int:
    """How often, by the `times` or the count that a frame says."""
    return whole_count(frame.q.get("times") or frame.q["count"])


def act_out(script: Script, frame: Frame) -> None:
    """Adds what a frame means to the script, as often as it says itself.

    Raises:
        Unclear: where it cannot be acted on.
    """
    count, each = _counted(frame, script.state)
    if "times" in frame.q:
        count *= whole_count(frame.q["times"])
        if _is_split(frame):
            each = _part(each, count)
    each = _relative_to_last(each, script)
    script.state.steps = script.steps()  # what was repeated, too: the way back is as long as all of it
    steps = _known(each, script) or act(each, script.state, script.pace)
    script.state.steps.extend(steps * count)
    script.units.extend([steps] * count if steps else [])


def _is_split(frame: Frame) -> bool:
    """`2 m in four legs`: the amount is that of all of them."""
    return "split" in frame.flags and "each" not in frame.flags


def _counted(frame: Frame, state: State) -> tuple[int, Frame]:
    """`three legs of 50 cm`, `take two steps`: how many, and one of them; `two steps back`, after five of 20 cm."""
    if "count" not in frame.q:
        return 1, frame
    each, said = frame.copy(), frame.q["count"]
    del each.q["count"]
    if "length" in frame.q:
        count = whole_count(said)
        if _is_split(frame):
            length = frame.q["length"]
            each.q["length"] = quantity("length", length.number / count, length.text)
        return count, each
    size_m = state.sizes.get("step")
    if said.role in ("step", "move") and size_m is not None and not each.has_extent:
        each.q["length"] = quantity("length", size_m, said.text)
        return whole_count(said), each
    if said.role != "move":
        raise Unclear("how_long_a_step", said.text)
    each.flags.add("bit")
    return 1, each


def _part(frame: Frame, count: int) -> Frame:
    part = frame.copy()
    for name in ("length", "angle", "turns", "time"):
        if name in part.q:
            part.q[name] = quantity(name, part.q[name].number / count, part.q[name].text)
    return part


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


def _says_how(frame: Frame) -> bool:
    """`Hop slowly`, `hop twice as far`: whether the word is to be done in another way than it was taught."""
    return bool(
        frame.pace or frame.direction or frame.rot or _HOW & frame.q.keys() or "other_way" in frame.flags
    )


def _without_times(frame: Frame) -> Frame:
    frame = frame.copy()
    frame.q.pop("times", None)
    return frame


def _known(frame: Frame, script: Script) -> list[Step]:
    """The steps of a word that was defined, or the way to a place that was named; else none."""
    if frame.verb == "defined":
        if "number" in frame.q:
            raise Unclear("unclear_motion", frame.text)  # `half a hop`
        steps = list(script.memory.words[frame.words])
        return changed(steps, _without_times(frame), script.pace) if _says_how(frame) else steps
    if not frame.place:
        return []
    goes_around = AROUND in frame.flags
    turns = bool(frame.rot) and not goes_around
    partly = "number" in frame.q or "halfway" in frame.flags  # `half to the sofa` is not all of the way
    looks = frame.verb == "face" and not (frame.direction or frame.rot or goes_around)
    if (frame.verb not in _TO_A_PLACE and not looks) or frame.has_extent or turns or partly:
        raise Unclear("unclear_motion", frame.text)
    places, standing = script.memory.places, script.memory.standing
    go = places.get(frame.place) or (standing(frame.place, places) if standing else None)
    if go is None:
        raise Unclear("place_unusable", frame.place)
    if lies_on_the_way(frame.place) and not all(
        isinstance(step, (Turn, Wait)) for step in script.state.steps
    ):
        raise Unclear(
            "unclear_motion", frame.text
        )  # `go to the desk, then 1 m towards the kitchen`: from there
    faces = PLACE_HEADING in frame.flags
    if faces and go.yaw_rad is None:
        raise Unclear("place_has_no_heading", frame.place)
    if looks and script.memory.facing is not None:
        script.state.last = "turn"
        turn = script.memory.facing(go, script.state.steps)
        return [replace(turn, rate_radps=script.pace.rate(frame))]
    script.state.last = "go"
    if goes_around and script.memory.around is not None:
        ring = script.memory.around(go)
        ring = ring[::-1] if frame.rot == "right" else ring
        return [replace(one, speed_mps=script.pace.speed(frame)) for one in ring]
    return [replace(go, yaw_rad=go.yaw_rad if faces else None, speed_mps=script.pace.speed(frame))]
