"""What wheels can do together binds plans too: words beyond it are refused with the number that is possible."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from chatrobot.core.geometry import Twist
from chatrobot.governor.kernel import bounded
from chatrobot.plan.context import (
    Impossible,
    choose_arc_speed,
    choose_speed,
    max_arc_speed_mps,
    scale_into_limits,
)
from chatrobot.robots.load import load_profile

MECANUM = load_profile("wheeltec_mini_mec")
ROBOT = replace(MECANUM, limits=replace(MECANUM.limits, max_wheel_speed_mps=1.0, wheel_reach_m=0.25))


def test_an_arc_is_slower_where_the_outer_wheel_decides() -> None:
    assert max_arc_speed_mps(ROBOT.limits, 0.75) == pytest.approx(0.75)
    assert max_arc_speed_mps(MECANUM.limits, 0.75) == pytest.approx(1.5), "its turning rate alone"
    assert choose_arc_speed(ROBOT, None, 0.75) == pytest.approx(0.3)
    refused = choose_arc_speed(ROBOT, 0.8, 0.75)
    assert isinstance(refused, Impossible)
    assert refused.reason.values["max_mps"] == pytest.approx(0.75)


def test_an_oblique_way_is_slower_where_wheels_add_up() -> None:
    most = 1.0 / math.sqrt(2.0)
    assert choose_speed(ROBOT, most, math.pi / 4) == pytest.approx(most)
    refused = choose_speed(ROBOT, 0.8, math.pi / 4)
    assert isinstance(refused, Impossible)
    assert refused.reason.values["max_mps"] == pytest.approx(most)


@pytest.mark.parametrize("asked", [Twist(1.0, 0.0, 2.0), Twist(0.7, 0.7, 0.0), Twist(-0.5, 0.5, 1.0)])
def test_plan_and_governor_scale_a_raw_twist_alike(asked: Twist) -> None:
    scaled = scale_into_limits(ROBOT.limits, asked)
    assert scaled == pytest.approx(bounded(ROBOT, asked))
    assert ROBOT.limits.wheel_speed_mps(*scaled) == pytest.approx(1.0)
