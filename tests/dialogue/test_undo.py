"""Undo returns to the measured pose before the turn, redo to the one after it; where nobody can, it says why."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from scripts.undos import PLANS, Talk
from tests.dialogue.undo_rig import UndoRig

from chatrobot.core.events import Interpreted, Rehearsed
from chatrobot.core.geometry import Pose
from chatrobot.dialogue.options import Options
from chatrobot.robots.load import load_profile
from chatrobot.robots.open_loop import driven_open_loop

HOME = Pose()


@pytest.fixture
def rig() -> UndoRig:
    return UndoRig()


# --- back by what was executed ---


def test_a_drive_that_was_stopped_is_undone_by_as_much_as_was_driven(rig: UndoRig) -> None:
    rig.stopped_after("forward 2 m", 1.22)
    drove_m = rig.x_m
    undo = rig.do("undo")
    assert undo.path_m == pytest.approx(drove_m, abs=0.01)
    assert rig.is_at(HOME, 0.005)
    assert rig.plan_of(undo).startswith("drive 1.2")


def test_of_three_steps_that_were_stopped_in_the_first_only_that_one_is_undone(rig: UndoRig) -> None:
    rig.stopped_after("forward 2 m, turn left 90 degrees, forward 1 m", 0.8)
    undo = rig.do("undo")
    assert len(rig.plan_of(undo).splitlines()) == 1
    assert rig.is_at(HOME, 0.005)


def test_a_repeat_that_was_stopped_in_its_third_round_is_undone_round_by_round(rig: UndoRig) -> None:
    rig.do("forward 1 m")
    began = rig.pose
    turn = rig.session.say_plan("repeat 4\n  drive 0.5 m\n  turn left 90 deg\nend")
    rig._pump_until(lambda: math.degrees(rig.pose.yaw_rad) > 230.0)
    rig.session.say("stop")
    rig._pump_until(lambda: turn in rig.session.results)
    rig.live(0.5)
    undo = rig.do("undo")
    assert rig.plan_of(undo).splitlines()[-4:] == [
        "repeat 2",
        "  turn right 90 deg",
        "  drive 0.5 m back",
        "end",
    ]
    assert rig.is_at(began)


def test_what_ended_at_an_obstacle_is_undone_by_the_distance_to_it() -> None:
    rig = UndoRig(world="home")
    rig.do("drive forward until an obstacle is within 80 cm")
    assert rig.x_m > 0.3
    undo = rig.do("undo")
    assert "until" not in rig.plan_of(undo)
    assert rig.is_at(HOME)


def test_undo_undo_redo_redo_walk_the_ledger(rig: UndoRig) -> None:
    rig.stopped_after("forward 2 m", 0.6)
    first = rig.pose
    rig.do("turn left 90 degrees")
    second = rig.pose
    rig.do("where are you?")
    for said, pose in (("undo", first), ("undo", HOME), ("redo", first), ("redo", second), ("undo", first)):
        assert rig.do(said).outcome == "completed"
        assert rig.is_at(pose), said


@pytest.mark.parametrize(("undo", "redo"), [("undo", "redo"), ("撤销", "重做"), ("撤销", "恢复")])
def test_redo_after_an_undo_does_again_what_was_executed(rig: UndoRig, undo: str, redo: str) -> None:
    rig.stopped_after("forward 2 m", 0.7)
    stopped = rig.pose
    rig.do(undo)
    rig.do(redo)
    assert rig.is_at(stopped)


@pytest.mark.parametrize(("redo", "reply"), [("redo", "nothing to redo"), ("重做", "没有可以重做")])
def test_redo_without_an_undo_before_says_that_there_is_none_and_again_repeats(
    rig: UndoRig, redo: str, reply: str
) -> None:
    rig.do("forward 0.5 m")
    assert reply in rig.do(redo).reply
    assert rig.x_m == pytest.approx(0.5, abs=0.01)
    rig.do("undo")
    rig.do(redo)
    assert reply in rig.do(redo).reply
    rig.do("again")
    assert rig.x_m == pytest.approx(1.0, abs=0.01)
    rig.do("undo")
    rig.do("turn left 90 degrees")
    assert reply in rig.do(redo).reply
    assert math.degrees(rig.pose.yaw_rad) == pytest.approx(90.0, abs=1.0)


def test_everything_is_undone_and_done_again_at_once(rig: UndoRig) -> None:
    rig.do("forward 0.5 m")
    rig.do("turn left 90 degrees")
    rig.stopped_after("forward 2 m", 0.4)
    end = rig.pose
    rig.do("undo everything")
    assert rig.is_at(HOME)
    rig.do("redo")
    assert rig.is_at(end)


# --- back by `go to` ---


def test_going_to_a_place_is_undone_by_going_back_and_the_heading_is_restored() -> None:
    rig = UndoRig(world="home")
    rig.do("turn left 30 degrees")
    began = rig.pose
    rig.do("go to the kitchen")
    kitchen = rig.pose
    assert not rig.is_at(began, 1.0)
    undo = rig.do("undo")
    assert rig.plan_of(undo).startswith("go to 0 0 facing 30")
    assert rig.is_at(began)
    rig.do("redo")
    assert rig.is_at(kitchen)


def test_a_way_to_a_place_that_was_stopped_is_undone() -> None:
    rig = UndoRig(world="home")
    rig.stopped_after("go to the kitchen", 1.5, 400.0)
    rig.do("undo")
    assert rig.is_at(HOME)


# --- an undo that was stopped itself ---


@pytest.mark.parametrize("first", ["forward 2 m", "forward 1 m, turn left 90 degrees, forward 1 m"])
def test_an_undo_that_was_stopped_goes_on_or_back(rig: UndoRig, first: str) -> None:
    rig.do("forward 0.3 m")
    began = rig.pose
    rig.do(first)
    end = rig.pose
    rig.stopped_after("undo", 0.5)
    assert not rig.is_at(began, 0.2)
    rig.do("undo")
    assert rig.is_at(began)
    rig.do("redo")
    assert rig.is_at(end)
    rig.stopped_after("undo", 0.5)
    rig.do("redo")
    assert rig.is_at(end)
    rig.do("undo")
    rig.stopped_after("redo", 0.5)
    rig.do("undo")
    assert rig.is_at(began)
    rig.do("undo")
    assert rig.is_at(HOME)


def test_a_turn_after_an_undo_that_was_stopped_is_undone_first(rig: UndoRig) -> None:
    rig.do("forward 2 m")
    rig.stopped_after("undo", 0.5)
    between = rig.pose
    rig.do("turn left 90 degrees")
    rig.do("undo")
    assert rig.is_at(between)
    rig.do("undo")
    assert rig.is_at(HOME)


# --- what nobody can undo ---


def said_why(rig: UndoRig, word: str) -> bool:
    result = rig.do("undo")
    assert rig.plan_of(result) == ""
    return result.outcome == "refused" and word in result.reply


def test_after_a_joystick_nothing_before_is_undone_and_what_comes_after_is(rig: UndoRig) -> None:
    rig.do("forward 0.5 m")
    rig.joystick(0.3, 0.0, 1.0)
    assert said_why(rig, "moved me")
    there = rig.pose
    rig.do("turn left 90 degrees")
    rig.do("undo")
    assert rig.is_at(there)
    assert said_why(rig, "moved me")


def test_a_joystick_that_took_over_and_came_back_counts(rig: UndoRig) -> None:
    rig.do("forward 0.5 m")
    rig.joystick(0.3, 0.0, 1.0)
    rig.joystick(-0.3, 0.0, 1.0)
    assert rig.is_at(Pose(0.5), 0.05)
    assert said_why(rig, "moved me")


def test_after_another_source_drove_there_and_back_nothing_is_undone(rig: UndoRig) -> None:
    rig.do("forward 0.5 m")
    rig.another_source("drive 0.5 m\ndrive 0.5 m back")
    assert rig.is_at(Pose(0.5))
    assert said_why(rig, "moved me")


def test_what_a_joystick_took_over_is_not_undone(rig: UndoRig) -> None:
    turn = rig.session.say("forward 5 m")
    rig.live(2.0)
    rig.joystick(0.0, 0.3, 0.1)
    assert rig.session.results[turn].outcome == "stopped"
    assert said_why(rig, "moved me")


def test_after_odometry_began_anew_nothing_is_undone(rig: UndoRig) -> None:
    rig.do("forward 1 m")
    rig.restart_odometry()
    assert said_why(rig, "odometry began anew")


def test_without_odometry_nothing_is_undone() -> None:
    profile = load_profile("wheeltec_mini_mec")
    rig = UndoRig(profile=driven_open_loop(replace(profile, wiring=replace(profile.wiring, odom_topic=""))))
    rig.do("forward 0.5 m")
    assert said_why(rig, "no odometry")


def test_a_robot_that_only_stood_has_nothing_to_undo(rig: UndoRig) -> None:
    for said in ("undo", "wait 1 s", "undo"):
        result = rig.do(said)
    assert result.outcome == "unclear"
    assert "nothing that I could undo" in result.reply


# --- like any plan ---


def test_an_undo_is_rehearsed_and_asked_about_like_any_plan() -> None:
    rig = UndoRig(options=Options(approve=True))
    for said in ("forward 1 m", "undo"):
        turn = rig.session.say(said)
        rig.live(0.2)
        rehearsed = [event for event in rig.events if isinstance(event, Rehearsed)][-1]
        assert rehearsed.turn == turn
        assert rehearsed.needs_approval
        rig.session.approve(turn, True)
        rig._pump_until(lambda turn=turn: turn in rig.session.results)  # type: ignore[misc]
    assert rig.is_at(HOME)


def test_an_undo_that_is_not_approved_leaves_the_ledger_as_it_was() -> None:
    rig = UndoRig()
    rig.do("forward 1 m")
    rig.session.options = Options(approve=True)
    turn = rig.session.say("undo")
    rig.live(0.2)
    rig.session.approve(turn, False)
    rig._pump_until(lambda: turn in rig.session.results)
    rig.session.options = Options()
    rig.do("undo")
    assert rig.is_at(HOME)


def test_an_undo_said_while_it_moves_stops_it_and_takes_back_what_it_did() -> None:
    rig = UndoRig(options=Options(while_moving="replace"))
    rig.do("forward 0.5 m")
    before = rig.pose
    moving = rig.session.say("forward 3 m")
    rig.live(2.0)
    undo = rig.do("undo")
    assert rig.session.results[moving].outcome == "stopped"
    assert undo.outcome == "completed"
    assert rig.is_at(before)


def test_a_correction_said_while_it_moves_is_about_that_motion() -> None:
    rig = UndoRig(options=Options(while_moving="replace"))
    rig.session.say("turn left 180 degrees")
    rig.live(1.0)
    rig.do("no, I meant right 90 degrees")
    assert math.degrees(rig.pose.yaw_rad) == pytest.approx(-90.0, abs=1.0)


def test_a_turn_that_was_stopped_is_corrected_from_where_it_stands(rig: UndoRig) -> None:
    rig.stopped_after("forward 2 m", 0.8)
    rig.do("no, I meant back 50 cm")
    assert rig.is_at(Pose(-0.5))
    rig.do("undo")
    assert 0.8 < rig.x_m < 0.9


def test_no_plan_is_sent_for_what_cannot_be_undone(rig: UndoRig) -> None:
    rig.do("undo")
    assert [event.plan_text for event in rig.events if isinstance(event, Interpreted)] == [""]


# --- how exactly ---


@pytest.mark.parametrize("plan_text", PLANS[::3])
def test_a_stopped_plan_is_undone_to_two_centimetres_and_a_degree(plan_text: str) -> None:
    """A sample of `scripts/undos.py`."""
    talk = Talk()
    talk.stand()
    for share in (0.3, 0.77):
        undone = talk.undo_after(plan_text, share)
        assert undone is not None
        assert undone.outcome == "completed"
        assert not undone.true.is_far
