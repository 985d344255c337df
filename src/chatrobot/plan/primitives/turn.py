"""Rotations: `turn` on the spot, `face` a heading, and `arc`, part of a circle about a point to the left or right."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.core.geometry import Pose, Twist, wrap_angle
from chatrobot.plan.base import (
    Frame,
    Step,
    divide_angle,
    divide_extent,
    require,
    require_finite,
    require_positive,
    rounded_angle,
)
from chatrobot.plan.context import (
    Impossible,
    Lowered,
    LoweringContext,
    choose_arc_speed,
    choose_rate,
    refuse_turn_on_the_spot,
)
from chatrobot.plan.legs import turn_to
from chatrobot.plan.primitive import Primitive, StepParts, divided
from chatrobot.plan.reader import LineReader, angle_text, at_rate, at_speed, number_text
from chatrobot.plan.trajectory import RampedTwist


@dataclass(frozen=True)
class Turn(Step):
    """Turn on the spot: `angle_rad` (positive; any size, 2 pi is a full turn) or `duration_s`, to the left or right."""

    angle_rad: float | None = None
    duration_s: float | None = None
    left: bool = True
    rate_radps: float | None = None
    kind: Literal["turn"] = "turn"

    def __post_init__(self) -> None:
        require_positive(self, "angle_rad", "duration_s", "rate_radps")
        require(
            (self.angle_rad is None) != (self.duration_s is None),
            "a turn needs an angle or a duration, and not both (say the rate instead)",
        )


class _TurnPrimitive(Primitive[Turn]):
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
        extent = f"{number_text(step.duration_s)} s" if step.duration_s else angle_text(step.angle_rad or 0.0)
        return f"turn {'left' if step.left else 'right'} {extent}{at_rate(step.rate_radps)}"

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
            return divided(step, "angle_rad", divide_angle(step.angle_rad, share))
        return divided(step, "duration_s", divide_extent(step.duration_s or 0.0, share))


@dataclass(frozen=True)
class Face(Step):
    """Turn on the spot, the short way, until the heading in `frame` is `yaw_rad`."""

    yaw_rad: float
    frame: Frame = "start"
    rate_radps: float | None = None
    kind: Literal["face"] = "face"

    def __post_init__(self) -> None:
        require_finite(self, "yaw_rad")
        require_positive(self, "rate_radps")


class _FacePrimitive(Primitive[Face]):
    kind = verb = "face"
    step_type = Face
    needs_pose = True
    usage = "face ANGLE [from start] [at RATE]"
    help = "Turn the short way to a heading of the map, or ('from start') of where this plan began."
    examples = ("face 90 deg", "face 0 deg from start")

    def parse(self, line: LineReader) -> Face:
        yaw = line.angle_rad()
        frame: Frame = "odom"
        if line.accept("from"):
            line.expect("start")
            frame = "start"
        rate = line.rate_radps() if line.accept("at") else None
        line.finish("'from start', 'at 0.5 rad/s' or the end of the line")
        return Face(yaw, frame, rate)

    def format(self, step: Face) -> str:
        start = " from start" if step.frame == "start" else ""
        return f"face {angle_text(step.yaw_rad)}{start}{at_rate(step.rate_radps)}"

    def lower(self, step: Face, context: LoweringContext) -> Lowered:
        heading = context.frame_pose(step.frame).yaw_rad + step.yaw_rad
        return turn_to(context.profile, context.pose, heading, step.rate_radps)

    def divide(self, step: Face, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        yaw_rad = rounded_angle(wrap_angle(context.pose.yaw_rad), 2)
        return Face(yaw_rad, "odom", step.rate_radps), step

    def resolve(self, step: Face, plan_start: Pose) -> Face:
        if step.frame == "odom":
            return step
        yaw_rad = rounded_angle(wrap_angle(plan_start.yaw_rad + step.yaw_rad), 6)
        return replace(step, yaw_rad=yaw_rad, frame="odom")


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
        require_positive(self, "radius_m", "angle_rad", "speed_mps")


class _ArcPrimitive(Primitive[Arc]):
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
        side = f"{'back ' if step.backward else ''}{'left' if step.left else 'right'}"
        way = f"{angle_text(step.angle_rad)} radius {number_text(step.radius_m)} m"
        return f"arc {side} {way}{at_speed(step.speed_mps)}"

    def lower(self, step: Arc, context: LoweringContext) -> Lowered:
        speed = choose_arc_speed(context.profile, step.speed_mps, step.radius_m)
        if isinstance(speed, Impossible):
            return speed
        vx = -speed if step.backward else speed
        wz = vx / step.radius_m if step.left else -vx / step.radius_m
        hold_s = step.angle_rad * step.radius_m / speed
        return [RampedTwist.within(context.profile.limits, Twist(vx, 0.0, wz), hold_s)]

    def divide(self, step: Arc, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        return divided(step, "angle_rad", divide_angle(step.angle_rad, share))


PRIMITIVES = (_TurnPrimitive(), _FacePrimitive(), _ArcPrimitive())
