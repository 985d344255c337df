"""Phrasings that look like another: a word to begin with and a side, a shuffle and a turn, first and last."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Arc, Drive, Step, Turn, Wait
from tests.language.dialogue_runner import Conversation


def _told(step: Step) -> str:
    """A step in a few letters: F1, B0.5, L1 and R1 (sideways), l90 and r90 (turns), w2, o180 (arc)."""
    if isinstance(step, Drive):
        way = {0: "F", 90: "L", 180: "B", -90: "R"}[round(math.degrees(step.direction_rad))]
        return f"{way}{step.distance_m:g}" if step.distance_m else f"{way}{step.duration_s:g}s"
    if isinstance(step, Turn):
        degrees = f"{math.degrees(step.angle_rad):.0f}" if step.angle_rad else f"{step.duration_s:g}s"
        return f"{'l' if step.left else 'r'}{degrees}"
    if isinstance(step, Arc):
        return f"{'(' if step.left else ')'}{math.degrees(step.angle_rad or 0.0):.0f}"
    assert isinstance(step, Wait), step
    return f"w{step.duration_s:g}"


def _done(said: str) -> str:
    """The steps, or the outcome where there are none."""
    meant = Conversation().say(said)
    return " ".join(map(_told, meant.plan.steps)) if meant.plan else meant.outcome


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("go back 60 cm, right, and then, when that's done, turn left 30 degrees", "B0.6 l30"),
        ("so first you go forward 1 m, right, and then you turn left 90 degrees", "F1 l90"),
        ("ok, right, so go forward 1 m", "F1"),
        ("right, now go forward 1 m", "F1"),
        ("right, go forward 1 m", "unclear"),
        ("right, go 1 m, left, go 1 m", "R1 L1"),
        ("right, 1 m", "R1"),
        ("forward 1 m, right, and then left", "F1 r90 l90"),
        ("right 90, forward 1 m", "r90 F1"),
    ],
)
def test_a_word_to_begin_with_is_no_side(said: str, done: str) -> None:
    assert _done(said) == done


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("before you turn left 90 degrees, drive 1 m; afterwards drive 50 cm", "F1 l90 F0.5"),
        ("before you turn left 90 degrees, drive 1 m. Then drive 50 cm", "F1 l90 F0.5"),
        ("before you turn left 90 degrees, drive 1 m and wait 2 s", "F1 w2 l90"),
        ("turn left 90 after you drive 1 m, and after that drive 2 m", "F1 l90 F2"),
        ("turn left 90 degrees after driving 1 m and waiting 2 seconds", "F1 w2 l90"),
        ("turn left 90 degrees before you drive 1 m, then drive 2 m", "l90 F1 F2"),
    ],
)
def test_what_comes_after_both_is_done_last(said: str, done: str) -> None:
    assert _done(said) == done


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("sideways left 1 m, and the same to the right", "L1 R1"),
        ("strafe left 50 cm and the same right", "L0.5 R0.5"),
        ("turn left 40 degrees, wait 1 s, then the same to the right", "l40 w1 r40"),
        ("forward 1 m and the same back", "F1 B1"),
        ("forward 1 m and the same to the right", "unclear"),
        ("turn right 30 degrees, then left again", "r30 l90"),
    ],
)
def test_the_same_to_the_other_side_is_as_far_and_in_the_same_manner(said: str, done: str) -> None:
    assert _done(said) == done


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("pop forward 20 cm, count to three, pop back 20 cm", "F0.2 w3 B0.2"),
        ("forward 1 m then count slowly to ten and come back", "F1 w10 B1"),
        ("go straight, count to four, then stop", "F4s"),
        ("go forward 1 m, count to 3, then stop", "F1 w3"),
    ],
)
def test_counting_takes_a_second_a_number(said: str, done: str) -> None:
    assert _done(said) == done


@pytest.mark.parametrize("verb", ["scooch", "shuffle", "scoot", "scooch over", "budge"])
def test_to_make_room_is_to_go_sideways(verb: str) -> None:
    assert _done(f"{verb} to the left") == "L0.5"
    assert _done(f"{verb} 30 cm to the right") == "R0.3"


def test_part_of_a_circle_is_not_all_of_it() -> None:
    assert _done("halfway round a circle of 1 m radius, clockwise") == ")180"
    assert _done("go half way round the roundabout to the left, radius 50 cm") == "(180"
    assert _done("like going round a roundabout with 1 m radius, half way, turning right") == "unclear"
    assert _done("a circle of 1 m radius to the left, halfway wait 2 s") == "(180 w2 (180"


@pytest.mark.parametrize("said", ["floor it for 2 m", "gun it, 2 m", "put the pedal to the metal, 2 m ahead"])
def test_flooring_it_is_as_fast_as_allowed(said: str) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    step = plan.steps[0]
    assert isinstance(step, Drive)
    assert step.speed_mps == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("go forward and stop after 1 m", "F1"),
        ("reverse, stopping after half a metre", "B0.5"),
        ("go straight and turn left after 2 metres, then go 1 m", "F2 l90 F1"),
        ("drive forward, and after 3 seconds turn right", "F3s r90"),
        ("turn left 90 and after 3 seconds turn right 90", "l90 w3 r90"),
        ("forward 1 m after 3 seconds", "w3 F1"),
        ("go forward 3 m, after 1 m stop for 2 s", "F1 w2 F2"),
        ("go forward 2 m, pausing 1 s after 1 m", "F1 w1 F1"),
        ("go forward 3 m but stop after 1 m", "unclear"),
        ("forward 2 m, turn left after 1 m", "unclear"),
        ("wait 2 s after going 1 m", "F1 w2"),
    ],
)
def test_an_amount_after_which_something_comes_is_no_motion_of_its_own(said: str, done: str) -> None:
    assert _done(said) == done


@pytest.mark.parametrize(
    "said",
    [
        "take the next right",
        "turn left at the corner",
        "go on my mark",
        "on my signal, go forward 1 m",
        "drive back to the right 1 m",
    ],
)
def test_what_only_a_person_can_see_or_say_is_asked_about(said: str) -> None:
    assert _done(said) == "unclear"
    assert _done("take a right") == "r90"


def test_a_route_of_ways_alone_leaves_none_out() -> None:
    assert _done("left, left, right") == "l90 l90 r90"
    assert _done("forward, forward, left") == "F0.5 F0.5 l90"
    assert _done("left, left!") == "l90"


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("five ten-centimetre steps back", "B0.1 B0.1 B0.1 B0.1 B0.1"),
        ("two 50 cm legs forward and then left 90", "F0.5 F0.5 l90"),
        ("half a dozen one-metre hops", "F1 F1 F1 F1 F1 F1"),
        ("do two 45-degree turns to the right", "r45 r45"),
        ("twenty five centimetre steps forward", "F0.25"),
    ],
)
def test_a_count_before_an_amount_is_how_often(said: str, done: str) -> None:
    assert _done(said) == done


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("go forward, not two metres but three", "F3"),
        ("not 90 but 45 degrees left", "l45"),
        ("after waiting for three seconds go 1 meter forward", "w3 F1"),
        ("before going 1 m turn left", "l90 F1"),
        ("quarter turn to port", "l90"),
        ("half turn to starboard", "r180"),
    ],
)
def test_what_is_not_meant_and_what_comes_first(said: str, done: str) -> None:
    assert _done(said) == done


def test_to_come_back_a_number_takes_the_unit_of_the_way_out() -> None:
    def back(number: int) -> str:
        talk = Conversation()
        talk.say("go forward 80 centimetres")
        meant = talk.say(f"Too far! Come back {number}.")
        return " ".join(map(_told, meant.plan.steps)) if meant.plan else meant.outcome

    assert back(30) == "B0.3"
    assert back(200) == "unclear"


@pytest.mark.parametrize(
    "said",
    [
        "did you turn left?",
        "did you go forward 1 m?",
        "are you turning left",
        "were you going backwards?",
        "should I turn left?",
        "does it turn left?",
        "I'll go forward 1 m",
    ],
)
def test_a_question_about_a_motion_orders_none(said: str) -> None:
    assert Conversation().say(said).plan is None


@pytest.mark.parametrize(
    "said", ["could you go forward 1 m?", "would you go forward 1 m?", "why don't you go forward 1 m"]
)
def test_a_request_put_as_a_question_is_still_done(said: str) -> None:
    assert _done(said) == "F1"


def test_to_stop_doing_something_is_not_to_do_it() -> None:
    assert _done("stop going forward and turn left") == "l90"
    assert _done("stop turning left, go back 1 m") == "B1"
    assert _done("stop spinning round") == "stop"


@pytest.mark.parametrize(
    "said", ["step left", "hop to the left", "glide over to the left", "ease over to the left"]
)
def test_a_step_to_the_side_is_no_turn(said: str) -> None:
    assert _done(said) == "L0.5"
    assert _done("step back") == "B0.5"


def test_places_and_tricks_are_named_in_more_words_than_needed() -> None:
    talk = Conversation()
    assert talk.say("this is the charging corner, remember it").remember_place == "charging corner"
    assert talk.say("learn a trick called bow: back 20 cm, wait 1 s, forward 20 cm").define
    bowed = talk.say("do your bow trick").plan
    assert bowed is not None
    assert " ".join(map(_told, bowed.steps)) == "B0.2 w1 F0.2"
