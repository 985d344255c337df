"""What a task can ask for: how each check is read from a sheet and judged. `CHECKS` lists them by their names there.

A check says `done`, `missing` (what is left can still be done) or `broken` (a limit is broken, and stays so until the
task begins anew). All that concerns motion is measured on true poses.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from chatrobot.core.errors import PlanTextError
from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.core.reason import fixed, number
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.language.normalise import has_chinese
from chatrobot.lessons.attempt import Figures, Values
from chatrobot.plan.text import parse_plan
from chatrobot.sim.fields import Field
from chatrobot.sim.world import World

State = Literal["done", "missing", "broken"]
MOST = 1e5
"""Of any amount."""
TOUCH_M = 0.002
"""Nearer than this to a thing is touching it: the simulator lets a robot come to within 0.1 mm."""


@dataclass(frozen=True)
class Finding:
    """What one check says; `code` is a phrase of the table `lesson`. `is_limit`: it held before anything was done."""

    check: str
    state: State
    code: str
    values: Values = field(default_factory=dict)
    is_limit: bool = False

    def to_json(self) -> dict[str, Any]:
        """Make its JSON object."""
        values = {key: value[0] if isinstance(value, tuple) else value for key, value in self.values.items()}
        return {"check": self.check, "state": self.state, "code": self.code, **values}


class Check(Protocol):
    """One thing that a task asks for."""

    def judge(self, figures: Figures) -> Finding:
        """Say how it stands with a try."""
        ...


@dataclass(frozen=True)
class Range:
    """Between `low` and `high`, both included; an infinite one binds nothing."""

    low: float = -math.inf
    high: float = math.inf

    @classmethod
    def read(cls, given: Field, least: float) -> Range:
        """Read `{at_least: …, at_most: …}`, one of them or both; or a single number. None is below `least`."""
        if not given.is_mapping:
            value = given.number(least, MOST)
            return cls(value, value)
        fields = given.mapping("at_least", "at_most")
        if not fields:
            raise given.error("is empty", "at_least, at_most, or both")
        low = fields["at_least"].number(least, MOST) if "at_least" in fields else -math.inf
        high = fields["at_most"].number(least, MOST) if "at_most" in fields else math.inf
        if low > high:
            raise given.error("at_least is more than at_most", "at_least: less, at_most: more")
        return cls(low, high)

    @property
    def values(self) -> Values:
        """For a sentence: the bounds that bind."""
        bounds = {"low": self.low, "high": self.high}
        return {name: number(value) for name, value in bounds.items() if math.isfinite(value)}


@dataclass(frozen=True)
class Amount:
    """A number that was measured, within a range. One that only grows is broken above its range."""

    name: str
    range: Range
    measure: Callable[[Figures], float]
    decimals: int
    only_grows: bool = True

    def judge(self, figures: Figures) -> Finding:
        """Say `NAME_done`, `NAME_low` or `NAME_high`."""
        is_value = round(self.measure(figures), self.decimals)
        values: Values = {"is": fixed(is_value, self.decimals), **self.range.values}
        if is_value > self.range.high:
            return Finding(self.name, "broken" if self.only_grows else "missing", f"{self.name}_high", values)
        if is_value < self.range.low:
            return Finding(self.name, "missing", f"{self.name}_low", values)
        return Finding(
            self.name, "done", f"{self.name}_done", values, is_limit=not math.isfinite(self.range.low)
        )


@dataclass(frozen=True)
class Spot:
    """A place with its names, or a point of the floor as seen from where the task began (`is_seen`)."""

    pose: Pose
    names: tuple[str, ...]
    within_m: float
    is_seen: bool = False

    def off(self, begin: Pose, robot: Pose) -> Pose:
        """Return where it is as seen from the robot."""
        return (begin.compose(self.pose) if self.is_seen else self.pose).relative_to(robot)


@dataclass(frozen=True)
class EndsAt:
    """The robot stands there."""

    spot: Spot

    def judge(self, figures: Figures) -> Finding:
        """Say how far off it is, and to which side."""
        off = self.spot.off(figures.begin, figures.end)
        off_m = math.hypot(off.x_m, off.y_m)
        values: Values = {"place": self.spot.names, "off_m": fixed(off_m, 2), "way": way(off)}
        values["within_m"] = number(self.spot.within_m)
        if off_m <= self.spot.within_m and figures.measured.has_moved:
            return Finding("ends_at", "done", "ends_at_done", values)
        return Finding("ends_at", "missing", "ends_at_off" if off_m > self.spot.within_m else "still", values)


@dataclass(frozen=True)
class Passes:
    """The robot comes by these places, in this order."""

    spots: tuple[Spot, ...]

    def judge(self, figures: Figures) -> Finding:
        """Say which of them is next."""
        left = list(self.spots)
        for pose in figures.poses():
            if left and math.hypot(*left[0].off(figures.begin, pose)[:2]) <= left[0].within_m:
                left.pop(0)
        if not left:
            return Finding("passes", "done", "passes_done", {"count": len(self.spots)})
        done = len(self.spots) - len(left)
        values: Values = {"place": left[0].names, "number": done + 1, "count": len(self.spots)}
        return Finding("passes", "missing", "passes_left", values)


@dataclass(frozen=True)
class Heading:
    """How the robot looks at the end, seen from how it looked at the beginning."""

    yaw_rad: float
    within_rad: float

    def judge(self, figures: Figures) -> Finding:
        """Say how far it has to turn, and to which side."""
        off_deg = math.degrees(wrap_angle(self.yaw_rad - math.radians(figures.measured.turned_deg)))
        values: Values = {"off_deg": fixed(abs(off_deg), 0)}
        if abs(off_deg) <= math.degrees(self.within_rad):
            is_limit = abs(self.yaw_rad) <= self.within_rad
            return Finding("heading_deg", "done", "heading_done", values, is_limit)
        is_left = off_deg > 0.0 or off_deg < -179.5  # half a turn is the same to either side
        return Finding("heading_deg", "missing", "heading_left" if is_left else "heading_right", values)


@dataclass(frozen=True)
class KeepsClear:
    """The edge of the robot never comes nearer than that to anything."""

    name: str
    least_m: float

    def judge(self, figures: Figures) -> Finding:
        """Say how near it came, and to what."""
        near = figures.nearest
        if near.obstacle is None:
            return Finding(self.name, "done", f"{self.name}_free", {}, is_limit=True)
        values: Values = {
            "thing": (near.obstacle.name, *near.obstacle.aliases),
            "is": fixed(near.distance_m, 2),
            "low": number(self.least_m),
        }
        if near.distance_m < self.least_m:
            return Finding(self.name, "broken", f"{self.name}_low", values, is_limit=True)
        return Finding(self.name, "done", f"{self.name}_done", values, is_limit=True)


@dataclass(frozen=True)
class Forbidden:
    """Words that must not be used, by language or for all."""

    words: tuple[str, ...]

    def judge(self, figures: Figures) -> Finding:
        """Name the word that was used."""
        used = [word for text in figures.texts for word in self.words if _uses(text, word)]
        if used:
            return Finding("forbidden", "broken", "forbidden_used", {"word": used[0]}, is_limit=True)
        return Finding("forbidden", "done", "forbidden_done", {}, is_limit=True)


def _uses(text: str, word: str) -> bool:
    text, word = text.casefold(), word.casefold()
    return word in text if has_chinese(word) else bool(re.search(rf"(?<!\w){re.escape(word)}(?!\w)", text))


@dataclass(frozen=True)
class PlanText:
    """All that moves the robot is plan text."""

    def judge(self, figures: Figures) -> Finding:
        """Quote the text that is none."""
        for text in figures.texts:
            try:
                parse_plan(text)
            except PlanTextError:
                shown = " ".join(text.split())[:60]
                return Finding("plan_text", "broken", "plan_text_none", {"text": shown}, is_limit=True)
        return Finding("plan_text", "done", "plan_text_done", {}, is_limit=True)


@dataclass(frozen=True)
class PlanHas:
    """A plan ran that has each of these words: `repeat`, `until`, `arc`."""

    words: tuple[str, ...]

    def judge(self, figures: Figures) -> Finding:
        """Say which is missing."""
        used = {word for text in figures.plan_texts for word in re.findall(r"[a-z_]+", text.casefold())}
        missing = [word for word in self.words if word not in used]
        if missing:
            return Finding("plan_has", "missing", "plan_has_not", {"word": missing[0]})
        return Finding("plan_has", "done", "plan_has_done", {"word": ", ".join(self.words)})


@dataclass(frozen=True)
class RunsProgram:
    """A program has run to its end."""

    def judge(self, figures: Figures) -> Finding:
        """Say whether one has."""
        is_done = figures.program_count > 0
        return Finding(
            "program", "done" if is_done else "missing", "program_done" if is_done else "program_none"
        )


_WAYS = ("ahead", "ahead_left", "left", "behind_left", "behind", "behind_right", "right", "ahead_right")


def way(seen: Pose) -> str:
    """Return on which side something is that is seen there: one of `_WAYS`."""
    return _WAYS[round(math.atan2(seen.y_m, seen.x_m) / (math.pi / 4.0)) % 8]


# --- how they are read ---

_NEAR_M = 0.3
START, GOAL = ("start", "起点"), ("goal", "目标")


def read_spot(given: Field, world: World) -> Spot:
    """Read a name, `{place: NAME, within_m: …}` or `{x_m: …, y_m: …, within_m: …}`."""
    fields = given.mapping("place", "x_m", "y_m", "within_m") if given.is_mapping else {"place": given}
    within_m = fields["within_m"].size() if "within_m" in fields else _NEAR_M
    if "place" in fields and not {"x_m", "y_m"} & {*fields}:
        return read_place(fields["place"], world, within_m)
    if "place" in fields or not ("x_m" in fields and "y_m" in fields):
        raise given.error("names no place, or two", "place: NAME, or x_m and y_m from where the task begins")
    return Spot(Pose(fields["x_m"].number(), fields["y_m"].number()), GOAL, within_m, is_seen=True)


def read_place(named: Field, world: World, within_m: float = _NEAR_M) -> Spot:
    """Read the name of a place of the world, or `start`: where the task begins."""
    name = named.text()
    if name == START[0]:
        return Spot(Pose(), START, within_m, is_seen=True)
    pose, main = world.place(name), world.aliases.get(name.casefold(), name)
    if pose is None:
        raise named.unknown(f"the world {world.name} has no place {name!r}", (START[0], *world.places))
    return Spot(pose, world.names_of(main), within_m)


def _heading(given: Field, _: World) -> Check:
    fields = given.mapping("is", "within") if given.is_mapping else {"is": given}
    within_deg = fields["within"].number(0.1, 180.0) if "within" in fields else 10.0
    if "is" not in fields:
        raise given.error("is is missing", "is: 90, within: 10")
    return Heading(math.radians(fields["is"].number(-360.0, 360.0)), math.radians(within_deg))


def _words(given: Field) -> tuple[str, ...]:
    if given.is_mapping:
        return tuple(word for each in given.mapping(*REPLY_LANGUAGES).values() for word in _words(each))
    return tuple(item.text() for item in given.filled())


def _set(given: Field, check: Check) -> Check:
    given.choice("true", "True", "TRUE")
    return check


def _amount(
    name: str, measure: Callable[[Figures], float], decimals: int, *, only_grows: bool = True
) -> Callable[[Field, World], Check]:
    least = -MOST if name == "turned_deg" else 0.0
    return lambda given, _: Amount(name, Range.read(given, least), measure, decimals, only_grows)


def _gap_m(figures: Figures) -> float:
    return figures.near.at(figures.end).distance_m


def _plan_words(given: Field, _: World) -> Check:
    words: Sequence[Field] = given.filled() if given.is_list else [given]
    known = ("drive", "turn", "arc", "twist", "go", "face", "wait", "repeat", "say", "remember", "until")
    return PlanHas(tuple(word.choice(*known) for word in words))


CHECKS: Mapping[str, Callable[[Field, World], Check]] = {
    "ends_at": lambda given, world: EndsAt(read_spot(given, world)),
    "passes": lambda given, world: Passes(tuple(read_spot(item, world) for item in given.filled())),
    "heading_deg": _heading,
    "turned_deg": _amount("turned_deg", lambda it: it.measured.turned_deg, 0, only_grows=False),
    "path_m": _amount("path_m", lambda it: it.measured.path_m, 2),
    "corners": _amount("corners", lambda it: it.corner_count(), 0),
    "area_m2": _amount("area_m2", lambda it: it.area_m2(), 2),
    "time_s": _amount("time_s", lambda it: it.time_s, 1),
    "stands_s": _amount("stands_s", lambda it: it.stood_s, 1),
    "top_speed_mps": _amount("top_speed_mps", lambda it: it.measured.max_speed, 2),
    "ends_clear_m": _amount("ends_clear_m", _gap_m, 2, only_grows=False),
    "keeps_clear_m": lambda given, _: KeepsClear("keeps_clear_m", given.size()),
    "touches_nothing": lambda given, _: _set(given, KeepsClear("touches_nothing", TOUCH_M)),
    "commands": _amount("commands", lambda it: len(it.texts), 0),
    "forbidden": lambda given, _: Forbidden(_words(given)),
    "plan_text": lambda given, _: _set(given, PlanText()),
    "plan_has": _plan_words,
    "program": lambda given, _: _set(given, RunsProgram()),
}
