"""A plan that comes in parts: driven as one, up to the last part that was accepted."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.link.link_rigs import (
    LinkRig,
    ProcessRig,
    SimulatedRig,
    events_until,
    finished,
    send_plan,
)

from chatrobot.core.events import Event, Finished, Looked, Progress, Rehearsed

SQUARE = ("drive 0.4 m", "turn left 90 deg") * 2


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[SimulatedRig]:
    made = SimulatedRig(tmp_path)
    yield made
    made.close()


def stream(rig: LinkRig, turn: int, *parts: str, close: bool = True) -> None:
    """Send `parts` at once; the last one closes."""
    modes = itertools.chain(["queue"], itertools.repeat("extend"))
    for number, (part, mode) in enumerate(zip(parts, modes), 1):
        send_plan(rig, turn, part, mode, more=not close or number < len(parts))


def longest_rest_s(rig: LinkRig) -> float:
    """The longest run of zeros between two motions, at 50 Hz."""
    moves = [any(velocity) for velocity in rig.velocities]
    within = moves[moves.index(True) : len(moves) - moves[::-1].index(True)]
    return (
        max((len(list(group)) for moving, group in itertools.groupby(within) if not moving), default=0) / 50
    )


def test_parts_are_driven_as_one_plan(rig: SimulatedRig) -> None:
    stream(rig, 1, *SQUARE)
    end = finished(rig, 1)
    assert end.outcome == "completed"
    assert (end.steps_done, end.steps) == (4, 4)
    assert end.pose.x_m == pytest.approx(0.4, abs=0.02)
    assert end.pose.y_m == pytest.approx(0.4, abs=0.02)
    whole = SimulatedRig(Path())
    send_plan(whole, 1, "\n".join(SQUARE))
    same = finished(whole, 1)
    assert end.pose.distance_to(same.pose) < 0.002
    assert end.duration_s == pytest.approx(same.duration_s, abs=0.05)
    assert longest_rest_s(rig) <= longest_rest_s(whole) + 0.02


def test_the_robot_moves_before_the_next_part_is_there(rig: SimulatedRig) -> None:
    stream(rig, 1, "drive 0.2 m", close=False)
    events_until(rig, lambda event: isinstance(event, Progress) and event.pose.x_m > 0.05)
    send_plan(rig, 1, "turn left 90 deg", "extend", more=False)
    end = finished(rig, 1)
    assert end.outcome == "completed"
    assert end.turned_rad == pytest.approx(math.pi / 2, abs=0.02)
    assert longest_rest_s(rig) <= 0.06


def test_a_robot_that_waits_for_the_next_part_stands_and_then_goes_on(rig: SimulatedRig) -> None:
    stream(rig, 1, "drive 0.2 m", close=False)
    assert not any(isinstance(event, Finished) for event in wait_s(rig, 5.0))
    assert not any(rig.velocities[-1])
    send_plan(rig, 1, "drive 0.2 m", "extend", more=True)
    send_plan(rig, 1, "", "extend", more=False)
    end = finished(rig, 1)
    assert end.outcome == "completed"
    assert end.path_m == pytest.approx(0.4, abs=0.01)


def test_a_part_begins_where_the_one_before_it_is_predicted_to_end(rig: SimulatedRig) -> None:
    stream(rig, 1, "drive 1 m", "turn left 180 deg", "drive 1 m", "go to 1 0 from start", close=True)
    seen = events_until(rig, lambda event: isinstance(event, Finished))
    ends = [event.end for event in seen if isinstance(event, Rehearsed)]
    assert [round(pose.x_m, 2) for pose in ends] == [1.0, 1.0, 0.0, 1.0]
    assert seen[-1].pose.x_m == pytest.approx(1.0, abs=0.02)  # type: ignore[attr-defined]


def test_a_refused_part_ends_the_run_at_the_last_accepted_one(rig: SimulatedRig) -> None:
    stream(rig, 1, "drive 0.3 m", "drive 1 m at 50 m/s", "turn left 90 deg")
    seen = events_until(rig, lambda event: isinstance(event, Finished))
    end = seen[-1]
    assert isinstance(end, Finished)
    assert end.outcome == "refused"
    assert end.reason is not None
    assert end.reason.code == "speed_above_limit"
    assert end.path_m == pytest.approx(0.3, abs=0.01)
    assert abs(end.turned_rad) < 0.02
    refused = next(event for event in seen if isinstance(event, Rehearsed) and not event.ok)
    assert refused.findings[0].step == (2,)


def test_a_refused_first_part_moves_nothing(rig: SimulatedRig) -> None:
    stream(rig, 1, "drive 1 m at 50 m/s", "drive 0.3 m")
    assert finished(rig, 1).outcome == "refused"
    wait_s(rig, 2.0)
    assert not any(any(velocity) for velocity in rig.velocities)


def test_a_stop_ends_the_stream_and_later_parts_are_worth_nothing(rig: SimulatedRig) -> None:
    stream(rig, 1, "drive 2 m", close=False)
    events_until(rig, lambda event: isinstance(event, Progress) and event.pose.x_m > 0.1)
    rig.link.send("stop", 1, why="stop")
    send_plan(rig, 1, "drive 2 m", "extend", more=True)
    assert finished(rig, 1).outcome == "stopped"
    send_plan(rig, 1, "drive 2 m", "extend", more=False)
    rig.velocities.clear()
    assert not any(isinstance(event, Finished) for event in wait_s(rig, 3.0))
    assert not any(any(velocity) for velocity in rig.velocities)


def test_a_stop_while_it_waits_for_the_next_part_ends_it(rig: SimulatedRig) -> None:
    stream(rig, 1, "drive 0.2 m", close=False)
    wait_s(rig, 4.0)
    rig.link.send("stop", 1, why="stop")
    assert finished(rig, 1).outcome == "stopped"


def test_parts_come_while_the_run_before_is_being_replaced(rig: SimulatedRig) -> None:
    send_plan(rig, 1, "drive 3 m")
    events_until(rig, lambda event: isinstance(event, Progress) and event.pose.x_m > 0.1)
    send_plan(rig, 2, "turn left 90 deg", "replace", more=True)
    send_plan(rig, 2, "drive 0.2 m", "extend", more=True)
    assert finished(rig, 1).outcome == "stopped"
    send_plan(rig, 2, "turn right 90 deg", "extend", more=False)
    end = finished(rig, 2)
    assert (end.outcome, end.steps_done) == ("completed", 3)
    assert end.path_m == pytest.approx(0.2, abs=0.02)


def test_what_is_to_be_approved_comes_whole(rig: SimulatedRig) -> None:
    send_plan(rig, 1, "drive 0.3 m", "queue", more=True, approve=True)
    events_until(rig, lambda event: isinstance(event, Rehearsed) and event.needs_approval)
    send_plan(rig, 1, "drive 5 m", "extend", more=False)
    rig.link.send("approve", 1, yes=True)
    assert finished(rig, 1).path_m == pytest.approx(0.3, abs=0.01)


def test_who_asks_hears_what_the_lidar_sees(rig: SimulatedRig) -> None:
    rig.link.send("look", 3)
    looked = events_until(rig, lambda event: isinstance(event, Looked))[-1]
    assert (looked.turn, looked.sectors_m) == (3, (None,) * 8)  # type: ignore[attr-defined]


def test_an_endless_stream_is_refused(rig: SimulatedRig) -> None:
    stream(rig, 1, *["wait 0.01 s"] * 1002, close=False)
    end = finished(rig, 1)
    assert end.outcome == "refused"
    assert end.reason is not None
    assert end.reason.code == "plan_too_large"


@pytest.mark.realtime
def test_a_stream_runs_in_motions_own_process_too(tmp_path: Path) -> None:
    rig = ProcessRig(tmp_path)
    try:
        stream(rig, 1, "drive 0.2 m", "drive 0.2 m", "drive 1 m at 50 m/s")
        end = finished(rig, 1)
        assert end.outcome == "refused"
        assert end.path_m == pytest.approx(0.4, abs=0.03)
    finally:
        rig.close()


def wait_s(rig: LinkRig, duration_s: float) -> list[Event]:
    """Let time pass; what was told meanwhile."""
    events = [rig.link.next_event(0.1) for _ in range(round(duration_s * 50))]
    return [event for event in events if event is not None]
