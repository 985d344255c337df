"""Stamps of other clocks become ages on ours."""

from __future__ import annotations

import math
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.wire.stamps import JUMP_S, LATEST_S, WINDOW_S, StampTranslator, to_wall_s

SKEW_S = 1_700_000_000.0


def after(
    clock: StampTranslator, *, travel_s: float = 0.001, seconds: float = 1.0, skew_s: float = SKEW_S
) -> float:
    """A sender at 50 Hz for so long; the time on our clock afterwards."""
    now_s = 100.0
    for tick in range(round(seconds * 50)):
        now_s = 100.0 + tick * 0.02
        clock.local_s(now_s + skew_s, now_s + travel_s)
    return now_s


@pytest.mark.parametrize("skew_s", [SKEW_S, 5.0, 0.0, -90.0])
def test_a_late_message_keeps_its_age_whatever_the_other_clock_says(skew_s: float) -> None:
    clock = StampTranslator()
    now_s = after(clock, skew_s=skew_s) + 0.02
    assert clock.local_s(now_s + skew_s, now_s + 0.4) == pytest.approx(now_s + 0.001, abs=1e-6)


@pytest.mark.parametrize("stamp_s", [0.0, -5.0, math.nan, math.inf])
def test_where_there_is_no_stamp_the_time_of_receipt_counts(stamp_s: float) -> None:
    assert StampTranslator().local_s(stamp_s, 50.0) == 50.0


def test_a_clock_that_drifts_is_followed() -> None:
    clock = StampTranslator()
    slow = 1.0 - 100e-6
    for tick in range(round(60 * WINDOW_S)):
        now_s = tick * 0.1 + 1.0
        assert now_s - clock.local_s(now_s * slow + SKEW_S, now_s) <= 2 * WINDOW_S * 100e-6 + 1e-6


@pytest.mark.parametrize("jump_s", [3600.0, JUMP_S + 0.5, -(LATEST_S + 1.0), -3600.0])
def test_a_clock_that_is_set_is_learned_anew(jump_s: float) -> None:
    clock = StampTranslator()
    now_s = after(clock) + 0.02
    for tick in range(3):
        at_s = now_s + tick * 0.02
        assert clock.local_s(at_s + SKEW_S + jump_s, at_s) == pytest.approx(at_s, abs=1e-6)


@given(st.lists(st.tuples(st.floats(allow_nan=True), st.floats(0.0, 5.0)), max_size=30))
def test_nothing_is_ever_stamped_later_than_it_came(steps: list[tuple[float, float]]) -> None:
    clock, now_s = StampTranslator(), 1000.0
    for stamp_s, step_s in steps:
        now_s += step_s
        assert clock.local_s(stamp_s, now_s) <= now_s


def test_what_we_stamp_is_wall_time() -> None:
    assert to_wall_s(time.monotonic()) == pytest.approx(time.time(), abs=0.01)
