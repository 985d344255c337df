"""Points that lie to a place: near it, in front of it, behind it, halfway to it, between two."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import Pose
from chatrobot.dialogue.places import MapWays
from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.plan.ring import middle_of, point_beside
from chatrobot.plan.steps import Go
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from tests.language.profiles import MECANUM

RING = [(3.0, 1.0), (5.0, 1.0), (5.0, 3.0), (3.0, 3.0)]
"""Around the table at (4, 2); a robot that stands at it is west of it, as at the start."""
PLACES = {"table": Pose(2.6, 2.0), "桌子": Pose(2.6, 2.0), "tisch": Pose(2.6, 2.0), "sofa": Pose(0.0, 5.0)}
PLACES |= {"沙发": PLACES["sofa"], "couch": PLACES["sofa"]}


def meant(text: str, *, mapped: bool = True, at: Pose | None = None) -> Interpretation:
    names = tuple((name,) for name in PLACES)
    rings = (lambda _: RING) if mapped else None
    state = RobotState(pose=at or Pose(0.0, 2.0))
    context = Context(Dialogue(), state, PLACES, place_names=names, rings=rings)
    return OfflineInterpreter(MECANUM).interpret(text, context)


def goal(text: str) -> tuple[float, float]:
    plan = meant(text).plan
    assert plan is not None, text
    (step,) = plan.steps
    assert isinstance(step, Go), text
    return step.x_m, step.y_m


@pytest.mark.parametrize(
    ("text", "point"),
    [
        ("go near the table", (2.6, 2.0)),
        ("park right next to the table", (2.6, 2.0)),
        ("drive in front of the table please", (2.6, 2.0)),
        ("开到桌子旁边", (2.6, 2.0)),
        ("到桌子前面去", (2.6, 2.0)),
        ("fahr in die Nähe vom Tisch", (2.6, 2.0)),
        ("go behind the table", (5.0, 2.0)),
        ("stell dich hinter den Tisch", (5.0, 2.0)),
        ("go half a metre in front of the table", (2.62, 2.0)),
        ("drive halfway to the table", (1.3, 2.0)),
        ("走到去桌子的半路上", (1.3, 2.0)),
        ("fahr den halben Weg zum Tisch", (1.3, 2.0)),
        ("stand between the table and the sofa", (1.3, 3.5)),
        ("开到桌子和沙发之间", (1.3, 3.5)),
        ("fahr zwischen den Tisch und das Sofa", (1.3, 3.5)),
        ("drive one metre towards the table", (1.0, 2.0)),
    ],
)
def test_it_goes_to_the_point_that_lies_so_to_the_place(text: str, point: tuple[float, float]) -> None:
    assert goal(text) == pytest.approx(point, abs=0.011)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("go to the second table", "which_place"),
        ("去第二张桌子", "which_place"),
        ("drive nine metres towards the table", "no_way_so_far"),
        ("go to the left of the table", "unclear_motion"),
    ],
)
def test_what_it_does_not_know_is_asked(text: str, code: str) -> None:
    told = meant(text)
    assert (told.plan, told.code) == (None, code)


def test_behind_it_is_asked_where_that_is_another_side_from_here() -> None:
    assert meant("go behind the table", at=Pose(4.0, 6.0)).code == "behind_what"
    assert meant("go behind the table", mapped=False).code == "around_what"


def test_a_remark_on_where_something_stands_moves_nothing() -> None:
    for text in ("the sofa is behind the table", "is the sofa near the table?", "桌子在沙发旁边"):
        assert meant(text).plan is None, text


def test_half_the_way_is_measured_along_the_way_it_would_drive() -> None:
    home = MapWays(load_world("home"), load_profile("wheeltec_mini_mec"))
    here, fridge = Pose(), home.world.places["fridge"]
    whole_m = home(here, fridge)
    half = home.along(here, fridge, 0.5)
    assert whole_m is not None
    assert half is not None
    assert home(here, Pose(*half)) == pytest.approx(whole_m / 2.0, rel=0.05)
    assert math.dist(half, (fridge.x_m / 2.0, fridge.y_m / 2.0)) > 0.1  # and not through the wall


def test_a_point_beside_a_ring_is_on_it_or_so_far_out() -> None:
    assert middle_of(RING) == (4.0, 2.0)
    assert point_beside(RING, (9.0, 2.0)) == pytest.approx((5.0, 2.0))
    assert point_beside(RING, (4.0, -7.0), 0.5) == pytest.approx((4.0, 0.5))


@pytest.mark.parametrize(
    "text", ["朝沙发走一米", "往沙发方向走一米", "朝着沙发慢慢走一米", "drive 1 m towards the sofa"]
)
def test_towards_a_place_it_drives_as_far_as_told(text: str) -> None:
    assert goal(text) == (0.0, 3.0)


@pytest.mark.parametrize("text", ["往沙发退一米", "往沙发左移一米"])
def test_backwards_or_sideways_it_drives_towards_no_place(text: str) -> None:
    assert meant(text).plan is None
