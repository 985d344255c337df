"""Who waits, who was asked, who has left: what is decided before anything moves."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.wire.messages import TwistMessage
from tests.motion.far_robot import Rig
from tests.safety.test_who_drives import Crowd


def standing_after_a_stop(folder: Path, *sources: str) -> Crowd:
    """A crowd whose robot is still being seen to stand: whatever is said now waits."""
    crowd = Crowd(folder, *sources)
    crowd.say("console", "plan", 1, plan_text="drive 5 m")
    crowd.live(1.0)
    crowd.say("console", "stop", 1)
    crowd.live(0.04)
    return crowd


def test_a_persons_plan_goes_before_an_agents_that_waits(tmp_path: Path) -> None:
    crowd = standing_after_a_stop(tmp_path, "agent", "console")
    crowd.say("agent", "plan", 2, plan_text="turn left 90 deg")
    crowd.live(0.02)
    crowd.say("console", "plan", 3, plan_text="drive 0.2 m back")
    crowd.live(4.0)
    assert crowd.end_of(3).outcome == "completed"
    ended = crowd.end_of(2)
    assert (ended.outcome, ended.reason and ended.reason.code) == ("stopped", "handed_over")
    assert "handed_over" in crowd.notices()


@pytest.mark.parametrize("mode", ["queue", "append", "replace"])
def test_an_agent_takes_no_persons_plan_from_the_queue(tmp_path: Path, mode: str) -> None:
    crowd = standing_after_a_stop(tmp_path, "agent", "console")
    crowd.say("console", "plan", 2, plan_text="drive 0.2 m back")
    crowd.live(0.02)
    crowd.say("agent", "plan", 3, plan_text="turn left 90 deg", mode=mode)
    crowd.live(4.0)
    assert crowd.end_of(2).outcome == "completed"
    ended = crowd.end_of(3)
    assert (ended.outcome, ended.reason and ended.reason.code) == ("refused", "outranked")


def test_a_yes_of_one_person_is_no_yes_to_anothers_plan_of_the_same_number(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console", "web")
    crowd.say("console", "plan", 1, plan_text="drive 0.3 m", approve=True)
    crowd.live(0.2)
    crowd.say("web", "plan", 1, plan_text="drive 0.1 m back", approve=True)
    crowd.live(0.1)
    crowd.say("web", "approve", 1, yes=True)
    crowd.live(1.0)
    assert not crowd.is_moving
    crowd.say("console", "approve", 1, yes=True)
    crowd.live(1.0)
    assert crowd.is_moving


def test_a_person_may_say_no_and_yes_to_an_agents_plan(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console", "agent")
    crowd.say("agent", "plan", 1, plan_text="drive 0.1 m", approve=True)
    crowd.say("agent", "plan", 2, plan_text="drive 0.1 m", approve=True)
    crowd.live(0.2)
    crowd.say("console", "approve", 1, yes=False)
    crowd.live(0.2)
    crowd.say("console", "approve", 2, yes=True)
    crowd.live(2.0)
    assert [crowd.end_of(turn).outcome for turn in (1, 2)] == ["refused", "completed"]


def test_who_has_said_goodbye_drives_no_more(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console", "web")
    crowd.say("web", "plan", 1, plan_text="drive 0.1 m")
    crowd.say("web", "goodbye")
    crowd.live(2.0)
    assert crowd.end_of(1).outcome == "completed", "what was said before it is still done"
    for word in ("beat", "hello"):
        crowd.say("web", word)
        crowd.say("web", "plan", 2, plan_text="drive 5 m")
        crowd.live(0.5)
        assert not crowd.is_moving, "nobody would notice that its source is gone"
    ended = [event for event in crowd.events if event.name == "finished" and event.turn == 2]
    assert [event.outcome for event in ended] == ["refused", "refused"]  # type: ignore[attr-defined]


def test_a_yes_is_worth_nothing_once_the_robot_was_turned() -> None:
    rig = Rig()
    rig.turn = 1
    rig.link.send("plan", 1, plan_text="drive 1 m", approve=True)
    rig.pass_time(0.2)
    somebody = rig.hub.connect()
    somebody.publish("cmd_vel", TwistMessage(0.0, 0.0, 0.5))
    rig.pass_time(0.4)
    somebody.publish("cmd_vel", TwistMessage(0.0, 0.0, 0.0))
    rig.pass_time(0.5)
    rig.link.send("approve", 1, yes=True)
    rig.pass_time(1.0)
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.reason and end.reason.code) == ("refused", "approval_robot_moved")
    assert rig.robot.true_pose.x_m == pytest.approx(0.0, abs=0.01)
