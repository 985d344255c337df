"""What holds at the link, whichever carries it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.link.leaving import abandon
from tests.link.link_rigs import (
    LinkRig,
    ProcessRig,
    SimulatedRig,
    events_until,
    finished,
    moving,
    send_plan,
)

from chatrobot.core.events import Rehearsed


@pytest.fixture(
    params=[
        pytest.param(SimulatedRig, id="simulated"),
        pytest.param(ProcessRig, id="process", marks=pytest.mark.realtime),
    ]
)
def rig(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[LinkRig]:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    make: Callable[[Path], LinkRig] = request.param
    made = make(tmp_path)
    yield made
    made.close()


def is_at_rest(rig: LinkRig) -> bool:
    """The last thing on the wire is a zero; its ear may hear it a moment after the link has told."""
    for _ in range(20):
        rig.link.next_event(0.02)
    return not any(rig.velocities[-1])


def test_a_plan_is_driven_and_measured(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 0.3 m")
    end = finished(rig, 1)
    assert end.outcome == "completed"
    assert end.path_m == pytest.approx(0.3, abs=0.01)
    assert is_at_rest(rig)


def test_plans_queue_and_run_in_order(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 0.2 m")
    send_plan(rig, 2, "drive 0.1 m back")
    assert finished(rig, 1).pose.x_m == pytest.approx(0.2, abs=0.01)
    assert finished(rig, 2).pose.x_m == pytest.approx(0.1, abs=0.01)


def test_stop_ends_what_runs_and_what_waits(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    send_plan(rig, 2, "drive 1 m")
    moving(rig, 1)
    rig.link.send("stop", why="test")
    first = finished(rig, 1)
    assert first.outcome == "stopped"
    assert 0.0 < first.path_m < 1.0
    assert finished(rig, 2).outcome == "stopped"
    assert is_at_rest(rig)


def test_after_a_stop_nothing_needs_releasing(rig: LinkRig) -> None:
    rig.link.send("stop")
    send_plan(rig, 1, "drive 0.1 m")
    assert finished(rig, 1).outcome == "completed"


def test_what_is_said_right_after_a_stop_is_done(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    moving(rig, 1)
    rig.link.send("stop", 1)
    send_plan(rig, 2, "drive 0.1 m")
    assert finished(rig, 1).outcome == "stopped"
    assert finished(rig, 2).outcome == "completed"


def test_an_emergency_stop_holds_until_it_is_released(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    moving(rig, 1)
    rig.link.send("emergency_stop", why="test")
    assert finished(rig, 1).outcome == "stopped"
    send_plan(rig, 2, "drive 0.1 m")
    refused = finished(rig, 2)
    assert refused.outcome == "refused"
    assert refused.reason is not None
    assert refused.reason.code == "emergency_stop"
    rig.link.send("release")
    send_plan(rig, 3, "drive 0.1 m")
    assert finished(rig, 3).outcome == "completed"


def test_a_source_that_stops_beating_loses_its_lease(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    moving(rig, 1)
    rig.link.beats = False
    end = finished(rig, 1)
    assert end.reason is not None
    told = [
        ("stopped", "lease_lapsed"),
        ("failed", "beat_late"),
    ]  # the second where the machine is busy just then
    assert (end.outcome, end.reason.code) in told
    assert is_at_rest(rig)


def test_new_motion_can_replace_the_old_after_a_controlled_stop(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    moving(rig, 1)
    send_plan(rig, 2, "turn left 20 deg", mode="replace")
    old = finished(rig, 1)
    assert old.outcome == "stopped"
    assert old.reason is not None
    assert old.reason.code == "replaced"
    assert finished(rig, 2).outcome == "completed"


def test_a_plan_under_way_goes_on_at_another_speed_on_its_path(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 0.8 m at 0.3 m/s")
    moving(rig, 1)
    rig.link.send("rescale", 2, linear_factor=0.1)  # of no turn that is driven
    rig.link.send("rescale", 1, linear_factor=0.5)
    end = finished(rig, 1)
    assert end.outcome == "completed"
    assert end.path_m == pytest.approx(0.8, abs=0.01)
    assert end.duration_s == pytest.approx(5.0, abs=0.7)


def test_one_turn_that_waits_is_cancelled_or_changed_and_the_others_go_on(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 0.3 m")
    send_plan(rig, 2, "drive 3 m")
    send_plan(rig, 3, "drive 2 m")
    send_plan(rig, 4, "drive 0.1 m back")
    moving(rig, 1)
    rig.link.send("cancel", 2)
    send_plan(rig, 5, "drive 0.2 m", instead_of=3)
    ends = [finished(rig, turn) for turn in (2, 3, 1, 5, 4)]
    outcomes = [(end.outcome, end.reason.code if end.reason is not None else "") for end in ends]
    assert outcomes == [
        ("stopped", "canceled"),
        ("stopped", "order_changed"),
        ("completed", ""),
        ("completed", ""),
        ("completed", ""),
    ]
    assert ends[-1].pose.x_m == pytest.approx(0.4, abs=0.02)


def test_a_turn_that_has_begun_is_stopped_by_a_cancel_and_gives_its_place_to_none(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    moving(rig, 1)
    send_plan(rig, 2, "drive 4 m", instead_of=1)
    late = finished(rig, 2)
    assert (late.outcome, late.reason and late.reason.code) == ("refused", "begun_meanwhile")
    rig.link.send("cancel", 1)
    end = finished(rig, 1)
    assert (end.outcome, end.reason and end.reason.code) == ("stopped", "canceled")
    assert end.path_m < 4.0
    assert is_at_rest(rig)


def test_what_is_driven_goes_on_where_a_plan_that_is_tried_is_refused(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 0.5 m")
    moving(rig, 1)
    send_plan(rig, 2, "drive 0.1 m at 50 m/s", mode="replace", tries=True)
    assert finished(rig, 2).outcome == "refused"
    assert finished(rig, 1).outcome == "completed"


def test_a_plan_that_passes_its_trial_takes_the_place_of_what_is_driven(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    moving(rig, 1)
    send_plan(rig, 2, "drive 0.1 m back", mode="replace", tries=True)
    assert (finished(rig, 1).outcome, finished(rig, 2).outcome) == ("stopped", "completed")


def test_a_full_queue_refuses_rather_than_forgets(rig: LinkRig) -> None:
    send_plan(rig, 1, "wait 1000 s")
    for turn in range(2, 13):
        send_plan(rig, turn, "drive 0.1 m")
    refused = finished(rig, 12)
    assert refused.outcome == "refused"
    assert refused.reason is not None
    assert refused.reason.code == "queue_full"
    rig.link.send("stop")


@pytest.mark.parametrize(
    ("plan_text", "code"), [("fly 1 m", "plan_text"), ("drive 1 m at 50 m/s", "speed_above_limit")]
)
def test_what_cannot_be_done_is_refused_with_its_reason_and_nothing_moves(
    rig: LinkRig, plan_text: str, code: str
) -> None:
    send_plan(rig, 1, plan_text)
    end = finished(rig, 1)
    assert end.outcome == "refused"
    assert end.reason is not None
    assert end.reason.code == code
    assert not any(any(velocity) for velocity in rig.velocities)


def test_a_plan_that_wants_approval_waits_for_it(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 0.1 m", approve=True)
    rehearsed = events_until(rig, lambda event: isinstance(event, Rehearsed))[-1]
    assert isinstance(rehearsed, Rehearsed)
    assert rehearsed.needs_approval
    assert not any(any(velocity) for velocity in rig.velocities)
    rig.link.send("approve", 1, yes=True)
    assert finished(rig, 1).outcome == "completed"


def test_a_no_is_a_refusal(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 0.1 m", approve=True)
    events_until(rig, lambda event: isinstance(event, Rehearsed))
    rig.link.send("approve", 1, yes=False)
    assert finished(rig, 1).outcome == "refused"


def test_a_rehearsal_alone_moves_nothing(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 1 m", rehearse_only=True)
    assert finished(rig, 1).outcome == "completed"
    assert not any(any(velocity) for velocity in rig.velocities)


def test_a_goodbye_lets_what_is_queued_be_done(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 0.2 m")
    send_plan(rig, 2, "drive 0.1 m")
    rig.link.close()
    fastest = max(velocity.vx_mps for velocity in rig.velocities)
    assert fastest > 0.1
    assert is_at_rest(rig)


def test_a_source_that_leaves_without_goodbye_stops_the_robot(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    moving(rig, 1)
    abandon(rig.link)
    assert is_at_rest(rig)


def hold_stick(rig: LinkRig, vx_mps: float, duration_s: float) -> None:
    """The stick is held like that for so long of the robot's time; the link is read meanwhile."""
    for _ in range(round(duration_s / 0.05)):
        rig.link.send("steer", vx_mps=vx_mps)
        ends_s = time.monotonic() + 0.05
        while rig.link.next_event(0.05) is not None and time.monotonic() < ends_s:
            pass


def test_a_stick_drives_and_a_zero_lets_go(rig: LinkRig) -> None:
    events_until(rig, lambda event: event.name == "telemetry")  # the robot is there
    hold_stick(rig, 0.3, 1.0)
    assert max(velocity.vx_mps for velocity in rig.velocities) > 0.1
    rig.link.send("steer")
    while rig.link.next_event(0.3) is not None and any(rig.velocities[-1]):
        pass  # what was told meanwhile
    assert is_at_rest(rig)


def test_a_stick_goes_before_the_plan_of_its_own_source(rig: LinkRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    moving(rig, 1)
    rig.link.send("steer", vx_mps=-0.2)
    ended = finished(rig, 1)
    assert (ended.outcome, ended.reason and ended.reason.code) == ("stopped", "handed_over")


def test_a_plan_that_was_on_its_way_when_stop_was_said_is_not_driven(rig: LinkRig) -> None:
    rig.link.send("stop", 3, why="said after turn 3")
    send_plan(rig, 3, "drive 1 m")
    send_plan(rig, 4, "drive 0.1 m")
    assert finished(rig, 3).outcome == "stopped"
    assert finished(rig, 4).pose.x_m == pytest.approx(0.1, abs=0.01)
