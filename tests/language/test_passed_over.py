"""What points at an earlier motion must play a part in the plan: else the robot asks, and drives nothing."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import Conversation
from tests.language.test_cautions import done

FOUR_STEPS = "1 m forward, turn left, 80 cm forward, slide 20 cm right"
CIRCLE = "drive a full circle to the left with a diameter of one metre"
SQUARE = "走一个边长40cm的正方形,往左拐"


@pytest.mark.parametrize(
    "turns",
    [
        (FOUR_STEPS, "step 3 once more", "and step 4 the other way"),
        (CIRCLE, "now another one the same way round, but with twice the radius"),
        ("another two metres", "last one in reverse now, same pace"),
        ("slide left 30 cm", "to the right, twice"),
        ("rutsch 30 cm nach links", "nach rechts, zweimal"),
        ("wait 3 s, then slide 1 m right", "very good; the same to the left, but without the waiting"),
        ("hello", "now a pentagon, same side length"),
        ("trace a rectangle on the floor, 1.2 m by 0.5 m, long side first, all corners to the right",),
        ("先前进三十公分,再左转,再往右平移五十公分", "哎呀,第三个动作朵朵没看见,就那个再做一遍好不好"),
    ],
)
def test_a_part_of_before_that_changes_nothing_is_asked_about(turns: tuple[str, ...]) -> None:
    assert done(*turns) == "unclear"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        ((FOUR_STEPS, "step 3 once more"), "drive 0.8 m"),
        (("step one: forward half a metre", "step two: quarter turn left"), "turn left 90 deg"),
        (("turn left 90, forward 20 cm, slide right 30 cm", "again, skip the left"), "drive 0.2 m; drive 0.3 m right"),
        (("slide left 40 cm", "the same to the right"), "drive 0.4 m right"),
        (("fwd 0.8", "same, 0.2 less"), "drive 0.6 m"),
        ((SQUARE, "一样的再走一个,这回往右拐"), "; ".join(["drive 0.4 m; turn right 90 deg"] * 4)),
    ],
)  # fmt: skip
def test_a_part_of_before_that_is_heeded_is_done(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("drive 1 m", "2 m back, as before"), "drive 2 m back"),
        (("drive 4 seconds at 0.25 m/s", "those 4 seconds in reverse, speed as before"), "drive 4 s back at 0.25 m/s"),
        (("slide right 40 cm", "undo that and slide left instead, same amount", "and 15 more"), "drive 0.15 m left"),
        (("drei Sekunden vorwärts rollen", "gleich lang rückwärts"), "drive 3 s back"),
        (("drive 4 m", "go 4 m in reverse, so he can see it once more"), "drive 4 m back"),
        (("go to x=1, y=0.5", "home, and nose along +x like at boot please"), "go to 0 0 facing 0 deg"),
    ],
)  # fmt: skip
def test_how_it_is_done_is_no_second_time(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


@pytest.mark.parametrize(
    "said",
    [
        "right, then back up 30 cm",
        "let's step back for a minute",
        "let's step back for a minute, kids",
        "let's take a step back",
        "let's move on to the next group",
        "get within 50 cm of it",
        "drive halfway round it",
        "靠近到50厘米以内",
        "今天早操教了向左转向右转,一半孩子转到我怀里来了,哈哈哈",
    ],
)
def test_a_figure_of_speech_and_a_bound_are_no_order(said: str) -> None:
    assert done("drive 1 m back", said) == "unclear"


def test_what_was_offered_goes_to_the_side_that_is_said_next() -> None:
    talk = Conversation()
    talk.say("please zorble a square with sides of 60 cm")
    meant = talk.say("clockwise")
    assert meant.plan is None
    assert meant.proposal is not None
    assert meant.proposal.plan_text.count("turn right 90 deg") == 4


@pytest.mark.parametrize("text", ["左转90度，对，就是左转，可不是右转啊", "turn left but do not turn right"])
def test_a_side_that_is_denied_leaves_the_other_turn(text: str) -> None:
    assert done(text) == "turn left 90 deg"


def test_a_shape_without_turns_is_driven_by_slides() -> None:
    plan = Conversation().say("draw a square with 50 cm sides sliding only").plan
    assert plan is not None
    assert len(plan.steps) == 4


def test_a_shape_that_is_described_is_not_driven() -> None:
    assert done("the square is 2 m wide, go forward 1 m") == "drive 1 m"
