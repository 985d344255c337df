"""What the session hands to the interpreter: what was said and done before, and how the robot is now."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.language.compiled import Key
from chatrobot.language.data_files import LANGUAGES
from chatrobot.language.gloss import gloss
from chatrobot.language.interpretation import LanguageCode, Usual
from chatrobot.language.ledger import Ledger, TurnRecord
from chatrobot.language.lexicon import cut
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import by_language
from chatrobot.plan.steps import Plan


@dataclass(frozen=True)
class Place:
    """A remembered pose in the odom frame. `usable` is False where an earlier session remembered it (`Places`)."""

    pose: Pose
    usable: bool = True


class Thing(NamedTuple):
    """Something that stands on the map, by its names; `off_m` tells how far a point is from it, metres.

    `is_added`: a person put it into the simulation, and may take it away.
    """

    names: tuple[str, ...]
    off_m: Callable[[float, float], float]
    is_added: bool = False

    def keys(self, language: str) -> list[Key]:
        """Return its names as they are read where they are said in that language."""
        keys = [cut(normalise(name)) for name in self.names]
        if language not in LANGUAGES:  # with a number behind it: a noun alone is read as a remark
            spoken = by_language(self.names, language)[0]
            keys.append(cut(normalise(gloss(f"{spoken} 1", language).text))[:-1])
        return keys


@dataclass(frozen=True)
class Dialogue:
    """What was said before. `pending` is the text of the previous turn if that was asked back about.

    `held` is the plan that the previous turn left waiting for a `go`; `offered` the one that it asked about.
    """

    turns: tuple[TurnRecord, ...] = ()
    places: Mapping[str, Place] = field(default_factory=dict)
    words: Mapping[str, Plan] = field(default_factory=dict)
    usual: Usual = field(default_factory=Usual)
    start_pose: Pose = ORIGIN
    pending: str = ""
    held: Plan | None = None
    offered: Plan | None = None

    @property
    def last_motion(self) -> TurnRecord | None:
        """The last turn that had a plan."""
        return next((turn for turn in reversed(self.turns) if turn.plan is not None), None)

    @property
    def refused(self) -> TurnRecord | None:
        """The last turn whose plan was refused, where none has moved since."""
        last = next((turn for turn in reversed(self.turns) if turn.wanted is not None or turn.moved), None)
        return last if last is not None and last.wanted is not None else None

    @property
    def last_text(self) -> str:
        """What the last turn that had a plan was told; empty where there was none."""
        return self.last_motion.text if self.last_motion is not None else ""

    @cached_property
    def ledger(self) -> Ledger:
        """What of it can be undone, and done again."""
        return Ledger(self.turns)


@dataclass(frozen=True)
class RobotState:
    """How the robot is at this moment, in the odom frame. None: not known.

    `has_said_so` is False before its odometry has been heard: pose, twist and path are then nothing to tell.
    `is_measured` is False where it has no odometry: they never will be. `sectors_m`: how far it is to what the
    lidar sees, by eight sectors from straight ahead counter-clockwise; None where that is nothing; empty without one.
    """

    pose: Pose = ORIGIN
    twist: Twist = ZERO_TWIST
    moving: bool = False
    path_m: float = 0.0
    battery_percent: float | None = None
    obstacle_m: float | None = None
    sectors_m: tuple[float | None, ...] = ()
    has_said_so: bool = True
    is_measured: bool = True


@dataclass(frozen=True)
class Context:
    """All that an interpretation depends on besides the text.

    `world_places` are names the world's map knows, `place_names` the same put together, place by place;
    `places_without_heading` are those of them that it gives no heading. `ways` tells how long the way from one pose to
    another is on the map, metres; `rings` the corners of the way
    once around what stands at a pose, in the odom frame, none where nothing does; both are None where there is no map.
    `things` is what has a name and stands in the way there.
    `language` is that of what was said before;
    None where only the turns tell it.
    """

    dialogue: Dialogue = field(default_factory=Dialogue)
    state: RobotState = field(default_factory=RobotState)
    world_places: Mapping[str, Pose] = field(default_factory=dict)
    places_without_heading: frozenset[str] = frozenset()
    place_names: tuple[tuple[str, ...], ...] = ()
    ways: Callable[[Pose, Pose], float | None] | None = None
    rings: Callable[[Pose], Sequence[tuple[float, float]]] | None = None
    along: Callable[[Pose, Pose, float], tuple[float, float] | None] | None = None
    language: LanguageCode | None = None
    things: tuple[Thing, ...] = ()

    @property
    def has_ways(self) -> bool:
        """Whether there is a map to find ways on."""
        return self.ways is not None

    def way_m(self, goal: Pose) -> float | None:
        """How long the way is that the robot would drive to a place from here; None where none is known."""
        return self.ways(self.state.pose, goal) if self.ways is not None else None
