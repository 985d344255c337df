"""Writes steps as the lines of the program's `run`, and notes which helpers those lines call."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from chatrobot.core.geometry import Twist
from chatrobot.plan.context import Impossible, LoweringContext, choose_arc_speed, choose_rate, choose_speed
from chatrobot.plan.lowering import CoreWalk, PlannedMotion
from chatrobot.plan.primitives.drive import UNTIL_AT_MOST_M, straight_twist
from chatrobot.plan.steps import Arc, Drive, Face, Go, Plan, RawTwist, Remember, Repeat, Say, Step, Turn, Wait
from chatrobot.plan.trajectory import RampedTwist
from chatrobot.robots.profile import Point

_BY_ODOMETRY = {"go_to", "face"}


@dataclass
class Body:
    """The lines of `run`, without indentation of its own, and the names of the helpers that they use."""

    lines: list[str] = field(default_factory=list)
    uses: set[str] = field(default_factory=set)

    @property
    def needs_pose(self) -> bool:
        """Tell whether some step steers by odometry."""
        return bool(self.uses & _BY_ODOMETRY)


def write_lines(plan: Plan, context: LoweringContext) -> Body | Impossible:
    """Return the body of `run` for `plan`, or why this robot cannot do it."""
    found = _walked(plan, context)
    if isinstance(found, Impossible):
        return found
    writer = _Writer(context, found, has_rests=_has_rests(plan.steps))
    writer.block(plan.steps, (), 0)
    while writer.body.lines and writer.body.lines[-1] == "self.rest()":
        writer.body.lines.pop()  # the end of the program is a rest of its own
    if not any("self.rest()" in line for line in writer.body.lines):
        writer.body.uses.discard("rest")
    return writer.body


Walked = dict[tuple[int, ...], list[PlannedMotion]]


def _walked(plan: Plan, context: LoweringContext) -> Walked | Impossible:
    """Return what each step comes to the first time it is done."""
    walk: CoreWalk = CoreWalk(plan, context)
    motions: Walked = {}
    closed: set[tuple[int, ...]] = set()
    for item in walk:
        if isinstance(item, Impossible):
            return item
        if item.index not in closed:
            motions.setdefault(item.index, []).append(item)
        if item.last:
            closed.add(item.index)
    return motions


def _has_rests(steps: Sequence[Step]) -> bool:
    """Raw velocities with times are done as told; between steps that have ends the robot comes to rest."""
    return any(
        _has_rests(step.steps) if isinstance(step, Repeat) else isinstance(step, (Drive, Turn, Arc, Go, Face))
        for step in steps
    )


class _Writer:
    def __init__(self, context: LoweringContext, motions: Walked, *, has_rests: bool) -> None:
        self.body = Body()
        self._context = context
        self._profile = context.profile
        self._motions = motions
        self._has_rests = has_rests

    def block(self, steps: Sequence[Step], path: tuple[int, ...], depth: int) -> None:
        for position, step in enumerate(steps):
            index = (*path, position)
            if isinstance(step, Repeat):
                self._add(depth, f"for _ in range({step.count}):")
                self.block(step.steps, index, depth + 1)
            else:
                self._step(step, index, depth)

    def _step(self, step: Step, index: tuple[int, ...], depth: int) -> None:
        if isinstance(step, RawTwist):
            self._move(depth, Twist(step.vx_mps, step.vy_mps, step.wz_radps), number(step.duration_s))
        elif isinstance(step, Drive):
            self._drive(step, depth)
        elif isinstance(step, Turn):
            self._turn(step, depth)
        elif isinstance(step, Arc):
            self._arc(step, depth)
        elif isinstance(step, Go):
            self._go(step, index, depth)
        elif isinstance(step, Face):
            self._face(step, depth)
        elif isinstance(step, Wait):
            self._add(depth, f"self.pause({number(step.duration_s)})")
        elif isinstance(step, Say):
            self._add(depth, f"self.get_logger().info({step.text!r})")
        elif isinstance(step, Remember):
            self._add(depth, f"self.get_logger().info({'this is ' + step.place!r})")
        else:
            self._core(index, depth)

    def _add(self, depth: int, line: str) -> None:
        self.body.lines.append("    " * depth + line)

    def _rest(self, depth: int) -> None:
        if self._has_rests:
            self._call(depth, "rest", "")

    def _call(self, depth: int, helper: str, arguments: str, comment: str = "") -> None:
        self.body.uses.add(helper)
        self._add(depth, f"self.{helper}({arguments})" + (f"  # {comment}" if comment else ""))

    def _move(self, depth: int, twist: Twist, seconds: str, comment: str = "") -> None:
        self._call(depth, "move", ", ".join([*velocities(twist), f"seconds={seconds}"]), comment)
        if twist.vy_mps:
            self.body.uses.add("linear_y")

    def _drive(self, step: Drive, depth: int) -> None:
        speed = choose_speed(self._profile, step.speed_mps, step.direction_rad)
        assert isinstance(speed, float)  # the walk found it possible
        twist = straight_twist(speed, step.direction_rad)
        seconds, comment = number(step.duration_s or 0.0), ""
        if step.duration_s is None:
            distance_m = step.distance_m if step.distance_m is not None else UNTIL_AT_MOST_M
            seconds = f"{number(distance_m)} / {number(speed)}"
            comment = f"{distance_m:g} m" + ("" if step.distance_m is not None else " at most")
        if step.until is None:
            self._move(depth, twist, seconds, comment)
        else:
            near = number(step.until.distance_m)
            self._call(
                depth, "move_until_near", ", ".join([near, *velocities(twist), f"seconds={seconds}"]), comment
            )
            self.body.uses.update({"linear_y"} if twist.vy_mps else ())
        self._rest(depth)

    def _turn(self, step: Turn, depth: int) -> None:
        rate = choose_rate(self._profile, step.rate_radps)
        assert isinstance(rate, float)
        twist = Twist(0.0, 0.0, rate if step.left else -rate)
        if step.angle_rad is None:
            self._move(depth, twist, number(step.duration_s or 0.0))
        else:
            self._move(depth, twist, f"{angle(step.angle_rad)} / {number(rate)}")
            self.body.uses.add("math")
        self._rest(depth)

    def _arc(self, step: Arc, depth: int) -> None:
        speed = choose_arc_speed(self._profile, step.speed_mps, step.radius_m)
        assert isinstance(speed, float)
        vx = -speed if step.backward else speed
        twist = Twist(vx, 0.0, vx / step.radius_m if step.left else -vx / step.radius_m)
        seconds = f"{angle(step.angle_rad)} * {number(step.radius_m)} / {number(speed)}"
        self.body.uses.add("math")
        self._move(depth, twist, seconds, f"radius {step.radius_m:g} m")
        self._rest(depth)

    def _go(self, step: Go, index: tuple[int, ...], depth: int) -> None:
        if not self._profile.can_turn_on_the_spot:
            self._core(index, depth)
            self._rest(depth)
            return
        speed = choose_speed(self._profile, step.speed_mps)
        assert isinstance(speed, float)
        if step.place:
            self._add(depth, f"# to {step.place}")
        for point in self._waypoints(step, index):
            self._call(depth, "go_to", f"{self._place(step.frame, point)}, speed={number(speed)}")
        if step.yaw_rad is not None:
            self._call(depth, "face", self._heading(step.frame, step.yaw_rad))
        self._rest(depth)

    def _waypoints(self, step: Go, index: tuple[int, ...]) -> list[Point]:
        """Return where the way around what is known bends, and the goal, in the frame of `step`."""
        frame = self._context.frame_pose(step.frame)
        ends = [
            item.end.relative_to(frame)
            for item in self._motions.get(index, [])
            if isinstance(item.motion, RampedTwist) and item.motion.twist.speed_mps > 0.0
        ]
        return [(end.x_m, end.y_m) for end in ends] or [(step.x_m, step.y_m)]

    def _place(self, frame: str, point: Point) -> str:
        x, y = (number(value) for value in point)
        if frame == "start":
            self.body.uses.add("from_start")
            return f"*self.from_start({x}, {y})"
        return f"{x}, {y}"

    def _heading(self, frame: str, yaw_rad: float) -> str:
        self.body.uses.add("math")
        if frame == "start":
            self.body.uses.add("from_start")
            return f"self.start[2] + {angle(yaw_rad)}" if yaw_rad else "self.start[2]"
        return angle(yaw_rad)

    def _face(self, step: Face, depth: int) -> None:
        rate = choose_rate(self._profile, step.rate_radps)
        assert isinstance(rate, float)
        at = "" if step.rate_radps is None else f", rate={number(rate)}"
        self._call(depth, "face", f"{self._heading(step.frame, step.yaw_rad)}{at}")
        self._rest(depth)

    def _core(self, index: tuple[int, ...], depth: int) -> None:
        """A step without words of its own: the motions that it comes to."""
        for item in self._motions.get(index, []):
            if isinstance(item.motion, RampedTwist):
                self._move(depth, item.motion.twist, number(item.motion.hold_s))


def velocities(twist: Twist) -> list[str]:
    """Return the arguments of `move` that are not zero."""
    names = ("linear_x", "linear_y", "angular_z")
    return [f"{name}={number(value)}" for name, value in zip(names, twist) if value != 0.0]


def number(value: float) -> str:
    """Write a float as a person does: always with its point, at most six digits after it."""
    text = repr(round(float(value), 6))
    return repr(float(value)) if text in ("0.0", "-0.0") and value != 0.0 else text


def angle(angle_rad: float) -> str:
    """Write an angle in degrees, which people read."""
    return f"math.radians({number(math.degrees(angle_rad))})"
