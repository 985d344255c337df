"""The highest speed that a person sets binds every plan that is said, until the person ends it."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.language.speed_limit import kept_within
from chatrobot.plan.steps import Arc, Drive, RawTwist, Repeat
from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation
from tests.language.profiles import MECANUM


def said(*turns: str) -> tuple[str, str]:
    """What the last turn leads to, and the plan that it gives or offers."""
    meant = conversation(*turns[:-1]).say(turns[-1])
    plan = meant.plan or meant.offered_plan
    return meant.outcome, "; ".join(format_plan(plan).splitlines()) if plan else ""


@pytest.mark.parametrize(
    ("limit", "order", "plan"),
    [
        ("never go faster than 0.2 m/s", "forward 1 m", "drive 1 m at 0.2 m/s"),
        ("from here on nothing faster than 0.15 metres per second, please", "back 1 m", "drive 1 m back at 0.15 m/s"),
        ("Robot, do not go faster than 20 cm/s", "go fast for 1 m", "drive 1 m at 0.2 m/s"),
        ("keep below 0.2 m/s all day", "full speed ahead 1 m", "drive 1 m at 0.2 m/s"),
        ("don't exceed 20 cm per second", "forward 1 m quickly", "drive 1 m at 0.2 m/s"),
        ("the speed limit in here is 0.25 m/s", "forward 1 m", "drive 1 m at 0.25 m/s"),
        ("max speed 0.6", "full speed ahead 1 m", "drive 1 m at 0.6 m/s"),
        ("from now on at most 0.2 m/s", "forward 1 m", "drive 1 m at 0.2 m/s"),
        ("limit your speed to 0.2 m/s", "forward 1 m", "drive 1 m at 0.2 m/s"),
        ("your speed must never be above 0.2 m/s", "forward 1 m", "drive 1 m at 0.2 m/s"),
        ("以后都不要超过每秒0.2米", "前进一米", "drive 1 m at 0.2 m/s"),
        ("限速0.2米每秒", "全速前进两米", "drive 2 m at 0.2 m/s"),
        ("最高速度设为每秒20厘米", "快速前进一米", "drive 1 m at 0.2 m/s"),
        ("速度控制在0.2米每秒以内", "前进一米", "drive 1 m at 0.2 m/s"),
        ("从现在起最快只能开0.2米每秒", "前进一米", "drive 1 m at 0.2 m/s"),
        ("Fahr nie schneller als 0,2 m/s", "Vollgas 1 m vor", "drive 1 m at 0.2 m/s"),
        ("Das Tempolimit ist 0,2 m/s", "Fahr schnell 1 m vor", "drive 1 m at 0.2 m/s"),
        ("Ab jetzt höchstens 0,2 m/s", "1 m vor", "drive 1 m at 0.2 m/s"),
        ("Höchstgeschwindigkeit ist 0,2 m/s", "1 m vor", "drive 1 m at 0.2 m/s"),
    ],
)  # fmt: skip
def test_a_limit_moves_nothing_and_binds_what_is_said_after_it(limit: str, order: str, plan: str) -> None:
    assert said(limit) == ("answered", "")
    assert said(limit, order) == ("plan", plan)


@pytest.mark.parametrize(
    ("limit", "order"),
    [
        ("never go faster than 0.2 m/s", "forward 1 m at 0.5 m/s"),
        ("以后都不要超过每秒0.2米", "以0.5米每秒前进一米"),
        ("Fahr nie schneller als 0,2 m/s", "Fahr 1 m mit 0,5 m/s vor"),
    ],
)
def test_an_order_beyond_the_limit_is_refused_and_offered_at_the_limit(limit: str, order: str) -> None:
    assert said(limit, order) == ("refused", "drive 1 m at 0.2 m/s")


def test_what_was_done_faster_before_is_repeated_within_the_limit_only() -> None:
    before = ("forward 1 m at 0.5 m/s", "never go faster than 0.2 m/s")
    assert said(*before, "do that again") == ("refused", "drive 1 m at 0.2 m/s")


@pytest.mark.parametrize(
    "end", ["no speed limit", "lift the speed limit", "you may go as fast as you like again"]
)
def test_a_limit_ends_when_it_is_said_to(end: str) -> None:
    assert said("never go faster than 0.2 m/s", end, "forward 1 m at 0.5 m/s") == (
        "plan",
        "drive 1 m at 0.5 m/s",
    )


def test_a_limit_ends_in_the_other_languages_too() -> None:
    fast = ("plan", "drive 1 m at 0.5 m/s")
    assert said("限速0.2米每秒", "取消限速", "以0.5米每秒前进一米") == fast
    assert said("Das Tempolimit ist 0,2 m/s", "kein Tempolimit mehr", "Fahr 1 m mit 0,5 m/s vor") == fast


def test_another_limit_takes_the_place_of_the_one_before() -> None:
    assert said("max speed 0.2", "max speed 0.6", "forward 1 m at 0.5 m/s") == (
        "plan",
        "drive 1 m at 0.5 m/s",
    )


@pytest.mark.parametrize(
    "text",
    [
        "forward 1 m but never faster than 0.2 m/s",
        "drive 1 m, no faster than 0.2 m/s",
        "前进一米，速度不要超过0.2米每秒",
    ],
)
def test_a_speed_that_is_said_of_one_motion_is_no_limit(text: str) -> None:
    assert said(text) == ("plan", "drive 1 m at 0.2 m/s")
    assert said(text, "forward 1 m at 0.5 m/s") == ("plan", "drive 1 m at 0.5 m/s")


@pytest.mark.parametrize(
    "text", ["never go faster than 3 m", "never go faster than a cat", "what is the speed limit?"]
)
def test_what_is_no_speed_sets_no_limit(text: str) -> None:
    assert said(text)[1] == ""
    assert said(text, "forward 1 m at 0.5 m/s") == ("plan", "drive 1 m at 0.5 m/s")


@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(-2, 2), st.floats(0.1, 5), st.floats(0.05, 2))
def test_a_twist_within_the_limit_is_on_the_same_path(
    vx: float, vy: float, wz: float, duration_s: float, limit_mps: float
) -> None:
    slow = kept_within(RawTwist(vx, vy, wz, duration_s), limit_mps, MECANUM)
    assert isinstance(slow, RawTwist)
    assert math.hypot(slow.vx_mps, slow.vy_mps) <= limit_mps * (1 + 1e-9)
    assert slow.vx_mps * slow.duration_s == pytest.approx(vx * duration_s)
    assert slow.wz_radps * slow.duration_s == pytest.approx(wz * duration_s)


def test_steps_in_a_repeat_keep_to_the_limit_too() -> None:
    steps = Repeat(2, (Drive(distance_m=1), Arc(1, 1, speed_mps=0.5)))
    slow = kept_within(steps, 0.2, MECANUM)
    assert isinstance(slow, Repeat)
    assert [step.speed_mps for step in slow.steps] == [0.2, 0.2]  # type: ignore[attr-defined]
