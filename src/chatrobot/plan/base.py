"""A plan, and what each of its steps is made from: base classes, frames, conditions and checks on numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal, cast

from chatrobot.core.errors import PlanError

Frame = Literal["odom", "start"]
"""`odom`: where odometry began. `start`: the robot's pose at the moment this plan starts to move."""

_FORBID = {"extra": "forbid", "allow_inf_nan": False}


def require(condition: bool, problem: str) -> None:
    """Raise PlanError with `problem` unless `condition` holds."""
    if not condition:
        raise PlanError(problem)


def require_positive(step: object, *names: str) -> None:
    """Raise PlanError for a field that is not above zero, or infinite. None passes: it was left out."""
    for name in names:
        value = getattr(step, name)
        ok = value is None or (math.isfinite(value) and value > 0.0)
        require(ok, f"{name} must be a finite number above zero, not {value}")


def require_finite(step: object, *names: str) -> None:
    """Raise PlanError for a field that is NaN or infinite. None passes."""
    for name in names:
        value = getattr(step, name)
        require(value is None or math.isfinite(value), f"{name} must be a finite number, not {value}")


_SHORTEST = 1e-3


def divide_extent(value: float, share: float) -> tuple[float, float]:
    """Return the part of `value` (m, s) that is done, to a tenth of a millimetre, and the rest of it.

    What is shorter than a millimetre is no part of its own.
    """
    done = round(value * share, 4)
    if done < _SHORTEST:
        return 0.0, value
    if value - done < _SHORTEST:
        return value, 0.0
    return done, round(value - done, 9)


def divide_angle(angle_rad: float, share: float) -> tuple[float, float]:
    """Divide as `divide_extent`, to a hundredth of a degree; less than a twentieth of one is no part of its own."""
    done_deg = round(math.degrees(angle_rad) * share, 2)
    rest_deg = math.degrees(angle_rad) - done_deg
    if done_deg < 0.05:
        return 0.0, angle_rad
    if rest_deg < 0.05:
        return angle_rad, 0.0
    return math.radians(done_deg), math.radians(round(rest_deg, 7))


def rounded_angle(angle_rad: float, decimals: int) -> float:
    """Return the angle, rad, rounded to so many decimals of a degree."""
    return math.radians(round(math.degrees(angle_rad), decimals))


class Step:
    """One line of a plan. Every primitive is a frozen dataclass on top of this, with a `kind` of its own."""

    kind: str
    __pydantic_config__: ClassVar[dict[str, Any]] = _FORBID

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        """A field typed `Step` takes a step that was read already (the JSON form reads from the inside out)."""
        if cls is not Step:
            return handler(source)
        from pydantic_core import core_schema

        return core_schema.is_instance_schema(Step)

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: Any, handler: Any) -> Any:
        return {"type": "object"} if cls is Step else handler(schema)


class Block(Step):
    """A step that holds other steps and is closed by `end`."""

    steps: tuple[Step, ...]

    @property
    def times(self) -> int:
        """Return how often the steps inside are done."""
        raise NotImplementedError


def expanded(steps: Sequence[Step]) -> Iterator[Step]:
    """Yield the steps with repeats counted out."""
    for step in steps:
        if isinstance(step, Block):
            for _ in range(step.times):
                yield from expanded(step.steps)
        else:
            yield step


def with_each(step: Step, change: Callable[[Step], Step]) -> Step:
    """Return `step` changed; of a block, with each of the steps inside changed."""
    if not isinstance(step, Block):
        return change(step)
    inside: dict[str, Any] = {"steps": tuple(with_each(each, change) for each in step.steps)}
    return cast(Step, replace(cast(Any, step), **inside))


@dataclass(frozen=True)
class ObstacleWithin:
    """True once the lidar sees something nearer than `distance_m` ahead of the footprint in the way of travel."""

    distance_m: float
    kind: Literal["obstacle_within"] = "obstacle_within"
    __pydantic_config__: ClassVar[dict[str, Any]] = _FORBID

    def __post_init__(self) -> None:
        require_positive(self, "distance_m")


Condition = ObstacleWithin


MAX_LINES = 1000
MAX_NESTING = 8
MAX_EXPANDED_STEPS = 10_000


@dataclass(frozen=True)
class Plan:
    """A plan: what the robot is to do, in order. At most 1000 lines, 8 blocks deep, 10 000 steps with repeats done."""

    steps: tuple[Step, ...]

    def __post_init__(self) -> None:
        require(len(self.steps) > 0, "a plan needs at least one step")
        require(_nesting(self.steps) <= MAX_NESTING, f"blocks are nested at most {MAX_NESTING} deep")
        require(_lines(self.steps) <= MAX_LINES, f"a plan has at most {MAX_LINES} lines")
        count, most = count_steps(self.steps), MAX_EXPANDED_STEPS
        require(count <= most, f"a plan does at most {most} steps in all, not {count}")


def count_steps(steps: Iterable[Step]) -> int:
    """Return how many steps are done in all, repeats counted out."""
    return sum(step.times * count_steps(step.steps) if isinstance(step, Block) else 1 for step in steps)


def _lines(steps: Iterable[Step]) -> int:
    return sum(2 + _lines(step.steps) if isinstance(step, Block) else 1 for step in steps)


def _nesting(steps: Iterable[Step]) -> int:
    return max((1 + _nesting(step.steps) if isinstance(step, Block) else 0 for step in steps), default=0)
