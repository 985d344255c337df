"""`twist`: a raw velocity for a time, the tutorial's form. Limits scale it, direction kept; they never refuse it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.plan.base import Step, divide_extent, require_finite, require_positive
from chatrobot.plan.context import (
    Impossible,
    Lowered,
    LoweringContext,
    refuse_turn_on_the_spot,
    scale_into_limits,
)
from chatrobot.plan.primitive import Primitive, StepParts, divided
from chatrobot.plan.reader import LineReader, number_text
from chatrobot.plan.trajectory import Pause, RampedTwist
from chatrobot.robots.profile import RobotProfile


@dataclass(frozen=True)
class RawTwist(Step):
    """Hold a raw velocity for a time: the tutorial's form, where a line means one second."""

    vx_mps: float = 0.0
    vy_mps: float = 0.0
    wz_radps: float = 0.0
    duration_s: float = 1.0
    kind: Literal["twist"] = "twist"

    def __post_init__(self) -> None:
        require_finite(self, "vx_mps", "vy_mps", "wz_radps")
        require_positive(self, "duration_s")


class _TwistPrimitive(Primitive[RawTwist]):
    kind = verb = "twist"
    step_type = RawTwist
    usage = "twist VX VY WZ [for TIME]"
    help = "Hold a raw velocity (m/s forward, m/s to the left, rad/s counter-clockwise), 1 s if no time is given."
    examples = ("twist 0.2 0 0.5 for 3 s",)

    def parse(self, line: LineReader) -> RawTwist:
        vx = _velocity(line, "m/s", "forward")
        vy = _velocity(line, "m/s", "to the left")
        wz = _velocity(line, "rad/s", "counter-clockwise")
        duration = line.duration_s() if line.accept("for") else 1.0
        line.finish("'for 3 s' or the end of the line")
        return RawTwist(vx, vy, wz, duration)

    def format(self, step: RawTwist) -> str:
        numbers = " ".join(number_text(value) for value in (step.vx_mps, step.vy_mps, step.wz_radps))
        return f"twist {numbers} for {number_text(step.duration_s)} s"

    def lower(self, step: RawTwist, context: LoweringContext) -> Lowered:
        asked = Twist(step.vx_mps, step.vy_mps, step.wz_radps)
        if asked.is_zero:
            return [Pause(step.duration_s)]
        refused = _refuse_shape(context.profile, asked)
        if refused is not None:
            return refused
        limits = context.profile.limits
        twist = scale_into_limits(limits, asked)
        scaled = None if twist == asked else asked
        return [RampedTwist.within(limits, twist, step.duration_s, asked=scaled, is_timed=True)]

    def divide(self, step: RawTwist, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        return divided(step, "duration_s", divide_extent(step.duration_s, share))


def _velocity(line: LineReader, unit: str, direction: str) -> float:
    value = line.number(f"three numbers, here {unit} {direction}")
    line.accept(unit)
    return value


def _refuse_shape(profile: RobotProfile, twist: Twist) -> Impossible | None:
    """What no scaling mends: sideways on wheels that cannot, and a curve tighter than the steering goes."""
    if twist.vy_mps != 0.0 and not profile.can_go_sideways:
        return Impossible(Reason("sideways_impossible", {"vy_mps": twist.vy_mps}))
    if profile.can_turn_on_the_spot or twist.wz_radps == 0.0:
        return None
    if twist.vx_mps == 0.0:
        return refuse_turn_on_the_spot(profile, twist.wz_radps)
    radius_m, least_m = abs(twist.vx_mps / twist.wz_radps), profile.limits.min_turning_radius_m
    if radius_m >= least_m * (1.0 - 1e-9):
        return None
    return Impossible(Reason("turning_radius_too_small", {"radius_m": radius_m, "min_radius_m": least_m}))


PRIMITIVES = (_TwistPrimitive(),)
