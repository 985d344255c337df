"""Ways along the floor: `drive` straight, keeping the heading, and `go` to a point around what is known."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.core.geometry import Pose, Twist, wrap_angle
from chatrobot.core.reason import Reason
from chatrobot.plan.base import (
    Condition,
    Frame,
    ObstacleWithin,
    Step,
    divide_extent,
    require,
    require_finite,
    require_positive,
    rounded_angle,
)
from chatrobot.plan.context import Impossible, Lowered, LoweringContext, choose_speed
from chatrobot.plan.legs import go_to
from chatrobot.plan.primitive import Primitive, StepParts, divided
from chatrobot.plan.reader import LineReader, angle_text, at_speed, number_text, quote
from chatrobot.plan.trajectory import RampedTwist

UNTIL_AT_MOST_M = 20.0
"""How far a drive that has only a condition goes when the condition never comes true."""

_DIRECTIONS = {"forward": 0.0, "left": math.pi / 2, "right": -math.pi / 2, "back": math.pi}
_SPELLINGS = {**_DIRECTIONS, "forwards": 0.0, "ahead": 0.0, "backward": math.pi, "backwards": math.pi}
_DRIVE_ALLOWED = "forward, back, left, right, 'toward 45 deg', 'at 0.2 m/s' or 'until obstacle within 0.5 m'"


@dataclass(frozen=True)
class Drive(Step):
    """Go straight, keeping the heading: a distance or a time, and/or until a condition holds.

    `direction_rad` is the direction of travel in the robot's frame, 0 forward, pi/2 left, pi backward.
    At least one of `distance_m`, `duration_s`, `until`; not both distance and duration. With `until`, the
    distance or duration is the most it will do.
    """

    distance_m: float | None = None
    duration_s: float | None = None
    direction_rad: float = 0.0
    speed_mps: float | None = None
    until: Condition | None = None
    kind: Literal["drive"] = "drive"

    def __post_init__(self) -> None:
        require_positive(self, "distance_m", "duration_s", "speed_mps")
        require_finite(self, "direction_rad")
        is_measured = self.distance_m is not None or self.duration_s is not None
        require(is_measured or self.until is not None, "a drive needs a distance, a duration or a condition")
        is_both = self.distance_m is not None and self.duration_s is not None
        require(not is_both, "a drive has a distance or a duration, not both (say the speed instead)")


class _DrivePrimitive(Primitive[Drive]):
    kind = verb = "drive"
    step_type = Drive
    usage = (
        "drive [DISTANCE | TIME] [forward | back | left | right | toward ANGLE] [at SPEED] "
        "[until obstacle within DISTANCE]"
    )
    help = "Go straight, keeping the heading; the directions are the robot's own."
    examples = (
        "drive 1 m",
        "drive 2 s left at 0.2 m/s",
        "drive 1 m back",
        "drive 1 m toward 45 deg",
        "drive forward until obstacle within 0.5 m",
    )

    def parse(self, line: LineReader) -> Drive:
        distance_m: float | None = None
        duration_s: float | None = None
        direction_rad = 0.0
        speed_mps: float | None = None
        until: ObstacleWithin | None = None
        if line.at_end():
            line.fail_here(f"a distance such as 1 m, a time such as 2 s, {_DRIVE_ALLOWED}")
        while not line.at_end():
            line.accept("for")
            if line.number_follows and distance_m is None and duration_s is None:
                distance_m, duration_s = line.length_or_duration()
            elif line.accept("toward", "towards"):
                direction_rad = line.angle_rad()
            elif line.accept("at"):
                speed_mps = line.speed_mps()
            elif line.accept("until"):
                line.expect("obstacle")
                line.expect("within")
                until = ObstacleWithin(line.length_m())
            elif word := line.accept(*_SPELLINGS):
                direction_rad = _SPELLINGS[word]
            else:
                line.fail_here(_DRIVE_ALLOWED)
        return Drive(distance_m, duration_s, direction_rad, speed_mps, until)

    def format(self, step: Drive) -> str:
        words = ["drive"]
        if step.distance_m is not None:
            words.append(f"{number_text(step.distance_m)} m")
        if step.duration_s is not None:
            words.append(f"{number_text(step.duration_s)} s")
        named = {angle: word for word, angle in _DIRECTIONS.items()}
        if step.direction_rad not in named:
            words.append(f"toward {angle_text(step.direction_rad)}")
        elif step.direction_rad != 0.0 or len(words) == 1:
            words.append(named[step.direction_rad])
        until = f" until obstacle within {number_text(step.until.distance_m)} m" if step.until else ""
        return " ".join(words) + at_speed(step.speed_mps) + until

    def lower(self, step: Drive, context: LoweringContext) -> Lowered:
        profile = context.profile
        if step.until is not None and profile.lidar is None:
            return Impossible(Reason("needs_lidar"))
        speed = choose_speed(profile, step.speed_mps, step.direction_rad)
        if isinstance(speed, Impossible):
            return speed
        twist = straight_twist(speed, step.direction_rad)
        is_timed = step.duration_s is not None
        hold_s = step.duration_s or (step.distance_m or UNTIL_AT_MOST_M) / speed
        return [RampedTwist.within(profile.limits, twist, hold_s, until=step.until, is_timed=is_timed)]

    def divide(self, step: Drive, share: float, context: LoweringContext) -> StepParts:  # noqa: ARG002
        if step.duration_s is not None:
            done, rest = divided(step, "duration_s", divide_extent(step.duration_s, share))
        else:
            extents = divide_extent(step.distance_m or UNTIL_AT_MOST_M, share)
            done, rest = divided(step, "distance_m", extents)
        return replace(done, until=None) if isinstance(done, Drive) else None, rest


def straight_twist(speed_mps: float, direction_rad: float) -> Twist:
    """Without the 1e-17 sideways that cos and sin of a named direction would leave."""
    vx, vy = speed_mps * math.cos(direction_rad), speed_mps * math.sin(direction_rad)
    tiny = 1e-9 * speed_mps
    return Twist(vx if abs(vx) > tiny else 0.0, vy if abs(vy) > tiny else 0.0, 0.0)


MAX_PLACE_CHARS = 80
_GO_ALLOWED = "'from start', 'facing 90 deg', 'named \"kitchen\"', 'at 0.2 m/s' or the end of the line"


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
        require_finite(self, "x_m", "y_m", "yaw_rad")
        require_positive(self, "speed_mps")
        fits = self.place.isprintable() and len(self.place) <= MAX_PLACE_CHARS
        require(fits, f"the name of a place is printable text of at most {MAX_PLACE_CHARS} characters")

    @classmethod
    def to_pose(cls, pose: Pose) -> Go:
        """Back to a measured pose of `odom`: to a tenth of a millimetre and a hundredth of a degree."""
        return cls(round(pose.x_m, 4), round(pose.y_m, 4), rounded_angle(wrap_angle(pose.yaw_rad), 2))


class _GoPrimitive(Primitive[Go]):
    kind = verb = "go"
    step_type = Go
    needs_pose = True
    usage = 'go to X Y [from start] [facing ANGLE] [named "PLACE"] [at SPEED]'
    help = "Go to a point of the map (metres), or ('from start') counted from where this plan began, around obstacles."
    examples = ("go to 1.2 -0.4", "go to 0 0 from start facing 0 deg", 'go to 3 1 named "kitchen"')

    def parse(self, line: LineReader) -> Go:
        line.accept("to")
        x_m, y_m = line.length_m(), line.length_m()
        frame: Frame = "odom"
        yaw_rad: float | None = None
        place = ""
        speed_mps: float | None = None
        while not line.at_end():
            if line.accept("from"):
                line.expect("start")
                frame = "start"
            elif line.accept("facing"):
                yaw_rad = line.angle_rad()
            elif line.accept("named"):
                place = line.text('the name of the place, as in named "kitchen"')
            elif line.accept("at"):
                speed_mps = line.speed_mps()
            else:
                line.fail_here(_GO_ALLOWED)
        return Go(x_m, y_m, yaw_rad, frame, place, speed_mps)

    def format(self, step: Go) -> str:
        start = " from start" if step.frame == "start" else ""
        facing = "" if step.yaw_rad is None else f" facing {angle_text(step.yaw_rad)}"
        named = f" named {quote(step.place)}" if step.place else ""
        point = f"{number_text(step.x_m)} {number_text(step.y_m)}"
        return f"go to {point}{start}{facing}{named}{at_speed(step.speed_mps)}"

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


PRIMITIVES = (_DrivePrimitive(), _GoPrimitive())
