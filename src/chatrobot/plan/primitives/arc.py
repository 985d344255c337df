"""arc: part of a circle about a point to the left or right, forward or backward."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.core.geometry import Twist
from chatrobot.plan.base import Step, divide_angle, require_positive
from chatrobot.plan.context import Impossible, Lowered, LoweringContext
from chatrobot.plan.core_motion import RampedTwist
from chatrobot.plan.primitive import Primitive, StepParts, step_parts
from chatrobot.plan.reader import LineReader
from chatrobot.plan.speeds import choose_arc_speed
from chatrobot.plan.units import angle_text, number_text


@dataclass(frozen=True)
class Arc(Step):
    """Drive a circular arc of `radius_m` about a point to the left or right, through `angle_rad` (positive).

    Forward about a point to the left the heading turns left; backward about a point to the left it turns right.
    """

    radius_m: float
    angle_rad: float
    left: bool = True
    backward: bool = False
    speed_mps: float | None = None
    kind: Literal["arc"] = "arc"

    def __post_init__(self) -> None:
        require_positive("radius_m", self.radius_m)
        require_positive("angle_rad", self.angle_rad)
        require_positive("speed_mps", self.speed_mps)


class ArcPrimitive(Primitive[Arc]):
    kind = verb = "arc"
    step_type = Arc
    usage = "arc [back] left | right ANGLE radius DISTANCE [at SPEED]"
    help = "Drive part of a circle whose centre lies to the left or right; 360 deg is a full circle."
    examples = ("arc left 90 deg radius 0.5 m", "arc back right 180 deg radius 1 m at 0.2 m/s")

    def parse(self, line: LineReader) -> Arc:
        backward = bool(line.accept("back", "backward", "backwards"))
        line.accept("forward", "forwards")
        left = line.expect("left", "right") == "left"
        angle = line.angle_rad()
        line.accept("with")
        line.expect("radius")
        radius = line.length_m()
        speed = line.speed_mps() if line.accept("at") else None
        line.finish("'at 0.2 m/s' or the end of the line")
        return Arc(radius, angle, left, backward, speed)

    def format(self, step: Arc) -> str:
        words = ["arc back" if step.backward else "arc", "left" if step.left else "right"]
        words += [angle_text(step.angle_rad), f"radius {number_text(step.radius_m)} m"]
        if step.speed_mps is not None:
            words.append(f"at {number_text(step.speed_mps)} m/s")
        return " ".join(words)

    def lower(self, step: Arc, context: LoweringContext) -> Lowered:
        speed = choose_arc_speed(context.profile, step.speed_mps, step.radius_m)
        if isinstance(speed, Impossible):
            return speed
        vx = -speed if step.backward else speed
        wz = vx / step.radius_m if step.left else -vx / step.radius_m
        return [
            RampedTwist.within(
                context.profile.limits, Twist(vx, 0.0, wz), step.angle_rad * step.radius_m / speed
            )
        ]

    def divide(self, step: Arc, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        angles = divide_angle(step.angle_rad, share)
        return step_parts(angles, lambda part: replace(step, angle_rad=part))


PRIMITIVE = ArcPrimitive()
