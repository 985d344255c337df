"""A recording as its report sees it: the ways told, measured and true, where something happened, and the sums."""

from __future__ import annotations

import bisect
import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

from chatrobot.cli.drawing.ways import where_found
from chatrobot.core.errors import WorldError
from chatrobot.core.events import (
    Event,
    Finished,
    Interpreted,
    Limited,
    ModelCalled,
    Rehearsed,
    Result,
    event_from_json,
)
from chatrobot.dialogue.replies import describe_end
from chatrobot.language.detect import language_of
from chatrobot.language.interpretation import LanguageCode, language_of_tags
from chatrobot.language.phrases import by_language
from chatrobot.recording.about import world_of
from chatrobot.recording.reader import Recording
from chatrobot.sim.world import EMPTY_WORLD, Obstacle, World
from chatrobot.wire.messages import Odometry

JUMP_M = 0.5
"""Odometry that is this far from the sample before did not drive there: its way begins anew."""
JUMP_S = 2.0
STEP_M = 0.005
"""A way is measured in steps of at least this length: odometry of a robot that stands may tremble."""
NEAR_M = 0.25
"""Stops, limits or refusals that are nearer to each other than this are one mark on the map."""
PASSING = frozenset({"telemetry", "scan", "progress", "pose"})
"""Of these only the poses of `telemetry` are told."""
DEFAULT_FOOTPRINT_M = ((0.15, 0.12), (-0.15, 0.12), (-0.15, -0.12), (0.15, -0.12))
Point = tuple[float, float, float]
Way = list[Point]


class Mark(NamedTuple):
    """Where something happened, and when: a `stop`, a `limit` or a `refusal`. `at` is None where nobody knows where."""

    kind: str
    times_s: tuple[float, ...]
    at: tuple[float, float] | None


@dataclass
class Drive:
    """What the report tells. `events` are those of ours, with their seconds; `heard` the words with their turns.

    `telemetry` is where the robot measured itself, by wheels and gyro; of a robot that others drive its odometry.
    """

    recording: Recording
    language: LanguageCode
    events: list[tuple[float, Event]] = field(default_factory=list)
    heard: list[tuple[float, int, str]] = field(default_factory=list)
    telemetry: list[tuple[float, Odometry]] = field(default_factory=list)

    @classmethod
    def of(cls, recording: Recording, language: LanguageCode | None = None) -> Drive:
        """Take a recording in; in its own language where none is chosen."""
        drive = cls(recording, language or _language_of(recording))
        for t_s, data in recording.events:
            if data["event"] in PASSING:
                drive._take_telemetry(t_s, data)
            elif data["event"] == "heard":
                drive.heard.append((t_s, _count(data.get("turn")), str(data.get("text", ""))))
            else:
                try:
                    drive.events.append((t_s, event_from_json(data)))
                except (ValueError, AttributeError):  # of another release
                    continue
        if not drive.heard:
            drive.heard = [(t_s, 0, text) for t_s, text in recording.words]
        drive.telemetry = drive.telemetry or recording.odometry
        return drive

    def _take_telemetry(self, t_s: float, data: Mapping[str, Any]) -> None:
        try:
            values = (*data["pose"].values(), *data["twist"].values())
            self.telemetry.append((t_s, Odometry(t_s, *map(float, values))))
        except (KeyError, AttributeError, TypeError, ValueError):  # another event, or of another release
            return

    # --- robot and world ---

    @cached_property
    def title(self) -> str:
        """Of the robot."""
        return self.recording.meta.get("title") or self.recording.meta.get("robot") or ""

    @cached_property
    def world(self) -> World:
        """The world of the recording, in the language of the report; an empty one where it cannot be read."""
        try:
            world = world_of(self.recording.meta)
        except WorldError:
            return EMPTY_WORLD
        return _in_language(world, self.language)

    @cached_property
    def footprint_m(self) -> Sequence[tuple[float, float]]:
        """The robot's outline, in its own frame."""
        try:
            points = [(float(x), float(y)) for x, y in json.loads(self.recording.meta["footprint_m"])]
        except (KeyError, ValueError, TypeError):
            return DEFAULT_FOOTPRINT_M
        return points if len(points) > 2 and all(map(math.isfinite, sum(points, ()))) else DEFAULT_FOOTPRINT_M

    @cached_property
    def limits(self) -> dict[str, float]:
        """The robot's limits that are known and finite, by the names of `Limits`."""
        try:
            found = json.loads(self.recording.meta.get("limits", "{}"))
        except ValueError:
            return {}
        pairs = found.items() if isinstance(found, dict) else ()
        return {key: float(value) for key, value in pairs if isinstance(value, (int, float))}

    # --- ways ---

    @cached_property
    def driven_turns(self) -> set[int]:
        """The turns that began to move the robot."""
        return {event.turn for _, event in self.events if event.name == "started"}

    @cached_property
    def rehearsals(self) -> list[tuple[float, Rehearsed]]:
        """What was told of plans that were driven then."""
        found = [(t_s, event) for t_s, event in self.events if isinstance(event, Rehearsed)]
        return [(t_s, event) for t_s, event in found if event.ok and event.turn in self.driven_turns]

    @cached_property
    def told(self) -> list[Way]:
        """The ways that rehearsal told, of plans that were driven then."""
        return [[*event.path] for _, event in self.rehearsals if event.path]

    @cached_property
    def measured(self) -> list[Way]:
        """The ways that the robot measured."""
        return _ways(self.telemetry)

    @cached_property
    def true(self) -> list[Way]:
        """The ways that the simulated robot truly took."""
        return _ways(self.recording.truth)

    def at(self, t_s: float) -> Point | None:
        """Return where the robot measured itself then; None where nothing was measured."""
        samples = self.telemetry
        index = bisect.bisect_right(samples, t_s, key=lambda sample: sample[0])
        if not samples:
            return None
        sample = samples[max(0, index - 1)][1]
        return sample.x_m, sample.y_m, sample.yaw_rad

    # --- what happened ---

    @cached_property
    def results(self) -> list[tuple[float, Result]]:
        """The end of every instruction; a stop word is none. Of an agent's turn `finished` alone tells the end."""
        stop_words = {e.turn for _, e in self.events if isinstance(e, Interpreted) and e.by == "reflex"}
        told = {e.turn for _, e in self.events if isinstance(e, Result)} | stop_words
        ends = [
            (t_s, event if isinstance(event, Result) else _as_result(event, self.language))
            for t_s, event in self.events
            if isinstance(event, Result) or (isinstance(event, Finished) and event.turn not in told)
        ]
        return [(t_s, result) for t_s, result in ends if result.turn not in stop_words]

    @cached_property
    def limited(self) -> list[tuple[float, Limited, int]]:
        """Every limit once a turn and rule, with how often it was told."""
        counts = Counter((e.turn, e.rule) for _, e in self.events if isinstance(e, Limited))
        first: dict[tuple[int, str], tuple[float, Limited]] = {}
        for t_s, event in self.events:
            if isinstance(event, Limited):
                first.setdefault((event.turn, event.rule), (t_s, event))
        return [(t_s, event, counts[key]) for key, (t_s, event) in first.items()]

    @cached_property
    def model_calls(self) -> list[ModelCalled]:
        """Every call of a language model."""
        return [event for _, event in self.events if isinstance(event, ModelCalled)]

    @cached_property
    def marks(self) -> list[Mark]:
        """Where stops, limits and refusals happened, in the order of time; the same at the same spot is one mark."""
        found = [(t_s, "limit", self._spot(t_s)) for t_s, _, _ in self.limited]
        findings = {e.turn: e for _, e in self.events if isinstance(e, Rehearsed) and not e.ok}
        for t_s, result in self.results:
            if result.outcome == "stopped":
                found.append((t_s, "stop", self._spot(t_s)))
            elif result.outcome == "refused":
                rehearsed = findings.get(result.turn)
                spot = _refused_at(rehearsed) if rehearsed is not None else None
                found.append((t_s, "refusal", spot or self._spot(t_s)))
        marks: list[Mark] = []
        for t_s, kind, at in sorted(found, key=lambda each: each[0]):
            same = next(
                (i for i, mark in enumerate(marks) if mark.kind == kind and _is_near(mark.at, at)), None
            )
            if same is None:
                marks.append(Mark(kind, (t_s,), at))
            else:
                marks[same] = marks[same]._replace(times_s=(*marks[same].times_s, t_s))
        return marks

    def _spot(self, t_s: float) -> tuple[float, float] | None:
        point = self.at(t_s)
        return point[:2] if point is not None else None

    # --- sums ---

    @property
    def told_m(self) -> float:
        """How far the driven plans were to drive."""
        return sum(event.length_m for _, event in self.rehearsals)

    @cached_property
    def measured_m(self) -> float | None:
        """How far the robot measured that it drove; None where nothing was measured."""
        return _length_m(self.measured) if self.measured else None

    @cached_property
    def true_m(self) -> float | None:
        """How far the simulated robot truly drove; None on any other."""
        return _length_m(self.true) if self.recording.truth else None

    @property
    def outcomes(self) -> Counter[str]:
        """How many turns came to what."""
        return Counter(result.outcome for _, result in self.results)


def _as_result(finished: Finished, language: str) -> Result:
    same = ("outcome", "pose", "turned_rad", "path_m", "duration_s", "paused_s", "reason", "measured")
    values = {name: getattr(finished, name) for name in same}
    return Result(finished.turn, reply=describe_end(finished, language), **values)


def _language_of(recording: Recording) -> LanguageCode:
    """The language of most that was said; where nothing was, that of the person who began."""
    begun = language_of_tags(recording.meta.get("language", ""))
    spoken = Counter(language_of(text, begun) for _, text in recording.words)
    return max(spoken, key=lambda code: spoken[code], default=begun)


def _is_near(a: tuple[float, float] | None, b: tuple[float, float] | None) -> bool:
    return math.dist(a, b) < NEAR_M if a is not None and b is not None else a is b


def _in_language(world: World, language: LanguageCode) -> World:
    """Give places, and what is called like one, their names in that language where they have one."""
    names = {name: by_language(world.names_of(name), language)[0] for name in world.places}
    by_folded = {name.casefold(): shown for name, shown in names.items()}

    def shown_name(one: Obstacle) -> str:
        shown = by_language((one.name, *one.aliases), language)[0]
        return shown if shown != one.name else by_folded.get(one.name.casefold(), one.name)

    return replace(
        world,
        places={names[name]: pose for name, pose in world.places.items()},
        obstacles=tuple(replace(one, name=shown_name(one)) for one in world.obstacles),
    )


def _count(value: Any) -> int:
    return value if isinstance(value, int) else 0


def _ways(samples: Sequence[tuple[float, Odometry]]) -> list[Way]:
    ways: list[Way] = []
    last: tuple[float, Odometry] | None = None
    for t_s, at in samples:
        if not (math.isfinite(at.x_m) and math.isfinite(at.y_m) and math.isfinite(at.yaw_rad)):
            continue
        if last is None or t_s - last[0] > JUMP_S or math.dist(at[1:3], last[1][1:3]) > JUMP_M:
            ways.append([])
        ways[-1].append((at.x_m, at.y_m, at.yaw_rad))
        last = t_s, at
    return ways


def _length_m(ways: Sequence[Way]) -> float:
    return sum(_way_m(way) for way in ways)


def _way_m(way: Way) -> float:
    length_m, last = 0.0, way[0]
    for point in way:
        step_m = math.dist(point[:2], last[:2])
        if step_m >= STEP_M:
            length_m, last = length_m + step_m, point
    return length_m + math.dist(way[-1][:2], last[:2])


def _refused_at(rehearsed: Rehearsed) -> tuple[float, float] | None:
    refusals = (finding for finding in rehearsed.findings if finding.severity == "refuse")
    spots = (where_found(rehearsed, finding) for finding in refusals)
    return next((spot for spot in spots if spot is not None), None)
