"""Leases by themselves."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.clock import BEAT_HZ, LOCAL_BEAT_HZ, LOCAL_TERM_S, TERM_S
from chatrobot.governor.lease import Leases, Priority


def opened(source: str = "console", term_s: float = 0.25) -> Leases:
    leases = Leases()
    leases.open("a", source, term_s, 10.0)
    return leases


def test_two_beats_may_be_lost_before_a_lease_lapses() -> None:
    assert TERM_S >= 2.9 / BEAT_HZ
    assert LOCAL_TERM_S >= 2.9 / LOCAL_BEAT_HZ
    assert LOCAL_TERM_S <= 0.2, "zeros within 250 ms of a freeze"
    assert TERM_S == 0.3


def test_it_is_valid_for_its_term_and_not_longer() -> None:
    leases = opened()
    assert leases.is_valid("a", 10.0)
    assert leases.is_valid("a", 10.25)
    assert not leases.is_valid("a", 10.26)


def test_a_beat_begins_the_term_anew() -> None:
    leases = opened()
    leases.beat("a", 10.2)
    assert leases.is_valid("a", 10.45)
    assert not leases.is_valid("a", 10.46)


def test_a_clock_that_went_back_makes_it_invalid_until_the_next_beat() -> None:
    leases = opened()
    assert leases.is_valid("a", 9.75)
    assert not leases.is_valid("a", 9.7)
    leases.beat("a", 9.7)
    assert leases.is_valid("a", 9.7)


@pytest.mark.parametrize("now_s", [math.nan, math.inf, -math.inf])
def test_at_no_time_at_all_it_is_invalid(now_s: float) -> None:
    assert not opened().is_valid("a", now_s)


def test_the_end_is_for_good() -> None:
    leases = opened()
    leases.end("a")
    leases.beat("a", 10.1)
    assert not leases.is_valid("a", 10.1)
    leases.entrust("a")
    assert not leases.is_valid("a", 10.1)


def test_an_entrusted_lease_needs_no_beats() -> None:
    leases = opened()
    leases.entrust("a")
    assert leases.is_valid("a", 1e9)
    assert not leases.is_valid("a", math.nan)


def test_nobody_can_beat_entrust_end_or_use_what_was_never_opened() -> None:
    leases = opened()
    for act in (leases.entrust, leases.end):
        act("b")
    leases.beat("b", 10.0)
    assert not leases.is_valid("b", 10.0)
    assert leases.is_valid("a", 10.0)
    assert (leases.source_of("b"), leases.priority_of("b")) == ("unknown", Priority.FOREIGN)


def test_it_knows_its_source() -> None:
    assert opened("joystick").source_of("a") == "joystick"
    assert opened("joystick").priority_of("a") == Priority.JOYSTICK


def test_leases_do_not_touch_each_other() -> None:
    leases = opened()
    leases.open("b", "agent", 1.0, 10.0)
    leases.end("a")
    assert leases.is_valid("b", 11.0)
    assert not leases.is_valid("b", 11.01)


def test_a_lease_is_known_from_its_opening_on_whatever_became_of_it() -> None:
    leases = opened()
    assert not leases.is_known("b")
    leases.end("a")
    assert leases.is_known("a")
