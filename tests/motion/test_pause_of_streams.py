"""A pause while a plan still comes in: the rest and the later parts are driven at resume, nothing twice."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.dialogue.scripted_model import ModelTalk
from tests.link.link_rigs import SimulatedRig, events_until, finished, send_plan
from tests.motion.test_stream import wait_s

from chatrobot.core.events import Event, Finished, Paused, Progress, Rehearsed, Started, TruePose

ASKED = "please do something nice"


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[SimulatedRig]:
    """A metre of a plan that still comes in is driven, and was paused half way."""
    rig = SimulatedRig(tmp_path)
    send_plan(rig, 1, "drive 1 m", "queue", more=True)
    events_until(rig, lambda event: isinstance(event, Progress) and event.pose.x_m > 0.4)
    rig.link.send("stop", why="pause", keep=True)
    yield rig
    rig.close()


def is_paused(event: Event) -> bool:
    return isinstance(event, Paused)


def end_of_the_l_shape(rig: SimulatedRig) -> Finished:
    """A metre, a turn and half a metre: each of them once."""
    end = finished(rig, 1)
    assert end.outcome == "completed"
    assert end.path_m == pytest.approx(1.5, abs=0.02)
    assert end.turned_rad == pytest.approx(math.pi / 2, abs=0.02)
    assert (end.pose.x_m, end.pose.y_m) == pytest.approx((1.0, 0.5), abs=0.02)
    assert end.planned_m == pytest.approx(1.5, abs=0.01)
    return end


def test_parts_that_come_while_it_is_paused_follow_the_rest(rig: SimulatedRig) -> None:
    events_until(rig, is_paused)
    send_plan(rig, 1, "turn left 90 deg", "extend", more=True)
    send_plan(rig, 1, "drive 0.5 m", "extend", more=False)
    rig.velocities.clear()
    wait_s(rig, 5.0)
    assert not any(any(velocity) for velocity in rig.velocities)
    rig.link.send("resume", 1)
    assert end_of_the_l_shape(rig).paused_s >= 5.0


def test_parts_that_come_before_the_robot_stands_follow_the_rest(rig: SimulatedRig) -> None:
    send_plan(rig, 1, "turn left 90 deg", "extend", more=True)
    send_plan(rig, 1, "drive 0.5 m", "extend", more=False)
    events_until(rig, is_paused)
    rig.link.send("resume", 1)
    end_of_the_l_shape(rig)


def test_parts_that_come_after_it_was_gone_on_with_follow_the_rest(rig: SimulatedRig) -> None:
    events_until(rig, is_paused)
    rig.link.send("resume", 1)
    events_until(rig, lambda event: isinstance(event, Started))
    send_plan(rig, 1, "turn left 90 deg", "extend", more=True)
    wait_s(rig, 8.0)
    assert not any(rig.velocities[-1]), "it waits for the next part"
    send_plan(rig, 1, "drive 0.5 m", "extend", more=False)
    end_of_the_l_shape(rig)


def test_the_rest_is_rehearsed_before_a_later_part(rig: SimulatedRig) -> None:
    paused = next(event for event in events_until(rig, is_paused) if isinstance(event, Paused))
    send_plan(rig, 1, "turn left 90 deg", "extend", more=False)
    rig.link.send("resume", 1)
    events = events_until(rig, lambda event: isinstance(event, Finished))
    ends = [event.end for event in events if isinstance(event, Rehearsed)]
    assert paused.plan_text.startswith("drive 0.")
    assert [end.x_m for end in ends] == pytest.approx([1.0, 1.0], abs=0.01)
    assert [end.yaw_rad for end in ends] == pytest.approx([0.0, math.pi / 2], abs=0.01)


def test_where_nothing_is_left_and_the_next_part_has_not_come_a_pause_is_a_stop(rig: SimulatedRig) -> None:
    events_until(rig, is_paused)
    rig.link.send("resume", 1)
    wait_s(rig, 8.0)
    rig.link.send("stop", why="pause", keep=True)
    end = finished(rig, 1)
    assert (end.outcome, end.remaining) == ("stopped", "")
    assert end.path_m == pytest.approx(1.0, abs=0.01)
    send_plan(rig, 1, "drive 0.5 m", "extend", more=False)
    rig.velocities.clear()
    rig.link.send("resume", 1)
    wait_s(rig, 3.0)
    assert not any(any(velocity) for velocity in rig.velocities)


def test_a_stop_drops_what_came_while_it_was_paused(rig: SimulatedRig) -> None:
    events_until(rig, is_paused)
    send_plan(rig, 1, "turn left 90 deg", "extend", more=False)
    rig.link.send("stop", why="stop")
    assert finished(rig, 1).outcome == "stopped"
    rig.velocities.clear()
    rig.link.send("resume", 1)
    wait_s(rig, 3.0)
    assert not any(any(velocity) for velocity in rig.velocities)


@pytest.mark.parametrize("comes", ["before the pause", "while it is paused", "after it is gone on with"])
def test_a_model_that_streams_its_plan_is_driven_to_its_end(comes: str) -> None:
    late = threading.Event()
    talk = ModelTalk(["drive 1 m\n", late, "turn left 90 deg\ndrive 0.5 m\n"])
    talk.session._link.is_simulated = False  # time does not stand while this model thinks
    turn = talk.session.say(ASKED)
    talk.pump_until(lambda: any(isinstance(event, TruePose) and event.x_m > 0.3 for event in talk.events))

    def say_the_rest() -> None:
        late.set()
        talk.pump_until(lambda: len(talk.of("streamed")) == 3 and not talk.session._llm.is_calling)

    if comes == "before the pause":
        say_the_rest()
    talk.session.say("pause")
    talk.pump_until(lambda: talk.session.is_paused)
    if comes == "while it is paused":
        say_the_rest()
    stood = len(talk.events)
    for _ in range(100):
        talk.session.pump(0.02)
    assert not any(isinstance(event, TruePose) and event.vx_mps for event in talk.events[stood:])
    assert turn not in talk.session.results
    talk.session.say("continue")
    talk.pump_until(lambda: len(talk.of("started")) == 2)
    late.set()
    talk.pump_until(lambda: turn in talk.session.results)
    result = talk.session.results[turn]
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(1.5, abs=0.02)
    assert result.turned_rad == pytest.approx(math.pi / 2, abs=0.02)
    assert (result.pose.x_m, result.pose.y_m) == pytest.approx((1.0, 0.5), abs=0.02)
    assert result.paused_s >= 2.0
    assert len(talk.model.asked) == 1, "it is not asked again about what it had said"
