"""A yes said while the robot drives: to a place it counts, and what it cannot count for is not asked."""

from __future__ import annotations

import pytest
from tests.dialogue.undo_rig import UndoRig, on_its_way_to, said

from chatrobot.core.geometry import Pose


@pytest.fixture
def rig() -> UndoRig:
    """On its way to the kitchen."""
    return on_its_way_to("kitchen")


@pytest.mark.parametrize(
    ("place", "yes"), [("the fridge", "yes"), ("the fridge", "好"), ("der Kühlschrank", "ja")]
)
def test_a_yes_to_a_place_counts_though_the_robot_has_driven_on(rig: UndoRig, place: str, yes: str) -> None:
    asked = said(rig, place)
    assert rig.session.results[asked].proposal is not None
    assert rig.session.is_moving
    said(rig, yes, 30.0)
    assert rig.session.results[1].outcome == "stopped"
    assert rig.pose.distance_to(Pose(4.3, 1.5)) < 0.05


def test_a_no_lets_the_drive_go_on(rig: UndoRig) -> None:
    said(rig, "the fridge")
    said(rig, "no", 30.0)
    assert rig.session.results[1].outcome == "completed"


def test_a_yes_after_the_drive_has_ended_counts_where_it_ended(rig: UndoRig) -> None:
    said(rig, "the fridge", 30.0)
    assert rig.session.results[1].outcome == "completed"
    assert rig.session.results[said(rig, "yes", 30.0)].outcome == "completed"


def test_a_robot_that_was_moved_after_its_drive_asks_again(rig: UndoRig) -> None:
    said(rig, "the fridge", 20.0)
    rig.joystick(0.2, 0.0, 1.0)
    late = rig.session.results[said(rig, "yes")]
    assert late.reason is None
    assert late.outcome == "refused"
    assert not rig.session.is_moving


@pytest.mark.parametrize(
    ("text", "in_full"),
    [
        ("turn lest", "If you mean “turn left 90°”, say so"),
        ("turn left, but wait for my go", "If you mean “turn left 90°”, say so"),
    ],
)
def test_a_plan_from_this_pose_is_left_to_be_said_in_full(rig: UndoRig, text: str, in_full: str) -> None:
    result = rig.session.results[said(rig, text)]
    assert in_full in result.reply
    assert "“go to the kitchen” goes on" in result.reply
    assert result.proposal is None


@pytest.mark.parametrize(("answer", "outcome"), [("yes", "refused"), ("go", "refused"), ("no", "answered")])
def test_what_answers_such_a_plan_all_the_same_is_no_order_and_no_stop(
    rig: UndoRig, answer: str, outcome: str
) -> None:
    said(rig, "turn left, but wait for my go")
    assert rig.session.results[said(rig, answer, 30.0)].outcome == outcome
    assert rig.session.results[1].outcome == "completed"


def test_what_is_said_in_full_is_done(rig: UndoRig) -> None:
    said(rig, "turn lest")
    assert rig.session.results[said(rig, "turn left 90°", 10.0)].outcome == "completed"
