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


def gentle_brake(previous: Twist, asked: Twist, dt_s: float) -> Twist:
    slowest = previous.vx_mps - 0.5 * dt_s
    return Twist(max(asked.vx_mps, slowest), asked.vy_mps, asked.wz_radps)


def steady(previous: Twist, asked: Twist, dt_s: float) -> Twist:
    """Keeps to 1 m/s2 and 2 rad/s2, both ways, with next to no tolerance."""
    vx, wz = asked.vx_mps - previous.vx_mps, asked.wz_radps - previous.wz_radps
    most_vx, most_wz = 1.0 * dt_s + 1e-9, 2.0 * dt_s + 1e-9
    return Twist(
        previous.vx_mps + max(-most_vx, min(most_vx, vx)),
        asked.vy_mps,
        previous.wz_radps + max(-most_wz, min(most_wz, wz)),
    )
