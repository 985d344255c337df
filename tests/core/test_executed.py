"""The end of a motion tells what was executed and what remains, as plan text."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.link.link_rigs import SimulatedRig, events_until, finished, moving, send_plan

from chatrobot.core.events import Finished, Progress, Rehearsed, event_from_json
from chatrobot.plan.steps import Drive
from chatrobot.plan.text import parse_plan

THREE = "drive 2 m\nturn left 90 deg\ndrive 1 m"


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[SimulatedRig]:
    made = SimulatedRig(tmp_path)
    yield made
    made.close()


def drive_m(text: str) -> float:
    """The length of a text that is one drive."""
    (step,) = parse_plan(text).steps
    assert isinstance(step, Drive)
    assert step.distance_m is not None
    return step.distance_m


def stopped_while_moving(rig: SimulatedRig, turn: int) -> Finished:
    moving(rig, turn)
    rig.link.send("stop")
    return finished(rig, turn)


def test_a_plan_that_was_completed_is_executed_whole(rig: SimulatedRig) -> None:
    send_plan(rig, 1, THREE)
    end = finished(rig, 1)
    assert (end.executed, end.remaining) == (THREE, "")


def test_a_plan_that_was_stopped_in_its_first_step_is_told_in_two_parts(rig: SimulatedRig) -> None:
    send_plan(rig, 1, THREE)
    end = stopped_while_moving(rig, 1)
    assert drive_m(end.executed) == pytest.approx(end.path_m, abs=0.005)
    first, *others = end.remaining.splitlines()
    assert drive_m(end.executed) + drive_m(first) == pytest.approx(2.0)
    assert others == THREE.splitlines()[1:]
    heard = event_from_json(end.to_json())
    assert isinstance(heard, Finished)
    assert (heard.executed, heard.remaining) == (end.executed, end.remaining)


def test_a_plan_that_another_replaces_tells_how_far_it_came(rig: SimulatedRig) -> None:
    send_plan(rig, 1, THREE)
    moving(rig, 1)
    send_plan(rig, 2, "turn right 10 deg", mode="replace")
    end = finished(rig, 1)
    assert drive_m(end.executed) == pytest.approx(end.path_m, abs=0.005)
    assert len(end.remaining.splitlines()) == 3


def test_a_plan_that_came_in_parts_is_told_as_one(rig: SimulatedRig) -> None:
    send_plan(rig, 1, "drive 2 m", more=True)
    send_plan(rig, 1, "turn left 90 deg", mode="extend", more=True)
    end = stopped_while_moving(rig, 1)
    assert drive_m(end.executed) == pytest.approx(end.path_m, abs=0.005)
    assert end.remaining.splitlines()[1:] == ["turn left 90 deg"]


def test_a_plan_that_was_stopped_before_it_moved_remains_whole(rig: SimulatedRig) -> None:
    send_plan(rig, 1, THREE, approve=True)
    send_plan(rig, 2, "drive 1 m", more=True)
    send_plan(rig, 2, "drive 0.5 m", mode="extend")
    events_until(rig, lambda event: isinstance(event, Rehearsed))
    rig.link.send("stop")
    end = finished(rig, 1)
    assert (end.outcome, end.executed, end.remaining) == ("stopped", "", THREE)
    assert finished(rig, 2).remaining == "drive 1 m\ndrive 0.5 m"


def test_a_plan_that_was_refused_or_only_rehearsed_leaves_nothing(rig: SimulatedRig) -> None:
    send_plan(rig, 1, "drive 2000 m")
    send_plan(rig, 2, THREE, rehearse_only=True)
    for end in (finished(rig, 1), finished(rig, 2)):
        assert (end.executed, end.remaining) == ("", "")


def test_two_runs_of_a_turn_are_one_plan(rig: SimulatedRig) -> None:
    send_plan(rig, 1, "drive 0.2 m")
    first = finished(rig, 1)
    send_plan(rig, 2, THREE)
    events_until(rig, lambda event: isinstance(event, Progress) and event.turn == 2 and event.pose.x_m > 0.25)
    both = first.followed_by(stopped_while_moving(rig, 2))
    assert both.executed.startswith("drive 0.2 m\ndrive ")
    assert len(both.remaining.splitlines()) == 3
