"""A heartbeat of a running process that comes late slows the robot, to zero at its lease's term; later it is over."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from tests.governor.situations import with_safety

from chatrobot.core.geometry import Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.governor.governor import LATE_BEAT, Governor, Verdict
from chatrobot.governor.lease import LATE_S, LONGEST_S, OVER_S, Leases
from chatrobot.governor.rule import Sensed
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import Safety

TERM_S = 0.2
PROFILE = replace(load_profile("wheeltec_mini_mec"), lidar=None)
SLOW = Twist(0.3, 0.0, 0.0)


class Process:
    """Of the source. Nobody can tell of one that is elsewhere."""

    def __init__(self) -> None:
        self.is_stopped = False


def opened(process: Process | None) -> Leases:
    leases = Leases()
    leases.open("a", "console", TERM_S, 10.0, (lambda: process.is_stopped) if process else None)
    return leases


@pytest.mark.parametrize(
    ("age_s", "share"),
    [(0.0, 1.0), (TERM_S - LATE_S, 1.0), (TERM_S - 0.5 * LATE_S, 0.5), (TERM_S, 0.0), (OVER_S, 0.0)],
)
def test_the_share_of_the_speed_falls_to_zero_at_the_term(age_s: float, share: float) -> None:
    leases = opened(Process())
    assert leases.share("a", 10.0 + age_s) == pytest.approx(share)
    assert leases.is_late("a", 10.0 + age_s + 1e-6) == (age_s >= TERM_S - LATE_S)


def test_who_runs_is_over_at_0_45_s_and_who_cannot_be_seen_at_the_term() -> None:
    seen, unseen = opened(Process()), opened(None)
    assert seen.is_valid("a", 10.0 + OVER_S)
    assert not seen.is_valid("a", 10.0 + OVER_S + 0.01)
    assert not unseen.is_valid("a", 10.0 + TERM_S + 0.01)
    assert unseen.share("a", 10.0 + TERM_S) == 1.0, "what is over at its term is not slowed before"
    assert not unseen.is_late("a", 10.0 + TERM_S)


def test_how_long_we_were_held_up_ourselves_is_added_up_to_one_second_until_the_next_beat() -> None:
    leases = opened(Process())
    leases.note_held_up(0.3)
    assert leases.is_valid("a", 10.0 + OVER_S + 0.29)
    assert not leases.is_valid("a", 10.0 + OVER_S + 0.31)
    leases.note_held_up(5.0)
    assert leases.is_valid("a", 10.0 + LONGEST_S)
    assert not leases.is_valid("a", 10.0 + LONGEST_S + 0.01)
    leases.beat("a", 12.0)
    assert not leases.is_valid("a", 12.0 + OVER_S + 0.01)


def test_a_stopped_process_is_told_whatever_its_beats() -> None:
    process = Process()
    leases = opened(process)
    assert not leases.is_stopped("a")
    process.is_stopped = True
    assert leases.is_stopped("a")
    assert not opened(None).is_stopped("a")
    assert not leases.is_stopped("b")


def test_an_ended_an_entrusted_and_an_unknown_lease_are_never_late() -> None:
    leases = opened(Process())
    assert leases.is_late("a", 10.19)
    leases.entrust("a")
    assert (leases.is_late("a", 1e6), leases.share("a", 1e6)) == (False, 1.0)
    leases.end("a")
    assert not leases.is_late("a", 10.19)
    assert (leases.is_late("b", 10.0), leases.share("b", 10.0)) == (False, 1.0)


def test_it_tells_how_late_the_beat_is() -> None:
    leases = opened(Process())
    assert leases.lateness("a", 10.19) == Reason("beat_late", {"source": "console", "late_s": 0.19})
    assert leases.lateness("a", math.inf).values["late_s"] == 999.0


class TestGoverned:
    """What the governor makes of it."""

    @pytest.fixture
    def governor(self) -> Governor:
        governor = Governor(PROFILE, StopEpoch())
        governor.leases.open("a", "console", TERM_S, 0.0, lambda: False)
        governor.begin("a", 0.0)
        return governor

    def sent_mps(self, governor: Governor, now_s: float) -> tuple[Verdict, float]:
        verdict = governor.govern(SLOW, "a", now_s)
        return verdict, verdict.sent.twist.vx_mps

    def reach(self, governor: Governor, until_s: float) -> None:
        for tick in range(round(until_s / 0.02)):
            governor.leases.beat("a", tick * 0.02)
            governor.govern(SLOW, "a", tick * 0.02)

    def test_it_slows_and_says_so(self, governor: Governor) -> None:
        self.reach(governor, 1.0)
        governor.leases.beat("a", 1.0)
        verdict, sent_mps = self.sent_mps(governor, 1.0 + TERM_S - 0.8 * LATE_S)
        assert (verdict.action, verdict.rule, verdict.asked) == ("limited", LATE_BEAT, SLOW)
        assert verdict.reason is not None
        assert verdict.reason.code == "beat_late"
        assert 0.0 < sent_mps < 0.3

    def test_it_is_zero_at_the_term_without_a_ramp_and_goes_on_with_the_next_beat(
        self, governor: Governor
    ) -> None:
        self.reach(governor, 1.0)
        verdict, sent_mps = self.sent_mps(governor, 0.98 + TERM_S + 0.001)
        assert (verdict.action, verdict.rule, sent_mps) == ("limited", LATE_BEAT, 0.0)
        governor.leases.beat("a", 1.2)
        assert governor.govern(SLOW, "a", 1.2).action != "refused"

    def test_it_is_refused_when_it_is_over(self, governor: Governor) -> None:
        assert governor.govern(SLOW, "a", OVER_S + 0.01).rule == "lease_lapsed"

    def test_a_rule_that_gives_a_reason_is_what_is_told(self) -> None:
        governor = Governor(with_safety(Safety(battery_low_percent=20.0), PROFILE), StopEpoch())
        governor.leases.open("a", "console", TERM_S, 0.0, lambda: False)
        governor.begin("a", 0.0)
        fast = Twist(1.0, 0.0, 0.0)
        governor.govern(fast, "a", 0.0)
        verdict = governor.govern(fast, "a", TERM_S - 0.9 * LATE_S, sensed=Sensed(battery_percent=10.0))
        assert verdict.reason is not None
        assert verdict.reason.code == "battery_low"
