"""A plan's ideal geometry, without a simulator.

What a perfect robot would do, and a judge after FORMAT.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from chatrobot.core.geometry import Pose, Twist
from chatrobot.plan.steps import Arc, Drive, Face, Go, Plan, RawTwist, Remember, Repeat, Step, Turn, Wait

SPEED, RATE, ACCELERATION, ANGULAR_ACCELERATION, MAX_SPEED, MAX_RATE = 0.3, 0.6, 1.0, 2.0, 1.0, 2.0


@dataclass
class Track:
    """Where an ideal robot is and what it has done. `paused_s` counts standing between motions only."""

    pose: Pose = field(default_factory=Pose)
    path_m: float = 0.0
    turned_rad: float = 0.0
    duration_s: float = 0.0
    paused_s: float = 0.0
    pending_s: float = 0.0
    max_speed: float = 0.0
    max_rate: float = 0.0
    farthest_m: float = 0.0
    moved: bool = False
    too_fast: bool = False
    start: Pose = field(default_factory=Pose)
    places: dict[str, Pose] = field(default_factory=dict)

    def run(self, plan: Plan) -> None:
        """Do the whole plan."""
        self.start = self.pose
        self._steps(plan.steps)

    def _steps(self, steps: Iterable[Step]) -> None:
        for step in steps:
            if isinstance(step, Repeat):
                for _ in range(step.count):
                    self._steps(step.steps)
            elif isinstance(step, Remember):
                self.places[step.place] = self.pose
            elif isinstance(step, Wait):
                self.pending_s += step.duration_s
            else:
                self._motion(step)

    def _motion(self, step: Step) -> None:
        if isinstance(step, Drive):
            speed = step.speed_mps or SPEED
            seconds = step.duration_s if step.duration_s is not None else (step.distance_m or 1.0) / speed
            self._hold(
                Twist(speed * math.cos(step.direction_rad), speed * math.sin(step.direction_rad)), seconds
            )
        elif isinstance(step, Turn):
            rate = step.rate_radps or RATE
            seconds = step.duration_s if step.duration_s is not None else (step.angle_rad or 0.0) / rate
            self._hold(Twist(0, 0, rate if step.left else -rate), seconds)
        elif isinstance(step, Arc):
            speed = step.speed_mps or min(SPEED, RATE * step.radius_m)
            rate = speed / step.radius_m * (1 if step.left != step.backward else -1)
            self._hold(
                Twist(-speed if step.backward else speed, 0, rate), step.radius_m * step.angle_rad / speed
            )
        elif isinstance(step, RawTwist):
            self._hold(Twist(step.vx_mps, step.vy_mps, step.wz_radps), step.duration_s)
        elif isinstance(step, Go):
            origin = self.start if step.frame == "start" else Pose()
            goal = origin.compose(Pose(step.x_m, step.y_m, step.yaw_rad or 0.0))
            seen = goal.relative_to(self.pose)
            length = math.hypot(seen.x_m, seen.y_m)
            speed = step.speed_mps or SPEED
            if length > 1e-6:
                self._hold(Twist(seen.x_m / length * speed, seen.y_m / length * speed), length / speed)
            if step.yaw_rad is not None:
                self._face(goal.yaw_rad)
        elif isinstance(step, Face):
            self._face(step.yaw_rad + (self.start.yaw_rad if step.frame == "start" else 0.0))

    def _face(self, yaw_rad: float) -> None:
        off = math.remainder(yaw_rad - self.pose.yaw_rad, 2 * math.pi)
        if abs(off) > 1e-6:
            self._hold(Twist(0, 0, math.copysign(RATE, off)), abs(off) / RATE)

    def _hold(self, twist: Twist, seconds: float) -> None:
        if twist.is_zero:
            return
        if self.moved:
            self.paused_s += self.pending_s
        self.pending_s = 0.0
        self.moved = True
        self.too_fast |= twist.speed_mps > MAX_SPEED * 1.001 or abs(twist.wz_radps) > MAX_RATE * 1.001
        for k in range(1, 9):
            pose = self.pose.moved(twist, seconds * k / 8)
            self.farthest_m = max(self.farthest_m, math.hypot(pose.x_m, pose.y_m))
        self.pose = self.pose.moved(twist, seconds)
        self.path_m += twist.speed_mps * seconds
        self.turned_rad += twist.wz_radps * seconds
        ramp = max(twist.speed_mps / ACCELERATION, abs(twist.wz_radps) / ANGULAR_ACCELERATION)
        self.duration_s += seconds + ramp
        self.max_speed = max(self.max_speed, twist.speed_mps)
        self.max_rate = max(self.max_rate, abs(twist.wz_radps))


def judge(track: Track, expect: Mapping[str, Any]) -> list[str]:
    """What of `expect` does not hold, in words; empty if all does."""
    wrong: list[str] = []
    turned, yaw = math.degrees(track.turned_rad), math.degrees(track.pose.yaw_rad)
    numbers = {
        "x": (track.pose.x_m, 0.05, 0.05),
        "y": (track.pose.y_m, 0.05, 0.05),
        "turned_deg": (turned, 0.5, 0.03),
        "path_m": (track.path_m, 0.01, 0.05),
        "duration_s": (track.duration_s, 0.5, 0.1),
        "pause_s": (track.paused_s, 0.5, 0.0),
        "max_speed": (track.max_speed, 0.0, 0.1),
        "max_turn_rate": (track.max_rate, 0.0, 0.1),
    }
    for name, (got, absolute, relative) in numbers.items():
        if name in expect and abs(got - expect[name]) > max(absolute, relative * abs(expect[name])) + 1e-9:
            wrong.append(f"{name} {got:.3f} != {expect[name]}")
    if "yaw_deg" in expect and abs(math.remainder(yaw - expect["yaw_deg"], 360)) > 4:
        wrong.append(f"yaw {yaw:.1f} != {expect['yaw_deg']}")
    signs = {"x": track.pose.x_m, "y": track.pose.y_m, "yaw": track.turned_rad}
    for name, sign in expect.get("sign", {}).items():
        value = signs[name]
        if (
            (sign == "+" and value < 0.02)
            or (sign == "-" and value > -0.02)
            or (sign == "0" and abs(value) > 0.03)
        ):
            wrong.append(f"sign {name} {value:.3f} not {sign}")
    if expect.get("closed") and math.hypot(track.pose.x_m, track.pose.y_m) > 0.1:
        wrong.append(f"not closed: ends at ({track.pose.x_m:.2f}, {track.pose.y_m:.2f})")
    if "stays_within_m" in expect and track.farthest_m > expect["stays_within_m"] + 0.01:
        wrong.append(f"went {track.farthest_m:.2f} m away")
    if expect.get("motion") == "none" and track.moved:
        wrong.append("moved")
    return wrong
