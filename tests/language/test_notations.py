"""Speeds, arcs, bearings, totals and repeats in the many ways they are written."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, Dialogue, Place
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.plan.steps import Arc, Drive, ObstacleWithin, Plan, RawTwist, Step, Turn, Wait
from tests.language.dialogue_runner import Conversation
from tests.language.profiles import MECANUM


def steps(text: str, *more: str) -> tuple[Step, ...]:
    talk = Conversation()
    meant = talk.say(text)
    for turn in more:
        meant = talk.say(turn)
    assert meant.plan is not None, (text, *more, meant.reply)
    return meant.plan.steps


SPEEDS = {
    "0.5 m/s": 0.5, "50 cm/s": 0.5, "half a metre per second": 0.5, "1.8 km/h": 0.5, "30 m/min": 0.5,
    "a metre every two seconds": 0.5, "5 cm every second": 0.05, "a foot per second": 0.3048,
    "half your maximum speed": 0.5, "sixty percent of top speed": 0.6, "twice your normal speed": 0.6,
    "half your usual speed": 0.15,
}  # fmt: skip


@pytest.mark.parametrize(("said", "mps"), SPEEDS.items())
@pytest.mark.parametrize("frame", ["go forward 2 m at {}", "at {}, two metres ahead"])
def test_a_speed_in_any_notation(frame: str, said: str, mps: float) -> None:
    (step,) = steps(frame.format(said))
    assert isinstance(step, Drive)
    assert step.speed_mps == pytest.approx(mps)
    assert step.distance_m == pytest.approx(2.0)


ARCS = {
    "drive 1.2 m along a curve to the right that has a 1.5 m radius": Arc(1.5, 0.8, left=False),
    "arc left, r = 60 cm, 120 deg": Arc(0.6, 2 * math.pi / 3, left=True),
    "curve left with a diameter of 1 m for 90 degrees": Arc(0.5, math.pi / 2, left=True),
    "three quarters of a circle to the left, radius 50 cm": Arc(0.5, 1.5 * math.pi, left=True),
}


@pytest.mark.parametrize(("said", "arc"), ARCS.items())
def test_an_arc_by_any_two_of_its_measures(said: str, arc: Arc) -> None:
    (step,) = steps(said)
    assert isinstance(step, Arc)
    assert (step.radius_m, step.angle_rad, step.left) == pytest.approx(
        (arc.radius_m, arc.angle_rad, arc.left)
    )


@pytest.mark.parametrize(("side", "sign"), [("left", 1), ("right", -1)])
def test_a_bearing_slides_to_its_side(side: str, sign: int) -> None:
    (step,) = steps(f"slide 1 metre in the direction 30 degrees to the {side} of your nose, without turning")
    assert isinstance(step, Drive)
    assert step.direction_rad == pytest.approx(sign * math.pi / 6)


def test_a_speed_relative_to_the_one_before() -> None:
    first, second = steps("one metre at 0.2 m/s, then one metre more twice as fast, both ahead")
    assert isinstance(first, Drive)
    assert isinstance(second, Drive)
    assert (first.speed_mps, second.speed_mps) == (0.2, 0.4)


def test_a_pause_halfway_parts_the_motion() -> None:
    assert steps("forward 2 m, but halfway there stop for four seconds") == (
        Drive(1.0),
        Wait(4.0),
        Drive(1.0),
    )


def test_round_trips_may_have_their_measure_said_last() -> None:
    done = steps("go to and fro three times, half a metre each way")
    assert [round(s.direction_rad, 6) for s in done if isinstance(s, Drive)] == [0.0, round(math.pi, 6)] * 3


def test_the_same_way_goes_on_and_not_back() -> None:
    (step,) = steps("turn right 45", "another 45 the same way")
    assert isinstance(step, Turn)
    assert not step.left


def test_a_speed_changes_the_speed_and_nothing_else() -> None:
    (step,) = steps("one metre forward at 0.2 m/s", "once more but at 0.5")
    assert step == Drive(1.0, speed_mps=0.5)


@pytest.mark.parametrize(
    ("said", "twist"),
    [
        ("v=0.4 m/s, w=-0.8 rad/s, T=2 s", RawTwist(0.4, 0.0, -0.8, 2.0)),
        ("(vx, vy, wz) = (0.0, 0.0, 1.0) for 1.57 s", RawTwist(0.0, 0.0, 1.0, 1.57)),
        ("Twist(linear=(-0.1, 0, 0), angular=(0, 0, 0)) for 8 s", RawTwist(-0.1, 0.0, 0.0, 8.0)),
    ],
)
def test_a_twist_in_other_notations(said: str, twist: RawTwist) -> None:
    assert steps(said) == (twist,)


def test_a_drive_ends_at_an_obstacle_only_at_a_distance_that_was_said() -> None:
    assert steps("drive until something is 30 cm in front of you") == (Drive(until=ObstacleWithin(0.3)),)
    assert Conversation().say("drive until you see a wall").plan is None


def test_a_place_whose_odometry_began_anew_is_asked_about() -> None:
    dialogue = Dialogue(places={"dock": Place(Pose(1.0, 0.0, 0.0), usable=False)})
    meant = OfflineInterpreter(MECANUM).interpret("go to the dock", Context(dialogue))
    assert (meant.outcome, meant.code) == ("unclear", "place_unusable")
    assert "dock" in meant.reply


def test_a_word_that_was_defined_is_done_as_often_as_said() -> None:
    once: Plan | None = Conversation().say("go forward 30 cm").plan
    assert once is not None
    assert steps("let's call going forward 30 cm a hop", "hop three times") == once.steps * 3


def test_compass_points_count_only_from_a_heading_that_was_said() -> None:
    first, ahead, second, on = steps(
        "you're facing north. face east, drive 1 m, face north again and drive 2 m"
    )
    assert (first, second) == (Turn(math.pi / 2, left=False), Turn(math.pi / 2, left=True))
    assert (ahead, on) == (Drive(1.0), Drive(2.0))
    for text in ("face east", "north 2 m", "you're facing north. turn left, then face north"):
        assert Conversation().say(text).plan is None


def test_lengths_that_happen_to_add_up_are_all_driven() -> None:
    done = steps("three feet forward, one foot back, then two feet to the left")
    assert [round(s.distance_m or 0.0, 4) for s in done if isinstance(s, Drive)] == [0.9144, 0.3048, 0.6096]


def test_each_again_adds_what_was_said_once() -> None:
    assert len(steps("back 20 cm, again, again")) == 3
    assert len(steps("slide left 20 cm, and then the same thing again three more times")) == 4


def test_going_ahead_by_an_amount_is_forward_whatever_came_before() -> None:
    last = steps("slide left 30 cm, then go ahead 2 m")[-1]
    assert isinstance(last, Drive)
    assert last.direction_rad == 0.0


def test_repeats_until_it_has_come_all_the_way_round() -> None:
    turns = [s for s in steps("turn right 60 degrees, wait 1 s, and repeat until you have turned all the way round")
             if isinstance(s, Turn)]  # fmt: skip
    assert len(turns) == 6


@pytest.mark.parametrize(
    "text",
    [
        "body velocity 0.2 m/s x, 0.1 m/s y, yaw rate 0.5 rad/s, hold for 2 s",
        "cmd_vel x=0.2 y=0.1 z=0.5 for 2 s, then zero it",
        "linear.x 0.2, linear.y 0.1, angular.z 0.5, duration 2",
    ],
)
def test_raw_velocities_with_the_axes_written_apart(text: str) -> None:
    assert steps(text) == (RawTwist(0.2, 0.1, 0.5, 2.0),)


def test_a_step_is_as_long_as_this_dialogue_says() -> None:
    talk = Conversation()
    assert talk.say("a step is forty centimetres").plan is None
    meant = talk.say("three steps forward")
    assert meant.plan is not None
    assert isinstance(meant.plan.steps[0], Drive)
    assert meant.plan.steps[0].distance_m == pytest.approx(1.2)


def test_what_is_taken_back_at_the_end_does_not_move() -> None:
    assert OfflineInterpreter(MECANUM).interpret("go for... no, abort", Context()).outcome == "stop"
