"""A place that is to be driven around is not where the robot goes."""

from __future__ import annotations

import pytest

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.plan.steps import Go
from tests.language.dialogue_runner import MECANUM

CORNERS = [(3.0, 1.0), (5.0, 1.0), (5.0, 3.0), (3.0, 3.0)]
PLACES = {"table": Pose(4.0, 2.0), "桌子": Pose(4.0, 2.0), "tisch": Pose(4.0, 2.0), "sofa": Pose(0.0, 5.0)}


def meant(text: str, *, mapped: bool = True) -> Interpretation:
    names = tuple((name,) for name in PLACES)
    rings = (lambda _: CORNERS) if mapped else None
    context = Context(Dialogue(), RobotState(), PLACES, place_names=names, rings=rings)
    return OfflineInterpreter(MECANUM).interpret(text, context)


def corners(text: str) -> list[tuple[float, float]]:
    plan = meant(text).plan
    assert plan is not None, text
    return [(step.x_m, step.y_m) for step in plan.steps if isinstance(step, Go)]


@pytest.mark.parametrize(
    "text",
    [
        "drive around the table",
        "please go once around the table",
        "circle the table",
        "do a lap around the table",
        "绕着桌子走一圈",
        "围着桌子转一圈",
        "fahr um den Tisch herum",
        "umrunde den Tisch",
    ],
)
def test_it_goes_once_around_from_the_corner_that_is_nearest(text: str) -> None:
    assert corners(text) == [*CORNERS, CORNERS[0]]


def test_it_goes_as_often_and_the_way_round_that_is_said() -> None:
    once = [CORNERS[0], *CORNERS[::-1]]
    assert corners("drive around the table clockwise") == once
    assert corners("绕桌子两圈") == 2 * [*CORNERS, CORNERS[0]]
    assert corners("drive around the table, then go to the sofa")[-1] == (0.0, 5.0)


@pytest.mark.parametrize(
    "text",
    ["drive along the table", "go past the table", "drive under the table", "don't drive around the table"],
)
def test_what_leads_by_a_place_does_not_lead_to_it(text: str) -> None:
    assert meant(text).plan is None


def test_without_a_map_it_says_what_it_does_not_know() -> None:
    told = meant("drive around the table", mapped=False)
    assert (told.plan, told.code) == (None, "around_what")
