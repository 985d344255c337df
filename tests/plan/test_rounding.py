from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.geometry import ORIGIN
from chatrobot.plan.rehearsal import Rehearsal, rehearse
from chatrobot.plan.steps import Arc, Plan
from chatrobot.plan.text import format_plan, parse_plan
from tests.plan.kernels import pass_all
from tests.plan.robots import ACKERMANN, MECANUM

SQUARE = "repeat 4\n  drive 1 m\n  turn left 90 deg\nend"


def rehearsed(text: str) -> Rehearsal:
    return rehearse(parse_plan(text), ACKERMANN, None, ORIGIN, pass_all)


def codes(rehearsal: Rehearsal) -> list[str]:
    return [finding.reason.code for finding in rehearsal.findings]


def test_a_base_that_turns_on_the_spot_keeps_its_corners() -> None:
    plan = parse_plan(SQUARE)
    assert rehearse(plan, MECANUM, None, ORIGIN, pass_all).plan is plan


def test_a_square_gets_round_corners_and_its_last_turn_is_left_out() -> None:
    result = rehearsed(SQUARE)
    assert result.ok
    assert codes(result) == ["corners_rounded", "turn_left_out"]
    assert [step.kind for step in result.plan.steps] == ["drive", "arc"] * 3 + ["drive"]
    assert format_plan(Plan(result.plan.steps[:2])) == "drive 0.6 m\narc left 90 deg radius 0.4 m"
    assert result.end_pose == pytest.approx((0, 0, 1.5 * math.pi), abs=1e-6)


@given(st.floats(1, 100), st.booleans(), st.booleans())
def test_a_rounded_corner_ends_where_the_sharp_one_would(degrees: float, left: bool, backward: bool) -> None:
    back = " back" if backward else ""
    text = f"drive 2 m{back}\nturn {'left' if left else 'right'} {degrees} deg\ndrive 2 m{back}"
    sharp = rehearse(parse_plan(text), MECANUM, None, ORIGIN, pass_all)
    result = rehearsed(text)
    assert result.ok
    assert result.end_pose == pytest.approx(sharp.end_pose, abs=1e-6)


def test_speeds_and_timed_legs_are_kept() -> None:
    result = rehearsed("drive 4 s at 0.5 m/s\nturn right 90 deg\ndrive 4 s at 0.5 m/s")
    assert result.ok
    assert result.end_pose == pytest.approx((2, -2, -math.pi / 2), abs=1e-6)
    arc = result.plan.steps[1]
    assert isinstance(arc, Arc)
    assert arc.speed_mps == 0.5


def test_turns_that_follow_one_another_are_one_corner() -> None:
    assert rehearsed(
        "drive 2 m\nturn left 30 deg\nturn left 30 deg\ndrive 2 m"
    ).end_pose.yaw_rad == pytest.approx(math.radians(60))
    straight = rehearsed("drive 1 m\nturn left 30 deg\nturn right 30 deg\ndrive 1 m")
    assert straight.ok
    assert straight.end_pose == pytest.approx((2, 0, 0))


@pytest.mark.parametrize(
    "text",
    [
        "turn left 90 deg",
        "turn left 90 deg\ndrive 1 m",
        "drive 0.3 m\nturn left 90 deg\ndrive 1 m",
        "drive 1 m\nturn left 90 deg\ndrive 0.3 m",
        "drive 1 m\nturn left 180 deg\ndrive 1 m",
        "drive 1 m\nturn left 90 deg\ndrive 1 m back",
        "drive until obstacle within 1 m\nturn left 90 deg\ndrive 1 m",
        "drive 1 m\nturn left 90 deg\narc left 90 deg radius 1 m",
    ],
)
def test_what_cannot_be_rounded_is_refused_with_the_radius_for_an_arc(text: str) -> None:
    result = rehearsed(text)
    assert result.refusal is not None
    assert result.refusal.reason.code == "cannot_turn_on_the_spot"
    assert result.refusal.reason.values["min_radius_m"] == 0.4


def test_a_last_turn_before_words_only_is_left_out_too() -> None:
    result = rehearsed('drive 1 m\nturn left 90 deg\nsay "done"')
    assert result.ok
    assert codes(result) == ["turn_left_out"]


def test_a_repeat_too_long_to_write_out_is_refused() -> None:
    result = rehearsed("repeat 1000\n drive 1 m\n turn left 90 deg\nend")
    assert codes(result) == ["plan_too_large"]
    assert not result.ok
