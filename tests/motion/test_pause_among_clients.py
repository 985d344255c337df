"""Who may go on with a paused plan, and what drops it, at Motion itself."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.safety.test_who_drives import Crowd

from chatrobot.core.events import Paused, Started
from chatrobot.wire.messages import TwistMessage


@pytest.fixture
def crowd(tmp_path: Path) -> Crowd:
    """The console's plan of two metres is paused; `web` and others are there, too."""
    crowd = Crowd(tmp_path, "console", "web", "chatgpt_node")
    crowd.say("console", "plan", 1, plan_text="drive 2 m", mode="queue", pauses=0)
    crowd.live(2.0)
    assert crowd.is_moving
    crowd.say("console", "stop", keep=True, why="pause")
    crowd.live(1.0)
    assert len([event for event in crowd.events if isinstance(event, Paused)]) == 1
    assert not crowd.is_moving
    return crowd


def ended_by(crowd: Crowd) -> str:
    end = crowd.end_of(1)
    assert end.outcome == "stopped"
    assert end.reason is not None
    assert end.paused_s >= 1.0
    return end.reason.code


def test_its_own_source_goes_on_with_it(crowd: Crowd) -> None:
    crowd.say("console", "resume", 1)
    crowd.live(10.0)
    assert crowd.end_of(1).outcome == "completed"
    assert crowd.end_of(1).path_m == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize(("source", "turn"), [("web", 1), ("chatgpt_node", 1), ("console", 2)])
def test_nobody_else_does_and_no_other_turn(crowd: Crowd, source: str, turn: int) -> None:
    crowd.say(source, "resume", turn)
    crowd.live(3.0)
    assert not crowd.is_moving
    assert crowd.notices() == ["nothing_paused"]
    assert len([event for event in crowd.events if isinstance(event, Started)]) == 1


def test_a_plan_that_was_on_its_way_does_not_begin_after_the_pause(crowd: Crowd) -> None:
    crowd.say("console", "plan", 2, plan_text="drive back 1 m", mode="replace", pauses=0)
    crowd.live(2.0)
    assert not crowd.is_moving
    assert crowd.end_of(2).outcome == "stopped"
    crowd.say("console", "resume", 1)
    crowd.live(10.0)
    assert crowd.end_of(1).outcome == "completed"


def test_any_sources_stop_drops_it(crowd: Crowd) -> None:
    crowd.say("web", "stop", why="stop")
    crowd.live(0.5)
    assert ended_by(crowd) == "stopped_by"


def test_another_sources_pause_keeps_it(crowd: Crowd) -> None:
    crowd.say("web", "stop", keep=True, why="pause")
    crowd.live(0.5)
    crowd.say("console", "resume", 1)
    crowd.live(10.0)
    assert crowd.end_of(1).outcome == "completed"


def test_another_source_that_drives_drops_it(crowd: Crowd) -> None:
    crowd.say("web", "plan", 7, plan_text="turn left 20 deg", mode="queue")
    crowd.live(3.0)
    assert ended_by(crowd) == "handed_over"
    assert crowd.end_of(7).outcome == "completed"


@pytest.mark.parametrize(("topic", "code"), [("cmd_vel", "other_drove"), ("joystick", "handed_over")])
def test_velocities_of_others_drop_it(crowd: Crowd, topic: str, code: str) -> None:
    other = crowd.rig.hub.connect()
    for _ in range(10):
        other.publish(f"chatrobot/{topic}", TwistMessage(0.0, 0.0, 0.3))
        crowd.live(0.04)
    assert ended_by(crowd) == code


def test_a_lost_source_drops_it(crowd: Crowd) -> None:
    crowd.motion.lose(crowd._senders["console"].lease)
    crowd.live(0.5)
    assert ended_by(crowd) == "source_lost"


def test_a_silent_source_drops_it(crowd: Crowd) -> None:
    del crowd._senders["console"]
    crowd.rig.link.beats = False
    crowd.live(3.0)
    assert ended_by(crowd) == "lease_lapsed"


def test_a_source_that_misses_some_beats_keeps_it(crowd: Crowd) -> None:
    sender = crowd._senders.pop("console")
    crowd.live(1.0)
    crowd._senders["console"] = sender
    crowd.say("console", "resume", 1)
    crowd.live(10.0)
    assert crowd.end_of(1).outcome == "completed"


def test_a_goodbye_drops_it(crowd: Crowd) -> None:
    crowd.say("console", "goodbye")
    crowd.live(0.5)
    assert ended_by(crowd) == "source_left"


def test_a_moved_robot_drops_it(crowd: Crowd) -> None:
    other = crowd.rig.hub.connect()
    for _ in range(20):  # somebody drives past us
        other.publish("cmd_vel", TwistMessage(0.3, 0.0, 0.0))
        crowd.live(0.02)
    other.publish("cmd_vel", TwistMessage(0.0, 0.0, 0.0))
    crowd.live(0.2)
    assert ended_by(crowd) == "pause_robot_moved"


def test_text_of_a_foreigner_is_not_paused_but_stopped(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console", "chatgpt_node")
    crowd.say("chatgpt_node", "plan", 3, plan_text="drive 2 m", mode="queue")
    crowd.live(1.0)
    crowd.say("console", "stop", keep=True, why="pause")
    crowd.live(1.0)
    assert crowd.end_of(3).outcome == "stopped"
    assert not [event for event in crowd.events if isinstance(event, Paused)]
