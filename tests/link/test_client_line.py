"""Whose turns are whose, and who may say what, on the lines of several clients."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.events import Finished, Notice, Ordered, Said, Scan, Started, Telemetry
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import PRIORITIES, Priority
from chatrobot.link.envelope import WORDS, Envelope
from chatrobot.link.motion_link import TURNS, ClientLine

PERSON, AGENT = ClientLine(0), ClientLine(1)
STOPS = ("stop", "emergency_stop")
PERSONS = [source for source, priority in PRIORITIES.items() if priority >= Priority.PLAN]


def said(word: Any, source: str = "agent", turn: int = 1, **payload: Any) -> Envelope:
    return Envelope(word, source, "lease", 1, turn, payload)


@pytest.mark.parametrize("source", PERSONS)
@pytest.mark.parametrize("word", WORDS)
def test_on_an_agents_line_nobody_speaks_as_a_person(word: str, source: str) -> None:
    heard = AGENT.inward(said(word, source))
    assert (heard is not None) == (word in STOPS), "a stop is heard from anybody"


@given(st.sampled_from(WORDS), st.integers(-3 * TURNS, 3 * TURNS))
def test_no_turn_of_one_line_is_a_turn_of_another(word: str, turn: int) -> None:
    ours, theirs = PERSON.inward(said(word, "console", turn)), AGENT.inward(said(word, "agent", turn))
    if ours is not None and word in ("plan", "program"):
        assert ours.turn < TURNS
    assert theirs is None or TURNS <= theirs.turn < 2 * TURNS
    assert word not in STOPS or None not in (ours, theirs)


@given(st.integers(1, TURNS - 1))
def test_an_agent_gets_its_own_numbers_back(turn: int) -> None:
    heard = AGENT.inward(said("plan", turn=turn))
    assert heard is not None
    assert AGENT.outward(Said(heard.turn, "hello")) == Said(turn, "hello")
    assert PERSON.outward(Said(heard.turn, "hello")) == Said(TURNS + turn, "hello")


def test_of_anothers_turn_an_agent_hears_where_the_robot_is_and_who_took_over() -> None:
    telemetry = Telemetry(7, ORIGIN, ZERO_TWIST, 0.0)
    notice = Notice(7, Reason("handed_over", {}))
    assert AGENT.outward(telemetry) == Telemetry(0, ORIGIN, ZERO_TWIST, 0.0)
    assert AGENT.outward(notice) == Notice(0, Reason("handed_over", {}))
    end = Finished(7, "completed", None, ORIGIN, ORIGIN, 0.0, 0.0, 0.0, 0.0)
    assert [AGENT.outward(event) for event in (Started(7), Said(7, "private"), end)] == [None] * 3


def test_scans_go_to_the_line_that_asked() -> None:
    scan, line = Scan(0, ORIGIN, ()), ClientLine(1)
    assert line.outward(scan) is None
    line.inward(said("watch", scans=True))
    assert line.outward(scan) == scan
    line.inward(said("watch", scans=False))
    assert line.outward(scan) is None


def test_a_person_is_told_what_an_agent_orders_and_not_what_they_order_themselves() -> None:
    plan = said("plan", turn=3, plan_text="drive 1 m", rehearse_only=True)
    heard = AGENT.inward(plan)
    assert heard is not None
    assert AGENT.ordered(heard) == Ordered(TURNS + 3, "agent", "drive 1 m", "", True)
    assert PERSON.ordered(plan) is None
    part = AGENT.inward(said("plan", turn=3, plan_text="drive 1 m", mode="extend"))
    assert part is not None
    assert AGENT.ordered(part) is None, "a part of what was told already"
