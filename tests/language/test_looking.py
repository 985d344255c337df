"""`Face the sofa` turns to it from where the robot stands by then, and drives nowhere."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.plan.steps import Face
from tests.language.profiles import MECANUM

PLACES = {"sofa": Pose(0.0, 2.0), "沙发": Pose(0.0, 2.0), "couch": Pose(0.0, 2.0)}
"""To the left of the start."""


def meant(text: str, *, ring: bool = False) -> Interpretation:
    rings = (lambda _: [(2.0, 1.0), (4.0, 1.0), (4.0, 3.0), (2.0, 3.0)]) if ring else None
    names = (("sofa", "沙发", "couch"),)
    context = Context(Dialogue(), RobotState(), PLACES, place_names=names, rings=rings)
    return OfflineInterpreter(MECANUM).interpret(text, context)


def heading_deg(text: str, *, ring: bool = False) -> float:
    plan = meant(text, ring=ring).plan
    assert plan is not None, text
    [face] = [step for step in plan.steps if isinstance(step, Face)]
    assert face.frame == "odom"
    return math.degrees(face.yaw_rad)


@pytest.mark.parametrize(
    "text",
    [
        "face the sofa", "turn towards the sofa", "turn to the sofa", "turn to face the sofa",
        "面向沙发", "转向沙发", "朝沙发转", "车头对准沙发", "dreh dich zum Sofa",
    ],
)  # fmt: skip
def test_it_turns_to_the_place(text: str) -> None:
    assert heading_deg(text) == pytest.approx(90.0, abs=0.1)


@pytest.mark.parametrize(
    ("before", "deg"),
    [("drive 2 m forward", 135.0), ("turn left 90 degrees", 90.0), ("slide left 4 m", -90.0),
     ("do a half circle to the left with a radius of 0.5 m", 90.0), ("drive 1 m, twice", 135.0)],
)  # fmt: skip
def test_it_turns_from_where_the_steps_before_lead(before: str, deg: float) -> None:
    assert heading_deg(f"{before}, then face the sofa") == pytest.approx(deg, abs=0.1)


def test_it_faces_what_the_map_has_there() -> None:
    assert heading_deg("face the sofa", ring=True) == pytest.approx(
        math.degrees(math.atan2(2.0, 3.0)), abs=0.1
    )


@pytest.mark.parametrize(
    "text",
    ["turn the sofa", "turn left towards the sofa", "drive until you see a wall, then face the sofa",
     "don't face the sofa", "is the sofa facing you?", "the sofa faces the window"],
)  # fmt: skip
def test_what_is_no_order_to_face_it_turns_nothing(text: str) -> None:
    assert meant(text).plan is None
