"""A person with a joystick goes before every plan, program and agent; only an emergency stop goes before the person."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from chatrobot.core.reason import Reason
from chatrobot.wire.messages import TwistMessage
from tests.safety.test_who_drives import Crowd

TOPIC = "chatrobot/joystick"
LEFT, REST = TwistMessage(0.0, 0.0, 0.5), TwistMessage(0.0, 0.0, 0.0)


def hold(crowd: Crowd, twist: TwistMessage, duration_s: float) -> None:
    """The stick is held like that: 20 messages a second."""
    for _ in range(round(duration_s / 0.04)):
        crowd.rig.robot._wire.publish(TOPIC, twist)  # type: ignore[union-attr]
        crowd.live(0.04)


@pytest.mark.parametrize("source", ["chatgpt_node", "agent", "console"])
def test_a_joystick_takes_the_wheel_from_whatever_drives(tmp_path: Path, source: str) -> None:
    crowd = Crowd(tmp_path, source)
    crowd.say(source, "plan", 1, plan_text="drive 5 m")
    crowd.say(source, "plan", 2, plan_text="drive 1 m back")
    crowd.live(1.5)
    hold(crowd, LEFT, 1.0)
    assert crowd.rig.robot.true_twist.wz_radps == pytest.approx(0.5, abs=0.05)
    assert crowd.rig.robot.true_twist.speed_mps < 0.01
    handed_over = Reason("handed_over", {"source": source, "to": "joystick"})
    assert [(crowd.end_of(turn).outcome, crowd.end_of(turn).reason) for turn in (1, 2)] == [
        ("stopped", handed_over)
    ] * 2
    assert crowd.notices() == ["handed_over"]


def test_the_hand_over_keeps_the_ramps(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    crowd.say("console", "plan", 1, plan_text="drive 5 m")
    crowd.live(1.5)
    before = len(crowd.rig.velocities)
    hold(crowd, TwistMessage(-0.3, 0.0, 0.0), 1.0)
    speeds = [crowd.rig.velocities[before - 1].vx_mps, *(v.vx_mps for v in crowd.rig.velocities[before:])]
    limits = crowd.motion._profile.limits
    assert max(abs(b - a) for a, b in itertools.pairwise(speeds)) <= limits.acceleration_mps2 * 0.04 + 1e-9
    assert speeds[-1] == pytest.approx(-0.3)


def test_while_it_is_held_nobody_else_sets_out_and_nothing_waits_for_it_to_be_let_go(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    hold(crowd, LEFT, 0.5)
    crowd.say("console", "plan", 1, plan_text="drive 1 m")
    hold(crowd, LEFT, 0.5)
    assert crowd.end_of(1).outcome == "refused"
    assert crowd.end_of(1).reason == Reason("outranked", {"source": "joystick"})
    crowd.live(2.0)
    assert not crowd.is_moving, "silence is letting go"
    crowd.say("console", "plan", 2, plan_text="drive 0.1 m")
    crowd.live(2.0)
    assert crowd.end_of(2).outcome == "completed"


def test_a_joystick_at_rest_keeps_nobody_from_driving(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    hold(crowd, LEFT, 0.5)
    hold(crowd, REST, 1.5)
    crowd.say("console", "plan", 1, plan_text="drive 0.2 m")
    hold(crowd, REST, 3.0)
    assert crowd.end_of(1).outcome == "completed"


def test_a_stop_holds_for_it_until_it_has_let_go(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    hold(crowd, LEFT, 0.5)
    crowd.say("console", "stop")
    hold(crowd, LEFT, 1.0)
    assert not crowd.is_moving
    crowd.live(0.5)
    hold(crowd, LEFT, 0.5)
    assert crowd.is_moving


def test_an_emergency_stop_goes_before_it(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console", "agent")
    hold(crowd, LEFT, 0.5)
    crowd.say("agent", "emergency_stop", why="test")
    assert not any(crowd.rig.velocities[-1])
    crowd.live(1.0)
    hold(crowd, LEFT, 1.0)
    assert not crowd.is_moving


def test_it_is_held_to_the_limits(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    hold(crowd, TwistMessage(99.0, 0.0, 0.0), 2.0)
    top = max(velocity.vx_mps for velocity in crowd.rig.velocities)
    assert 0.05 < top <= crowd.motion._profile.limits.max_speed_mps


def test_where_it_may_not_begin_the_robot_stands_nevertheless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    crowd = Crowd(tmp_path, "console")
    crowd.say("console", "plan", 1, plan_text="drive 5 m")
    crowd.live(1.5)
    monkeypatch.setattr(crowd.motion._robot, "begin", lambda *_: Reason("battery_low"))
    hold(crowd, LEFT, 1.0)
    assert not crowd.is_moving, "nobody drives: what was sent last must not stand"
    assert crowd.notices() == ["handed_over", "battery_low"]
