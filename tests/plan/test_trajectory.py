from __future__ import annotations

import math
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.geometry import Pose, Twist
from chatrobot.plan.trajectory import RAMP_SHARE, Ramp, RampedTwist, Segment
from tests.plan.robots import MECANUM

LIMITS = MECANUM.limits
holds = st.floats(0.001, 100.0)
slopes = st.floats(0.1, 100.0)
speeds = st.floats(-1.0, 1.0).filter(lambda v: v == 0.0 or abs(v) > 1e-3)
twists = st.builds(Twist, speeds, speeds, speeds).filter(lambda t: not t.is_zero)
starts = st.builds(Pose, st.floats(-5, 5), st.floats(-5, 5), st.floats(-7, 7))


def times(total_s: float, steps: int = 400) -> list[float]:
    return [total_s * i / steps for i in range(steps + 1)]


@given(holds, slopes)
def test_progress_ends_exactly_at_the_hold_time(hold_s: float, k: float) -> None:
    ramp = Ramp(hold_s, k)
    assert ramp.at(ramp.total_s) == (hold_s, 0.0)
    assert ramp.at(-1.0) == (0.0, 0.0)
    area = sum(ramp.at((i + 0.5) * ramp.total_s / 2000)[1] for i in range(2000)) * ramp.total_s / 2000
    assert area == pytest.approx(hold_s, rel=1e-3)


@given(holds, slopes)
def test_progress_never_runs_faster_than_time_nor_backwards(hold_s: float, k: float) -> None:
    ramp = Ramp(hold_s, k)
    previous_s, previous_rate = 0.0, 0.0
    step_s = ramp.total_s / 400
    for t in times(ramp.total_s):
        s, rate = ramp.at(t)
        assert 0.0 <= rate <= 1.0 + 1e-12
        assert s >= previous_s - 1e-12 * (1.0 + s)
        assert abs(rate - previous_rate) <= k * step_s * (1 + 1e-6) + 1e-9
        previous_s, previous_rate = s, rate


@given(holds, slopes, st.floats(-0.1, 1.1))
def test_an_early_stop_goes_on_smoothly_and_never_farther(hold_s: float, k: float, share: float) -> None:
    ramp = Ramp(hold_s, k)
    t_stop = share * ramp.total_s
    stopped = ramp.stop_early(t_stop)
    assert stopped.total_s <= ramp.total_s + 1e-9
    assert stopped.hold_s <= hold_s * (1 + 1e-9)
    assert stopped.at(t_stop)[0] == pytest.approx(ramp.at(t_stop)[0], abs=1e-9 * (1 + hold_s))
    assert stopped.at(t_stop)[1] == pytest.approx(ramp.at(t_stop)[1], abs=1e-6)
    assert stopped.at(stopped.total_s)[1] == 0.0
    for t in times(ramp.total_s, 50):
        if t <= t_stop:
            assert stopped.at(t)[0] == pytest.approx(ramp.at(t)[0], abs=1e-9 * (1 + hold_s))


def test_a_stop_before_the_start_does_not_move_at_all() -> None:
    stopped = Ramp(2.0, 1.0).stop_early(0.0)
    assert stopped.total_s == 0.0
    assert stopped.at(1.0) == (0.0, 0.0)


@given(twists, holds, starts)
def test_a_motion_ends_where_the_constant_twist_would(twist: Twist, hold_s: float, start: Pose) -> None:
    segment = Segment(RampedTwist.within(LIMITS, twist, hold_s), start)
    assert segment.at(segment.total_s)[0] == pytest.approx(start.moved(twist, hold_s), abs=1e-6)
    assert segment.end_pose == start.moved(twist, hold_s)


@given(twists, holds, starts)
def test_reference_twists_keep_speed_curvature_and_acceleration(
    twist: Twist, hold_s: float, start: Pose
) -> None:
    segment = Segment(RampedTwist.within(LIMITS, twist, hold_s), start)
    step_s = segment.total_s / 400
    previous = Twist()
    for t in times(segment.total_s):
        now = segment.at(t)[1]
        assert now.speed_mps <= twist.speed_mps * (1 + 1e-9)
        assert now.vx_mps * twist.wz_radps == pytest.approx(now.wz_radps * twist.vx_mps, abs=1e-12)
        assert abs(now.speed_mps - previous.speed_mps) <= LIMITS.acceleration_mps2 * step_s + 1e-9
        assert abs(now.wz_radps - previous.wz_radps) <= LIMITS.angular_acceleration_radps2 * step_s + 1e-9
        previous = now


@given(twists, st.floats(0.0, 20.0), starts)
def test_poses_along_the_way_lie_on_the_screw_motion(twist: Twist, s: float, start: Pose) -> None:
    segment = Segment(RampedTwist.within(LIMITS, twist, 20.0), start)
    assert segment.pose_at_progress(s) == pytest.approx(start.moved(twist, s), abs=1e-6)


def test_a_timed_metre_takes_its_time_and_one_ramp() -> None:
    segment = Segment(RampedTwist.within(LIMITS, Twist(0.3), 2.0), Pose())
    assert segment.total_s == pytest.approx(2.3)
    assert segment.end_pose.x_m == pytest.approx(0.6)


def test_braking_decides_where_it_is_weaker_than_accelerating() -> None:
    weak = LIMITS.__class__(**{**LIMITS.__dict__, "deceleration_mps2": 0.5})
    assert RampedTwist.within(weak, Twist(1.0), 3.0).ramp_per_s == pytest.approx(RAMP_SHARE * 0.5)


def test_a_zero_twist_is_a_pause_not_a_motion() -> None:
    with pytest.raises(ValueError, match="Pause"):
        RampedTwist.within(LIMITS, Twist(), 1.0)


def test_one_reference_costs_microseconds() -> None:
    segment = Segment(RampedTwist.within(LIMITS, Twist(0.3, 0.0, 0.5), 10.0), Pose(0, 0, math.pi / 3))
    best = math.inf
    for _ in range(5):
        began = time.perf_counter()
        for i in range(2000):
            segment.at(i * 0.005)
        best = min(best, (time.perf_counter() - began) / 2000)
    assert best < 20e-6
