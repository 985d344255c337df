"""A stop that falls between two lines of ours: whatever was just about to begin does not begin."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from chatrobot.core.reason import Reason
from chatrobot.wire.messages import TwistMessage
from tests.safety.test_who_drives import Crowd

STOP = Reason("stopped_by", {"source": "test", "why": ""})


def stop_within(crowd: Crowd, owner: Any, name: str) -> None:
    """Another thread stops, just before `owner.name` is called for the first time."""
    inner: Callable[..., Any] = getattr(owner, name)

    def called(*arguments: Any, **named: Any) -> Any:
        setattr(owner, name, inner)
        crowd.motion.halt(STOP)
        return inner(*arguments, **named)

    setattr(owner, name, called)


def moved(crowd: Crowd) -> bool:
    return any(any(velocity) for velocity in crowd.rig.velocities)


def test_a_stop_that_falls_into_the_launch_of_a_plan_stops_it(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    stop_within(crowd, crowd.motion._governor, "begin")
    crowd.say("console", "plan", 1, plan_text="drive 5 m")
    crowd.live(1.0)
    assert crowd.end_of(1).outcome == "stopped"
    assert not moved(crowd), "not for one tick"


def test_a_stop_that_falls_into_the_yes_stops_what_it_was_said_to(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    crowd.say("console", "plan", 1, plan_text="drive 5 m", approve=True)
    crowd.live(0.2)
    stop_within(crowd, crowd.motion._governor, "begin")
    crowd.say("console", "approve", 1, yes=True)
    crowd.live(1.0)
    assert crowd.end_of(1).outcome == "stopped"
    assert not moved(crowd)


def test_a_stop_that_falls_into_the_start_of_another_programs_velocities_stops_them(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    other = crowd.rig.robot._wire  # type: ignore[attr-defined]
    stop_within(crowd, crowd.motion._governor, "begin")
    for _ in range(10):
        other.publish("chatrobot/cmd_vel", TwistMessage(0.3, 0.0, 0.0))
        crowd.live(0.02)
    assert not moved(crowd), "it has to let go first"


def test_an_emergency_stop_that_comes_after_a_release_holds(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console", "agent")
    crowd.say("agent", "emergency_stop", why="first")
    crowd.live(0.1)
    crowd.say("console", "release")
    crowd.say("agent", "emergency_stop", why="second")
    crowd.live(0.1)
    assert crowd.motion.latched is not None
    crowd.say("console", "plan", 1, plan_text="drive 1 m")
    crowd.live(0.5)
    assert crowd.end_of(1).outcome == "refused"
    assert not moved(crowd)
    crowd.say("console", "release")
    crowd.live(0.1)
    assert crowd.motion.latched is None


def test_a_later_stop_for_an_earlier_turn_takes_nothing_back(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    crowd.say("console", "stop", 5)
    crowd.say("console", "stop", 2)
    crowd.say("console", "plan", 4, plan_text="drive 1 m")
    crowd.live(0.5)
    assert crowd.end_of(4).outcome == "stopped"
    assert not moved(crowd)


@pytest.mark.parametrize("mode", ["queue", "replace", "append"])
def test_a_stop_while_the_wheel_is_handed_over_stops_both(tmp_path: Path, mode: str) -> None:
    crowd = Crowd(tmp_path, "agent", "console")
    crowd.say("agent", "plan", 1, plan_text="drive 5 m")
    crowd.live(1.5)
    crowd.say("console", "plan", 2, plan_text="turn left 90 deg", mode=mode)
    crowd.live(0.1)  # the agent's plan is braking
    crowd.say("console", "stop", 2)
    at = len(crowd.rig.velocities)
    crowd.live(1.5)
    assert (crowd.end_of(1).outcome, crowd.end_of(2).outcome) == ("stopped", "stopped")
    assert not any(any(velocity) for velocity in crowd.rig.velocities[at:])


def test_a_stop_that_coincides_with_the_end_of_a_plan_clears_the_queue(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    crowd.say("console", "plan", 1, plan_text="drive 5 m")
    crowd.say("console", "plan", 2, plan_text="turn left 90 deg")
    crowd.live(1.0)
    crowd.motion.sensors.estimator.fault = Reason("odometry_jumped", {"jump_m": 1.0})
    stop_within(crowd, crowd.motion._stops._transport, "halt")
    crowd.live(4.0)
    assert crowd.end_of(1).outcome == "failed"
    assert crowd.end_of(2).outcome == "stopped"
