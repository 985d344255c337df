"""What every step of a plan is made from: the base classes, the frames, the conditions and the checks on numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

Frame = Literal["odom", "start"]
"""`odom`: where odometry began. `start`: the robot's pose at the moment this plan starts to move."""

_FORBID = {"extra": "forbid", "allow_inf_nan": False}


def require(condition: bool, problem: str) -> None:
    """Raise ValueError with `problem` unless `condition` holds."""
    if not condition:
        raise ValueError(problem)


def require_positive(name: str, value: float | None) -> None:
    """None passes: the field was left out."""
    if value is not None:
        require(
            math.isfinite(value) and value > 0.0, f"{name} must be a finite number above zero, not {value}"
        )


def require_finite(name: str, value: float) -> None:
    require(math.isfinite(value), f"{name} must be a finite number, not {value}")


_SHORTEST = 1e-3


def divide_extent(extent: float, share: float) -> tuple[float, float]:
    """The part of `extent` (m, s) that is done, to a tenth of a millimetre, and the rest of it.

    What is shorter than a millimetre is no part of its own.
    """
    done = round(extent * share, 4)
    if done < _SHORTEST:
        return 0.0, extent
    if extent - done < _SHORTEST:
        return extent, 0.0
    return done, round(extent - done, 9)


def divide_angle(angle_rad: float, share: float) -> tuple[float, float]:
    """As `divide_extent`, to a hundredth of a degree; what is less than a twentieth of one is no part of its own."""
    done_deg = round(math.degrees(angle_rad) * share, 2)
    rest_deg = math.degrees(angle_rad) - done_deg
    if done_deg < 0.05:
        return 0.0, angle_rad
    if rest_deg < 0.05:
        return angle_rad, 0.0
    return math.radians(done_deg), math.radians(round(rest_deg, 7))


def rounded_angle(angle_rad: float, decimals: int) -> float:
    """To so many decimals of a degree."""
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
        """How often the steps inside are done."""
        raise NotImplementedError


def expanded(steps: Sequence[Step]) -> Iterator[Step]:
    """The steps with repeats counted out."""
    for step in steps:
        if isinstance(step, Block):
            for _ in range(step.times):
                yield from expanded(step.steps)
        else:
            yield step


@dataclass(frozen=True)
class ObstacleWithin:
    """True once the lidar sees something nearer than `distance_m` ahead of the footprint in the way of travel."""

    distance_m: float
    kind: Literal["obstacle_within"] = "obstacle_within"
    __pydantic_config__: ClassVar[dict[str, Any]] = _FORBID

    def __post_init__(self) -> None:
        require_positive("distance_m", self.distance_m)


Condition = ObstacleWithin
