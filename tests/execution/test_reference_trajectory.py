"""Where the robot should be is known for every moment: while it moves, late odometry included, and between motions."""

from __future__ import annotations

import pytest

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Pose, Twist
from chatrobot.execution.reference_trajectory import ReferenceTrajectory
from chatrobot.plan.trajectory import RampedTwist, Segment
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile

LIMITS = load_profile(DEFAULT_PROFILE).limits
START = Pose(1.0, 2.0, 0.0)


def forward(start: Pose, hold_s: float = 2.0) -> Segment:
    return Segment(RampedTwist.within(LIMITS, Twist(0.3, 0.0, 0.0), hold_s), start)


def test_before_anything_moves_it_is_where_the_plan_begins() -> None:
    assert ReferenceTrajectory(START).at(5.0) == START
    assert not ReferenceTrajectory(START).has_moved


def test_late_odometry_is_compared_with_the_motion_it_belongs_to() -> None:
    reference_trajectory = ReferenceTrajectory(START)
    first = forward(START)
    reference_trajectory.begin(first, 10.0)
    reference_trajectory.end()
    ends_s = 10.0 + first.total_s
    reference_trajectory.begin(forward(reference_trajectory.reference), ends_s + TICK_S / 2.0)
    assert reference_trajectory.began_s == ends_s, "no time is lost between two motions"
    assert reference_trajectory.at(ends_s - 0.5) == pytest.approx(first.at(first.total_s - 0.5)[0])
    assert reference_trajectory.at(ends_s + 1.0).x_m > first.end_pose.x_m


def test_a_reference_that_waits_is_as_far_on_as_before() -> None:
    reference_trajectory = ReferenceTrajectory(START)
    reference_trajectory.begin(forward(START), 10.0)
    before = reference_trajectory.at(11.0)
    reference_trajectory.wait(0.5, 11.5, before)
    assert reference_trajectory.at(11.5) == pytest.approx(before)


def test_a_reference_does_not_wait_behind_a_robot_that_rolled_on() -> None:
    reference_trajectory = ReferenceTrajectory(START)
    segment = forward(START)
    for at_s in (0.1, 1.0, segment.total_s - 0.1):
        reference_trajectory.begin(segment, 10.0)
        seen, _ = segment.at(at_s)
        reference_trajectory.wait(at_s, 10.0 + at_s, seen)
        assert reference_trajectory.at(10.0 + at_s) == pytest.approx(seen)


def test_a_motion_cut_short_ends_where_it_was_cut() -> None:
    reference_trajectory = ReferenceTrajectory(START)
    segment = forward(START)
    reference_trajectory.begin(segment, 10.0)
    shorter = segment.stop_early(1.0)
    reference_trajectory.change(shorter)
    reference_trajectory.end()
    assert reference_trajectory.reference == shorter.end_pose
    assert reference_trajectory.reference.x_m < segment.end_pose.x_m


def test_a_mend_moves_the_robot_and_not_the_reference() -> None:
    reference_trajectory = ReferenceTrajectory(START)
    reference_trajectory.begin(forward(Pose(0.97, 2.0, 0.0), 0.1), 10.0)
    reference_trajectory.end()
    assert reference_trajectory.reference == START
    assert reference_trajectory.at(99.0) == START
