"""Traces made by hand: straight and turning pieces at constant speed, sampled at 50 Hz."""

from __future__ import annotations

from chatrobot.core.geometry import ORIGIN, Twist
from chatrobot.sim.trace import Sample

STEP_S = 0.02


def trace(*pieces: tuple[float, Twist]) -> list[Sample]:
    """One sample every `STEP_S` through all (seconds, twist) pieces, from the origin."""
    pose, t_s = ORIGIN, 0.0
    samples = [Sample(0.0, *ORIGIN, 0.0, 0.0, 0.0)]
    for duration_s, twist in pieces:
        for _ in range(round(duration_s / STEP_S)):
            pose, t_s = pose.moved(twist, STEP_S), t_s + STEP_S
            samples.append(Sample(t_s, *pose, *twist))
    return samples


def forward(distance_m: float, speed_mps: float = 0.5) -> tuple[float, Twist]:
    return abs(distance_m) / speed_mps, Twist(speed_mps if distance_m > 0 else -speed_mps)


def left(angle_rad: float, rate_radps: float = 0.5) -> tuple[float, Twist]:
    return abs(angle_rad) / rate_radps, Twist(0.0, 0.0, rate_radps if angle_rad > 0 else -rate_radps)


def rest(duration_s: float) -> tuple[float, Twist]:
    return duration_s, Twist()
