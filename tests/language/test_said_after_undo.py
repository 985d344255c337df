"""What is said after an undo, and after an order that was asked back about, is meant of that, or asked about."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation, plan_of


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        # nothing is left of what was undone: another amount is driven from there, and not what is missing to it
        (("forward 1 m", "undo that", "I meant 2 m"), "drive 2 m"),
        (("forward 1 m", "undo that", "2 m instead"), "drive 2 m"),
        (("turn right 90", "undo that", "it should have been 30"), "turn right 30 deg"),
        (("turn right 90", "undo that", "try 30 instead"), "turn right 30 deg"),
        (("forward 1 m at 0.4 m/s", "undo that", "try it at 0.2 instead"), "drive 1 m at 0.2 m/s"),
        (("rechts 90 Grad drehen", "mach das rückgängig", "ich meinte 30 Grad"), "turn right 30 deg"),
        (("往右转90度", "撤销", "应该是30度"), "turn right 30 deg"),
        # what is put right in full, and what it is put right with
        (
            ("slide 1 m to the right", "back again, then a metre to the left"),
            "drive 1 m left\ndrive 1 m left",
        ),
        (
            ("slide 1 m to the right", "no, I meant left. So back again and then 1 m to the left"),
            "drive 1 m left\ndrive 1 m left",
        ),
        (
            (
                "1 m nach rechts, ohne zu drehen",
                "Nee, ich hab links gemeint. Also zurück und dann 1 m nach links",
            ),
            "drive 1 m left\ndrive 1 m left",
        ),
        (("往右转三十度", "刚才那一下不要了，转回来吧"), "turn left 30 deg"),
        # all turns one after another count towards a total
        (("turn left 30", "30 more", "make it 90 in total"), "turn left 30 deg"),
        (("turn left 120", "same angle again", "turn the rest of the full circle"), "turn left 120 deg"),
        # `backwards` is a way of the robot, and no way that it came
        (("slide left 80 cm", "now backwards, just as far"), "drive 0.8 m back"),
    ],
)
def test_what_was_undone_is_put_right_from_where_it_began(turns: tuple[str, ...], plan: str) -> None:
    assert plan_of(*turns) == plan


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (
            ("draw a circle to the left", "grommel 30 cm to the left", "again to the right"),
            "arc right",
        ),
        (("forward 1 m", "grommel 30 cm to the left", "again"), "drive 1 m"),
    ],
)
def test_a_motion_before_an_order_that_was_asked_about_is_repeated_only_after_a_yes(
    turns: tuple[str, ...], plan: str
) -> None:
    meant = conversation(*turns[:-1]).say(turns[-1])
    assert meant.plan is None
    assert meant.proposal is not None
    assert meant.proposal.plan_text.startswith(plan)


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("forward 1 m", "nice weather today", "again"), "drive 1 m"),
        (("forward 1 m", "turn", "left"), "turn left 90 deg"),
        (("forward 1 m", "grommel 30 cm to the left", "turn right 45 degrees"), "turn right 45 deg"),
    ],
)
def test_a_remark_an_answer_or_an_order_of_its_own_is_not_asked_about(
    turns: tuple[str, ...], plan: str
) -> None:
    assert plan_of(*turns) == plan


def test_a_measure_that_is_changed_beside_another_is_not_lost() -> None:
    turns = "顺时针走个圆，半径40厘米", "再来一次，这回逆时针，半径改成60厘米"
    assert plan_of(*turns) == "arc left 360 deg radius 0.6 m"
