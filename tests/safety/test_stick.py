"""A person's stick over the link: only its own messages keep it, and nobody but a person may hold it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from chatrobot.core.reason import Reason
from tests.safety.test_who_drives import Crowd

AHEAD: dict[str, Any] = {"vx_mps": 0.3}
LEFT: dict[str, Any] = {"wz_radps": 0.5}
PERIOD_S = 0.06
WITHIN_S = 0.25


def hold(crowd: Crowd, twist: dict[str, Any], duration_s: float, source: str = "console") -> None:
    """The stick is held like that: some 17 messages a second."""
    for _ in range(round(duration_s / PERIOD_S)):
        crowd.say(source, "steer", **twist)
        crowd.live(PERIOD_S)


def let_go(crowd: Crowd, source: str = "console") -> None:
    crowd.say(source, "steer")
    crowd.live(0.02)


def held(folder: Path, *sources: str, twist: dict[str, Any] = AHEAD) -> Crowd:
    crowd = Crowd(folder, *sources)
    hold(crowd, twist, 1.0, sources[0])
    assert crowd.is_moving
    return crowd


def is_zero(crowd: Crowd) -> bool:
    return not any(crowd.rig.velocities[-1])


@pytest.mark.parametrize("source", ["console", "web", "base"])
def test_a_person_steers_as_asked(tmp_path: Path, source: str) -> None:
    crowd = held(tmp_path, source, twist={"vx_mps": 0.2, "vy_mps": 0.1, "wz_radps": 0.4})
    assert crowd.rig.velocities[-1] == pytest.approx((0.2, 0.1, 0.4), abs=1e-6)


@pytest.mark.parametrize(
    "source", ["agent", "mcp", "chatgpt_node", "program", "joystick", "stick", "whoever"]
)
def test_nobody_else_may_steer_and_is_told_so_once(tmp_path: Path, source: str) -> None:
    crowd = Crowd(tmp_path, "console", source)
    hold(crowd, AHEAD, 1.0, source)
    assert not crowd.rig.velocities
    assert crowd.notices() == ["may_not_steer"]


def test_one_that_never_said_hello_may_not_steer(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    crowd._senders["web"] = type(crowd._senders["console"])("web")
    hold(crowd, AHEAD, 1.0, "web")
    assert not crowd.rig.velocities


def test_beats_do_not_keep_it(tmp_path: Path) -> None:
    crowd = held(tmp_path, "console")
    crowd.live(WITHIN_S - PERIOD_S)
    assert is_zero(crowd), "the console beats on, and the stick is silent"
    crowd.live(1.0)
    assert is_zero(crowd)


def test_a_zero_lets_go_at_once(tmp_path: Path) -> None:
    crowd = held(tmp_path, "console")
    let_go(crowd)
    assert is_zero(crowd)
    crowd.say("console", "plan", 1, plan_text="drive 0.1 m back")
    crowd.live(3.0)
    assert crowd.end_of(1).outcome == "completed"


def test_it_may_be_held_again_before_the_robot_stands(tmp_path: Path) -> None:
    crowd = held(tmp_path, "console")
    let_go(crowd)
    hold(crowd, LEFT, 0.6)
    assert crowd.rig.velocities[-1] == pytest.approx((0.0, 0.0, 0.5), abs=1e-6)


def test_it_drives_on_after_a_network_that_stuttered(tmp_path: Path) -> None:
    crowd = held(tmp_path, "console")
    crowd.live(0.3)
    assert is_zero(crowd)
    hold(crowd, AHEAD, 0.5)
    assert not is_zero(crowd)


@pytest.mark.parametrize("source", ["chatgpt_node", "agent", "console", "program"])
def test_it_takes_the_wheel_from_whatever_drives(tmp_path: Path, source: str) -> None:
    crowd = Crowd(tmp_path, *dict.fromkeys(("console", source)))
    crowd.say(source, "plan", 1, plan_text="drive 5 m")
    crowd.say(source, "plan", 2, plan_text="drive 1 m back")
    crowd.live(1.5)
    hold(crowd, LEFT, 1.0)
    assert crowd.rig.robot.true_twist.wz_radps == pytest.approx(0.5, abs=0.05)
    handed_over = Reason("handed_over", {"source": source, "to": "stick"})
    ends = [(crowd.end_of(turn).outcome, crowd.end_of(turn).reason) for turn in (1, 2)]
    assert ends == [("stopped", handed_over)] * 2
    assert crowd.notices() == ["handed_over"]


def test_no_plan_sets_out_while_it_is_held_and_none_waits_for_it(tmp_path: Path) -> None:
    crowd = held(tmp_path, "console")
    crowd.say("console", "plan", 1, plan_text="drive 1 m")
    hold(crowd, AHEAD, 0.5)
    assert crowd.end_of(1).outcome == "refused"
    assert crowd.end_of(1).reason == Reason("outranked", {"source": "stick"})
    let_go(crowd)
    crowd.live(2.0)
    assert not crowd.is_moving
    crowd.say("console", "plan", 2, plan_text="drive 0.1 m")
    crowd.live(2.0)
    assert crowd.end_of(2).outcome == "completed"


@pytest.mark.parametrize("stopper", ["console", "agent"])
def test_after_a_stop_it_has_to_be_let_go_and_a_stutter_is_no_letting_go(
    tmp_path: Path, stopper: str
) -> None:
    crowd = held(tmp_path, "console", "agent")
    crowd.say(stopper, "stop")
    assert is_zero(crowd), "the zero is out before `receive` returns"
    hold(crowd, AHEAD, 1.0)
    crowd.live(0.5)  # the network stutters
    hold(crowd, AHEAD, 1.0)
    assert not crowd.is_moving
    let_go(crowd)
    hold(crowd, AHEAD, 0.5)
    assert crowd.is_moving


def test_a_stick_that_waits_in_the_inbox_when_a_stop_comes_does_not_drive_after_it(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    crowd.say("console", "steer", **AHEAD)
    crowd.say("console", "stop")
    crowd.live(0.02)
    hold(crowd, AHEAD, 0.5)
    assert not any(any(velocity) for velocity in crowd.rig.velocities)


def test_an_emergency_stop_goes_before_it_and_says_so_when_it_is_pressed_again(tmp_path: Path) -> None:
    crowd = held(tmp_path, "console", "agent")
    crowd.say("agent", "emergency_stop", why="test")
    assert is_zero(crowd)
    crowd.live(1.0)
    hold(crowd, AHEAD, 1.0)
    assert not crowd.is_moving
    assert crowd.notices() == ["emergency_stop"]


def test_it_is_held_to_the_limits(tmp_path: Path) -> None:
    crowd = held(tmp_path, "console", twist={"vx_mps": 99.0, "vy_mps": -99.0, "wz_radps": 99.0})
    limits = crowd.motion._profile.limits
    fastest = max(crowd.rig.velocities, key=lambda velocity: abs(velocity.vx_mps))
    assert 0.05 < fastest.vx_mps <= limits.max_speed_mps
    assert abs(fastest.wz_radps) <= limits.max_rate_radps


def test_one_person_steers_at_a_time(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console", "web")
    for _ in range(10):
        crowd.say("console", "steer", **AHEAD)
        crowd.say("web", "steer", **LEFT)
        crowd.live(PERIOD_S)
    assert crowd.rig.velocities[-1].wz_radps == 0.0
    assert crowd.notices() == ["outranked"]
    let_go(crowd)
    hold(crowd, LEFT, 0.5, "web")
    assert crowd.rig.velocities[-1].wz_radps > 0.0


def test_whoever_is_lost_or_leaves_steers_no_more(tmp_path: Path) -> None:
    crowd = held(tmp_path, "console")
    crowd.say("console", "goodbye")
    hold(crowd, AHEAD, 0.12)
    assert is_zero(crowd)
    crowd = held(tmp_path, "web", "console")
    crowd.motion.lose(crowd._senders["web"].lease)
    assert is_zero(crowd)
    let_go(crowd, "web")
    hold(crowd, AHEAD, 0.5, "web")
    assert is_zero(crowd)


def test_an_old_message_of_it_counts_for_nothing_and_overtakes_no_plan(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    sender = crowd._senders["console"]
    old, plan = sender.envelope("steer", **AHEAD), sender.envelope("plan", 1, plan_text="drive 0.1 m")
    let_go(crowd)
    crowd.motion.receive(old)
    crowd.live(0.1)
    assert not crowd.is_moving
    crowd.motion.receive(plan)
    crowd.live(2.0)
    assert crowd.end_of(1).outcome == "completed"
