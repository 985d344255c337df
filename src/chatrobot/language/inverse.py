"""Steps undone, the same way back; steps with left and right exchanged."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence

from chatrobot.language.frames import DIRECTIONS
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Face, Go, RawTwist, Remember, Repeat, Say, Step, Turn, Wait


def inverse(steps: list[Step], speed_mps: float | None = None) -> list[Step]:
    """The same way back, backwards: the last step first, each undone.

    Raises:
        Unclear: for a step that cannot be undone step by step.
    """
    undone: list[Step] = []
    for step in reversed(steps):
        undone.extend(_undone(step, speed_mps))
    return undone


def _undone(step: Step, speed_mps: float | None) -> list[Step]:
    if isinstance(step, Drive) and step.until is None:
        back = math.remainder(step.direction_rad + math.pi, 2 * math.pi)
        if speed_mps and step.speed_mps and step.duration_s:  # `5 s at 0.1 m/s, back twice as fast`
            return [Drive(step.speed_mps * step.duration_s, None, back, speed_mps)]
        return [Drive(step.distance_m, step.duration_s, back, speed_mps or step.speed_mps)]
    if isinstance(step, Turn):
        return [Turn(step.angle_rad, step.duration_s, not step.left, step.rate_radps)]
    if isinstance(step, Arc):
        return [Arc(step.radius_m, step.angle_rad, step.left, not step.backward, speed_mps or step.speed_mps)]
    if isinstance(step, RawTwist):
        return [RawTwist(-step.vx_mps, -step.vy_mps, -step.wz_radps, step.duration_s)]
    if isinstance(step, Repeat):
        inner = inverse(list(step.steps), speed_mps)
        return [Repeat(step.count, tuple(inner))] if inner else []
    if isinstance(step, (Wait, Say, Remember)):
        return []
    raise Unclear("cannot_undo")


def leaves_of(steps: Sequence[Step]) -> Iterator[Step]:
    """The steps, and of a repeat those that are repeated."""
    for step in steps:
        if isinstance(step, Repeat):
            yield from leaves_of(step.steps)
        else:
            yield step


def flipped(step: Step) -> Step:
    """The step with left and right exchanged.

    Raises:
        Unclear: for a step that is to a place or a heading.
    """
    if isinstance(step, Repeat):
        return Repeat(step.count, tuple(flipped(inner) for inner in step.steps))
    if isinstance(step, RawTwist):
        return dataclasses.replace(step, vy_mps=-step.vy_mps, wz_radps=-step.wz_radps)
    if isinstance(step, (Go, Face)):
        raise Unclear("nothing_before")
    if isinstance(step, (Turn, Arc)):
        return dataclasses.replace(step, left=not step.left)
    if isinstance(step, Drive) and is_sideways(step):
        return dataclasses.replace(step, direction_rad=-step.direction_rad)
    return step


def is_sideways(step: Step) -> bool:
    """Whether it drives any other way than ahead or back."""
    return isinstance(step, Drive) and step.direction_rad not in (DIRECTIONS["forward"], DIRECTIONS["back"])
