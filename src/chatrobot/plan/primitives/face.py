"""face: turn on the spot, the short way, to a heading."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.plan.base import Frame, Step, require_finite, require_positive, rounded_angle
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.legs import turn_to
from chatrobot.plan.primitive import Primitive, StepParts
from chatrobot.plan.reader import LineReader
from chatrobot.plan.units import angle_text


@dataclass(frozen=True)
class Face(Step):
    """Turn on the spot, the short way, until the heading in `frame` is `yaw_rad`."""

    yaw_rad: float
    frame: Frame = "start"
    rate_radps: float | None = None
    kind: Literal["face"] = "face"

    def __post_init__(self) -> None:
        require_finite("yaw_rad", self.yaw_rad)
        require_positive("rate_radps", self.rate_radps)


class FacePrimitive(Primitive[Face]):
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
        words = ["face", angle_text(step.yaw_rad)]
        if step.frame == "start":
            words.append("from start")
        if step.rate_radps is not None:
            words.append(f"at {angle_text(step.rate_radps, suffix='/s', prefer_degrees=False)}")
        return " ".join(words)

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


PRIMITIVE = FacePrimitive()
