"""turn: on the spot, by an angle or for a time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.core.geometry import Twist
from chatrobot.plan.base import Step, divide_angle, divide_extent, require, require_positive
from chatrobot.plan.context import Impossible, Lowered, LoweringContext
from chatrobot.plan.core_motion import RampedTwist
from chatrobot.plan.primitive import Primitive, StepParts, step_parts
from chatrobot.plan.reader import LineReader
from chatrobot.plan.speeds import choose_rate, refuse_turn_on_the_spot
from chatrobot.plan.units import angle_text, number_text


@dataclass(frozen=True)
class Turn(Step):
    """Turn on the spot: `angle_rad` (positive; any size, 2 pi is a full turn) or `duration_s`, to the left or right."""

    angle_rad: float | None = None
    duration_s: float | None = None
    left: bool = True
    rate_radps: float | None = None
    kind: Literal["turn"] = "turn"

    def __post_init__(self) -> None:
        require_positive("angle_rad", self.angle_rad)
        require_positive("duration_s", self.duration_s)
        require_positive("rate_radps", self.rate_radps)
        require(
            (self.angle_rad is None) != (self.duration_s is None),
            "a turn needs an angle or a duration, and not both (say the rate instead)",
        )


class TurnPrimitive(Primitive[Turn]):
    kind = verb = "turn"
    step_type = Turn
    usage = "turn left | right ANGLE | TIME [at RATE]"
    help = "Turn on the spot."
    examples = ("turn left 90 deg at 0.5 rad/s", "turn right 2 s")

    def parse(self, line: LineReader) -> Turn:
        left = line.expect("left", "right") == "left"
        line.accept("for", "by")
        angle, duration = line.angle_or_duration()
        rate = line.rate_radps() if line.accept("at") else None
        line.finish("'at 0.5 rad/s' or the end of the line")
        return Turn(angle, duration, left, rate)

    def format(self, step: Turn) -> str:
        words = ["turn", "left" if step.left else "right"]
        if step.angle_rad is not None:
            words.append(angle_text(step.angle_rad))
        if step.duration_s is not None:
            words.append(f"{number_text(step.duration_s)} s")
        if step.rate_radps is not None:
            words.append(f"at {angle_text(step.rate_radps, suffix='/s', prefer_degrees=False)}")
        return " ".join(words)

    def lower(self, step: Turn, context: LoweringContext) -> Lowered:
        sign = 1.0 if step.left else -1.0
        rate = choose_rate(context.profile, step.rate_radps)
        if isinstance(rate, Impossible):
            return rate
        hold_s = step.duration_s if step.duration_s is not None else (step.angle_rad or 0.0) / rate
        refused = refuse_turn_on_the_spot(context.profile, sign * rate * hold_s)
        if refused is not None:
            return refused
        twist, is_timed = Twist(0.0, 0.0, sign * rate), step.duration_s is not None
        return [RampedTwist.within(context.profile.limits, twist, hold_s, is_timed=is_timed)]

    def divide(self, step: Turn, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        if step.angle_rad is not None:
            angles = divide_angle(step.angle_rad, share)
            return step_parts(angles, lambda part: replace(step, angle_rad=part))
        times = divide_extent(step.duration_s or 0.0, share)
        return step_parts(times, lambda part: replace(step, duration_s=part))


PRIMITIVE = TurnPrimitive()
