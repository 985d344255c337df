"""A line that is to last so long is never driven back at its end, however late the machine lets us tell the robot."""

from __future__ import annotations

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.core.geometry import Pose, Twist
from chatrobot.execution.executor import Executor
from chatrobot.execution.tracking import LEAST_SPEED_MPS, without_reverse
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import parse_plan
from chatrobot.testing.rig import Rig

FEEDBACK_MPS = LEAST_SPEED_MPS * 1.01
"""What holding its place asks of a robot that turns on the spot."""


def run_beside_busy_processes(rig: Rig, plan: Plan, seed: int, late_s: float = 0.1) -> Executor:
    """Some ticks come late, those at the end of the line among them."""
    chance = random.Random(seed)

    def hold_up(at_s: float) -> None:
        if chance.random() < 0.3 or 0.9 < at_s < 1.0:
            rig.live(chance.uniform(0.02, late_s))

    return rig.run(plan, hold_up)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    ("line", "sign"),
    [
        ("twist 0.5 0 0 for 1 s", Twist(1.0, 0.0, 0.0)),
        ("twist -0.5 0 0 for 1 s", Twist(-1.0, 0.0, 0.0)),
        ("twist 0 0.4 0 for 1 s", Twist(0.0, 1.0, 0.0)),
        ("twist 0.4 0 0.5 for 1 s", Twist(1.0, 0.0, 1.0)),
        ("drive 1 s at 0.5 m/s", Twist(1.0, 0.0, 0.0)),
        ("turn right 1 s at 0.5 rad/s", Twist(0.0, 0.0, -1.0)),
    ],
)
def test_no_correction_at_the_end_of_a_timed_line_reverses(line: str, sign: Twist, seed: int) -> None:
    rig = Rig()
    executor = run_beside_busy_processes(rig, parse_plan(line), seed)
    assert executor.outcome == "completed"
    for sent in rig.sent:
        for asked, direction in zip(sent, sign):
            assert asked * direction >= 0.0


@pytest.mark.parametrize("seed", range(4))
def test_of_several_timed_lines_none_reverses(seed: int) -> None:
    rig = Rig()
    run_beside_busy_processes(rig, parse_plan("twist 0.5 0 0\ntwist 0.5 0 0\ntwist 0.5 0 0"), seed)
    assert min(sent.vx_mps for sent in rig.sent) >= 0.0


@pytest.mark.parametrize("seed", range(8))
def test_what_a_line_overshot_is_not_driven_back_after_a_turn_either(seed: int) -> None:
    rig = Rig()
    run_beside_busy_processes(rig, parse_plan("twist 0.5 0 0\nturn left 1 s at 0.5 rad/s"), seed)
    assert min(sent.vx_mps for sent in rig.sent) >= -FEEDBACK_MPS


@pytest.mark.parametrize("seed", range(4))
def test_a_distance_is_still_driven_to_the_centimetre(seed: int) -> None:
    rig = Rig()
    run_beside_busy_processes(rig, parse_plan("drive 0.5 m at 0.5 m/s"), seed)
    assert rig.robot.true_pose.x_m == pytest.approx(0.5, abs=0.01)


numbers = st.floats(-1.0, 1.0)


@settings(max_examples=200)
@given(st.tuples(numbers, numbers, numbers), st.tuples(numbers, numbers, numbers))
def test_nothing_is_left_that_goes_against_what_was_driven(
    motion: tuple[float, float, float], driven: tuple[float, float, float]
) -> None:
    x, y, turn = without_reverse(motion, Twist(*driven))
    assert x * driven[0] + y * driven[1] >= -1e-9
    assert turn * driven[2] >= 0.0
    ahead = motion[0] * driven[0] + motion[1] * driven[1] >= 0.0 and motion[2] * driven[2] >= 0.0
    assert not ahead or Pose(x, y, turn) == Pose(*motion)
