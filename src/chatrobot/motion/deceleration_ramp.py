"""A program's zero, as gently as its start.

The governor ramps up what a program asks and lets every zero through at once. A program that holds 0.5 rad/s for six
seconds would then turn less than three radians: what the ramp took at its start is not given back at its end. So the
zero of a program that is well is ramped, too, as on a base that takes the velocities themselves. Stops, and the end of
a program that broke, are still zeros at once.
"""

from __future__ import annotations

from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.robots.profile import Limits


def decelerated(asked: Twist, sent: Twist, limits: Limits, dt_s: float) -> Twist:
    """What to ask for where the program asks `asked` and `sent` was sent `dt_s` before."""
    if not asked.is_zero or sent.is_zero:
        return asked
    share = 1.0
    if sent.speed_mps > 0.0:
        share = min(share, limits.acceleration_mps2 * dt_s / sent.speed_mps)
    if sent.wz_radps:
        share = min(share, limits.angular_acceleration_radps2 * dt_s / abs(sent.wz_radps))
    return sent.scaled(1.0 - share) if share < 1.0 else ZERO_TWIST
