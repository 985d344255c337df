"""What feedback left is driven where it is worth it, slowly, and only as the base can."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.geometry import Pose
from chatrobot.execution.tracking import AT_THE_END, BETWEEN_STEPS, RATE_RADPS, SPEED_MPS, correction
from chatrobot.robots.load import list_profiles, load_profile
from chatrobot.robots.profile import RobotProfile

PROFILES = [load_profile(entry.name) for entry in list_profiles() if entry.origin == "built-in"]
RESTS = st.builds(Pose, st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(-0.5, 0.5))


@given(st.sampled_from(PROFILES), RESTS)
def test_a_mend_is_slow_and_asks_nothing_that_the_base_cannot_do(profile: RobotProfile, rest: Pose) -> None:
    motion = correction(profile, rest, AT_THE_END)
    if motion is None:
        return
    assert motion.twist.speed_mps <= SPEED_MPS + 1e-9
    assert abs(motion.twist.wz_radps) <= RATE_RADPS + 1e-9
    assert profile.can_go_sideways or motion.twist.vy_mps == 0.0
    assert profile.can_turn_on_the_spot or motion.twist.wz_radps == 0.0


def test_a_rest_within_the_tolerance_is_left() -> None:
    for tolerance in (AT_THE_END, BETWEEN_STEPS):
        inside = Pose(0.9 * tolerance.distance_m, 0.0, -0.9 * tolerance.turn_rad)
        assert all(correction(profile, inside, tolerance) is None for profile in PROFILES)


def test_a_bigger_rest_is_driven_to_its_end() -> None:
    profile = next(profile for profile in PROFILES if profile.can_go_sideways)
    motion = correction(profile, Pose(0.02, -0.01, 0.0), AT_THE_END)
    assert motion is not None
    assert motion.twist.vx_mps * motion.hold_s == pytest.approx(0.02)
    assert motion.twist.vy_mps * motion.hold_s == pytest.approx(-0.01)
