"""Governor kernels to rehearse with."""

from __future__ import annotations

from chatrobot.core.geometry import Twist


def pass_all(previous: Twist, asked: Twist, dt_s: float) -> Twist:
    assert dt_s > 0.0
    assert previous.is_finite
    return asked


def half_speed(previous: Twist, asked: Twist, dt_s: float) -> Twist:
    assert dt_s > 0.0
    assert previous.is_finite
    return asked.scaled(0.5)
