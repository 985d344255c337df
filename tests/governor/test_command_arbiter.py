"""One source drives at a time; the higher one takes over in the open, and a stop takes command from all."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import pytest

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.governor.governor import VOID_EPOCH, Governor
from chatrobot.governor.lease import PRIORITIES, RELEASERS, Priority, priority_of
from chatrobot.governor.rule import Sensed
from chatrobot.motion.safety.stop import WireTransport
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import Safety, Wiring
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import TwistMessage

PROFILE = replace(load_profile("wheeltec_mini_mec"), lidar=None)
SLOW = Twist(0.3, 0.0, 0.0)
LOW_TO_HIGH = ["chatgpt_node", "agent", "console", "joystick"]
PAIRS = list(itertools.combinations(LOW_TO_HIGH, 2))


def governor_with(*sources: str) -> tuple[Governor, StopEpoch]:
    """Each source has a lease of its own name."""
    governor = Governor(PROFILE, epoch := StopEpoch())
    for source in sources:
        governor.leases.open(source, source, 0.3, 0.0)
    return governor, epoch


def test_the_order_is_joystick_plan_agent_foreign_text_and_whoever_is_not_listed_comes_last() -> None:
    assert [priority_of(source) for source in LOW_TO_HIGH] == sorted(Priority)
    assert priority_of("somebody else") == min(Priority)
    assert {priority_of("program"), priority_of("web"), priority_of("mcp")} == {
        Priority.PLAN,
        Priority.AGENT,
    }
    assert priority_of("program") == priority_of("web") == priority_of("console") == Priority.PLAN
    assert priority_of("mcp") == Priority.AGENT
    assert priority_of("base") == Priority.PLAN
    assert priority_of("pupil") == Priority.PLAN
    assert set(PRIORITIES) == {*LOW_TO_HIGH, "program", "web", "base", "mcp", "pupil", "stick"}
    assert priority_of("stick") == Priority.JOYSTICK


@pytest.mark.parametrize(("low", "high"), PAIRS)
def test_a_lower_one_is_refused_while_a_higher_one_drives(low: str, high: str) -> None:
    governor, epoch = governor_with(low, high)
    assert governor.begin(high, 0.0).refusal is None
    refusal = governor.begin(low, 0.0).refusal
    assert refusal is not None
    assert (refusal.code, refusal.values) == ("outranked", {"source": high})
    verdict = governor.govern(SLOW, low, 0.0)
    assert (verdict.action, verdict.rule) == ("refused", "outranked")
    assert verdict.sent.epoch == VOID_EPOCH != epoch.value


@pytest.mark.parametrize(("low", "high"), PAIRS)
def test_a_higher_one_takes_over_and_says_from_whom(low: str, high: str) -> None:
    governor, _ = governor_with(low, high)
    assert governor.begin(low, 0.0).from_source == ""
    moving = governor.govern(SLOW, low, 0.0).sent.twist
    taken = governor.begin(high, TICK_S)
    assert (taken.refusal, taken.from_source) == (None, low)
    assert governor.govern(SLOW, low, TICK_S).rule == "outranked"
    onwards = governor.govern(SLOW, high, TICK_S).sent.twist
    assert 0.0 < onwards.vx_mps - moving.vx_mps <= PROFILE.limits.acceleration_mps2 * TICK_S + 1e-9


def test_of_two_equals_the_first_drives_on() -> None:
    governor, _ = governor_with("console", "program")
    governor.begin("program", 0.0)
    refusal = governor.begin("console", 0.0).refusal
    assert refusal is not None
    assert refusal.code == "outranked"
    assert governor.govern(SLOW, "program", 0.0).sent.twist.vx_mps > 0.0


def test_who_drives_may_begin_anew_without_taking_over_from_itself() -> None:
    governor, _ = governor_with("console")
    assert governor.begin("console", 0.0).refusal is None
    again = governor.begin("console", 0.0)
    assert (again.refusal, again.from_source) == (None, "")


def test_the_end_of_a_motion_frees_the_wheel_and_nobody_ends_anothers() -> None:
    governor, _ = governor_with("agent", "console")
    governor.begin("console", 0.0)
    governor.end("agent")
    assert governor.begin("agent", 0.0).refusal is not None
    governor.end("console")
    assert governor.begin("agent", 0.0).refusal is None
    assert governor.govern(SLOW, "console", 0.0).rule == "outranked"


def test_a_lapsed_lease_lets_go_of_the_wheel() -> None:
    governor, _ = governor_with("joystick", "agent")
    governor.begin("joystick", 0.0)
    governor.leases.beat("agent", 0.4)
    taken = governor.begin("agent", 0.4)
    assert (taken.refusal, taken.from_source) == (None, "")


def test_a_stop_takes_the_wheel_out_of_every_hand() -> None:
    governor, epoch = governor_with("joystick", "agent")
    governor.begin("joystick", 0.0)
    epoch.stop()
    stopped = governor.govern(SLOW, "joystick", 0.0)
    assert (stopped.rule, stopped.sent.twist.is_zero, stopped.sent.epoch) == ("not_begun", True, epoch.value)
    assert governor.begin("agent", 0.0).refusal is None


def test_nobody_begins_without_a_lease_or_under_an_emergency_stop() -> None:
    governor, _ = governor_with("console")
    refusal = governor.begin("nobody", 0.0).refusal
    assert refusal is not None
    assert (refusal.code, refusal.values) == ("lease_lapsed", {"source": "unknown"})
    late = governor.begin("console", 0.31).refusal
    assert late is not None
    assert late.values == {"source": "console"}
    governor.latch("bystander", "smoke")
    latched = governor.begin("console", 0.0).refusal
    assert latched is governor.latched
    assert latched is not None
    assert latched.values == {"source": "bystander", "why": "smoke"}
    assert latched.code == "emergency_stop"


def test_an_emergency_stop_is_above_them_all() -> None:
    governor, _ = governor_with("joystick")
    governor.begin("joystick", 0.0)
    governor.latch("chatgpt_node", "")
    verdict = governor.govern(SLOW, "joystick", 0.0)
    assert (verdict.rule, verdict.sent.twist.is_zero) == ("emergency_stop", True)


def test_only_a_person_at_the_local_console_releases_unless_the_composition_root_names_others() -> None:
    governor, _ = governor_with()
    governor.latch("console", "first")
    governor.latch("agent", "second")
    for source in ("agent", "mcp", "chatgpt_node", "joystick", "stick", "program", "web", "Console", ""):
        assert not governor.release(source)
        assert governor.latched is not None
        assert governor.latched.values == {"source": "console", "why": "first"}
    assert {"console"} == RELEASERS
    assert governor.release("console")
    assert governor.latched is None
    opted_in = Governor(PROFILE, StopEpoch(), releasers=("service",))
    opted_in.latch("x", "")
    assert opted_in.release("service")
    assert not opted_in.release("console")


def test_what_an_outranked_source_asks_never_reaches_the_wire_not_even_as_a_zero() -> None:
    governor, epoch = governor_with("joystick", "agent")
    hub, sent = MemoryHub(), list[TwistMessage]()
    hub.connect().subscribe("cmd_vel", TwistMessage, sent.append)
    transport = WireTransport(hub.connect(), Wiring(), epoch)
    governor.begin("joystick", 0.0)
    assert transport.send(governor.govern(SLOW, "joystick", 0.0).sent)
    assert not transport.send(governor.govern(SLOW, "agent", 0.0).sent)
    assert len(sent) == 1


def test_what_an_outranked_source_asks_does_not_change_the_ramp_of_who_drives() -> None:
    governor, _ = governor_with("joystick", "agent")
    governor.leases.open("joystick", "joystick", math.inf, 0.0)
    governor.begin("joystick", 0.0)
    for tick in range(5):
        governor.govern(SLOW, "joystick", tick * TICK_S)
        governor.govern(Twist(math.nan, 0.0, 0.0), "agent", tick * TICK_S)
    assert governor.govern(SLOW, "joystick", 5 * TICK_S).sent.twist.vx_mps == pytest.approx(0.12)


def test_the_wheel_is_free_after_a_motion_ended_whatever_stops_there_were_before() -> None:
    for stops in range(4):
        governor, epoch = governor_with("joystick", "agent")
        for _ in range(stops):
            epoch.stop()
        governor.begin("joystick", 0.0)
        governor.end("joystick")
        assert governor.begin("agent", 0.0).refusal is None


def test_a_low_battery_refuses_a_new_motion_whoever_asks() -> None:
    low = replace(PROFILE, safety=Safety(battery_low_percent=30.0))
    governor = Governor(low, StopEpoch())
    governor.leases.open("joystick", "joystick", 0.3, 0.0)
    refusal = governor.begin("joystick", 0.0, Sensed(battery_percent=29.0)).refusal
    assert refusal is not None
    assert refusal.code == "battery_low"
    assert governor.begin("joystick", 0.0, Sensed(battery_percent=30.0)).refusal is None
