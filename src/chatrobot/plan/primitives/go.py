"""go: to a point or a named place, around what is known."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.plan.base import Frame, Step, require, require_finite, require_positive, rounded_angle
from chatrobot.plan.context import Impossible, Lowered, LoweringContext
from chatrobot.plan.legs import go_to
from chatrobot.plan.primitive import Primitive, StepParts
from chatrobot.plan.reader import LineReader, quote
from chatrobot.plan.units import angle_text, number_text

MAX_PLACE_CHARS = 80
_ALLOWED = "'from start', 'facing 90 deg', 'named \"kitchen\"', 'at 0.2 m/s' or the end of the line"


@dataclass(frozen=True)
class Go(Step):
    """Go to a point, around what is known, and look along `yaw_rad` there if it is given.

    `place` is the name it was resolved from, for people to read; coordinates decide.
    """

    x_m: float
    y_m: float
    yaw_rad: float | None = None
    frame: Frame = "odom"
    place: str = ""
    speed_mps: float | None = None
    kind: Literal["go"] = "go"

    def __post_init__(self) -> None:
        require_finite("x_m", self.x_m)
        require_finite("y_m", self.y_m)
        if self.yaw_rad is not None:
            require_finite("yaw_rad", self.yaw_rad)
        require_positive("speed_mps", self.speed_mps)
        require(
            self.place.isprintable() and len(self.place) <= MAX_PLACE_CHARS,
            f"the name of a place is printable text of at most {MAX_PLACE_CHARS} characters",
        )

    @classmethod
    def to_pose(cls, pose: Pose) -> Go:
        """Back to a measured pose of `odom`: to a tenth of a millimetre and a hundredth of a degree."""
        return cls(round(pose.x_m, 4), round(pose.y_m, 4), rounded_angle(wrap_angle(pose.yaw_rad), 2))


class GoPrimitive(Primitive[Go]):
    kind = verb = "go"
    step_type = Go
    needs_pose = True
    usage = 'go to X Y [from start] [facing ANGLE] [named "PLACE"] [at SPEED]'
    help = "Go to a point of the map (metres), or ('from start') counted from where this plan began, around obstacles."
    examples = ("go to 1.2 -0.4", "go to 0 0 from start facing 0 deg", 'go to 3 1 named "kitchen"')

    def parse(self, line: LineReader) -> Go:
        line.accept("to")
        x = line.length_m()
        y = line.length_m()
        frame: Frame = "odom"
        yaw: float | None = None
        place = ""
        speed: float | None = None
        while not line.at_end():
            if line.accept("from"):
                line.expect("start")
                frame = "start"
            elif line.accept("facing"):
                yaw = line.angle_rad()
            elif line.accept("named"):
                place = line.text('the name of the place, as in named "kitchen"')
            elif line.accept("at"):
                speed = line.speed_mps()
            else:
                line.fail_here(_ALLOWED)
        return Go(x, y, yaw, frame, place, speed)

    def format(self, step: Go) -> str:
        words = [f"go to {number_text(step.x_m)} {number_text(step.y_m)}"]
        if step.frame == "start":
            words.append("from start")
        if step.yaw_rad is not None:
            words.append(f"facing {angle_text(step.yaw_rad)}")
        if step.place:
            words.append(f"named {quote(step.place)}")
        if step.speed_mps is not None:
            words.append(f"at {number_text(step.speed_mps)} m/s")
        return " ".join(words)

    def lower(self, step: Go, context: LoweringContext) -> Lowered:
        frame = context.frame_pose(step.frame)
        target = frame.compose(Pose(step.x_m, step.y_m, step.yaw_rad or 0.0))
        heading = None if step.yaw_rad is None else target.yaw_rad
        lowered = go_to(
            context, (target.x_m, target.y_m), heading, speed_mps=step.speed_mps, named_place=bool(step.place)
        )
        if isinstance(lowered, Impossible) and "nearest_x_m" in lowered.reason.values:
            at = lowered.reason.values
            nearest = Go(float(at["nearest_x_m"]), float(at["nearest_y_m"]), speed_mps=step.speed_mps)
            return replace(lowered, instead=nearest)
        return lowered

    def divide(self, step: Go, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        return Go.to_pose(context.pose), step

    def resolve(self, step: Go, plan_start: Pose) -> Go:
        if step.frame == "odom":
            return step
        target = plan_start.compose(Pose(step.x_m, step.y_m, step.yaw_rad or 0.0))
        yaw_rad = None if step.yaw_rad is None else rounded_angle(wrap_angle(target.yaw_rad), 6)
        return replace(
            step, x_m=round(target.x_m, 6), y_m=round(target.y_m, 6), yaw_rad=yaw_rad, frame="odom"
        )


PRIMITIVE = GoPrimitive()
