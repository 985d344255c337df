"""Items that say what must happen as plans: what fits, what is wrong, what counts as asked."""

from __future__ import annotations

import math

import pytest

from chatrobot.cli.eval.corpus import Item, Meant, Turn
from chatrobot.cli.eval.judge import Record, judge
from chatrobot.core.events import Outcome
from chatrobot.plan.text import parse_plan
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from tests.eval.test_judge import Piece
from tests.eval.traces import forward, left, rest, trace

ROBOT = load_profile(DEFAULT_PROFILE)
QUARTER = math.pi / 2


def meant(*plans: str, mirror_ok: bool = False, closed_ok: bool = False) -> Meant:
    return Meant(tuple(parse_plan(plan) for plan in plans), mirror_ok, closed_ok)


def kind(wanted: Meant, *pieces: Piece, outcome: Outcome = "completed", ask_ok: bool = False) -> str:
    item = Item("en-1", "metric", (Turn("…"),), meant=wanted, ask_ok=ask_ok)
    return judge(item, [Record(outcome, "a reply", trace(*pieces))], ROBOT).kind


@pytest.mark.parametrize(
    ("plan", "just_right", "just_wrong"),
    [
        ("drive 0.5 m", [forward(0.55)], [forward(0.57)]),  # 6 cm where a share is less
        ("drive 4 m", [forward(4.19)], [forward(4.22)]),  # 5 % of the distance where that is more
        ("turn left 90 deg", [left(math.radians(94))], [left(math.radians(96))]),
        ("drive 1 m\nwait 2 s\ndrive 1 m", [forward(1), rest(2.5), forward(1)], [forward(1), rest(2.7), forward(1)]),
        ("drive 1 m\nwait 20 s\ndrive 1 m", [forward(1), rest(21.8), forward(1)], [forward(1), rest(22.2), forward(1)]),
        ("drive 1 m at 0.4 m/s", [forward(1, 0.44)], [forward(1, 0.455)]),
        ("turn left 90 deg at 1 rad/s", [left(QUARTER, 1.1)], [left(QUARTER, 1.14)]),
        ("drive 1 m", [forward(1, 0.9)], [forward(1.07, 0.3)]),  # a speed counts only where one is told
    ],
)  # fmt: skip
def test_tolerances(plan: str, just_right: list[Piece], just_wrong: list[Piece]) -> None:
    assert kind(meant(plan), *just_right) == "correct"
    assert kind(meant(plan), *just_wrong) == "wrong"


def test_full_turns_count() -> None:
    assert kind(meant("turn left 360 deg"), left(2 * math.pi)) == "correct"
    assert kind(meant("turn left 720 deg"), left(2 * math.pi)) == "wrong"
    assert kind(meant("turn right 180 deg"), left(math.pi)) == "wrong"


def test_what_is_undone_was_driven_nevertheless() -> None:
    assert kind(meant("turn left 90 deg"), left(QUARTER), left(QUARTER), left(-QUARTER)) == "wrong"
    assert kind(meant("drive 1 m"), forward(1.5), forward(-0.5)) == "wrong"


def test_any_of_several_plans_is_right() -> None:
    wanted = meant("turn left 180 deg", "turn right 180 deg")
    assert kind(wanted, left(math.pi)) == kind(wanted, left(-math.pi)) == "correct"
    assert kind(wanted, left(QUARTER)) == "wrong"


def test_the_mirror_image_is_right_where_it_may_be() -> None:
    corner = "drive 1 m\nturn left 90 deg\ndrive 1 m"
    mirrored = [forward(1), left(-QUARTER), forward(1)]
    assert kind(meant(corner, mirror_ok=True), *mirrored) == "correct"
    assert kind(meant(corner), *mirrored) == "wrong"


def test_a_shape_may_lack_its_last_turn_where_that_is_fine() -> None:
    square = "repeat 4\n drive 1 m\n turn left 90 deg\nend"
    side = [forward(1), left(QUARTER)]
    open_end = [*side, *side, *side, forward(1)]
    assert kind(meant(square, closed_ok=True), *open_end) == "correct"
    assert kind(meant(square), *open_end) == "wrong"
    assert kind(meant(square, closed_ok=True), *side, *side, forward(1)) == "wrong"


def test_the_heading_at_a_point_is_free() -> None:
    assert kind(meant("go to 1 0"), forward(1)) == "correct"
    assert kind(meant("go to 1 0"), left(math.pi), forward(-1)) == "correct"
    assert kind(meant("go to 1 0 facing 0 deg"), left(math.pi), forward(-1)) == "wrong"
    assert kind(meant("go to 1 0"), forward(2)) == "wrong"


def test_what_must_stand_may_not_move_whatever_is_said() -> None:
    assert kind(Meant(), outcome="answered") == kind(Meant(), outcome="unclear") == "correct"
    assert kind(Meant(), forward(0.1), forward(-0.1), outcome="answered") == "wrong"


def test_asking_back_is_abstaining_or_as_good() -> None:
    wanted = meant("drive 1 m")
    assert kind(wanted, outcome="unclear") == kind(wanted, outcome="refused") == "abstained"
    assert kind(wanted, outcome="unclear", ask_ok=True) == "correct"
    assert kind(wanted, forward(0.5), outcome="unclear", ask_ok=True) == "wrong"
    assert kind(wanted, outcome="answered") == kind(wanted, outcome="completed") == "wrong"


def dialogue(plan: str, *turns: tuple[Outcome, list[Piece]]) -> str:
    records, so_far = [], trace()
    pieces: list[Piece] = []
    for outcome, more in turns:
        pieces += more
        whole = trace(*pieces)
        records.append(Record(outcome, "a reply", whole[len(so_far) - 1 :]))
        so_far = whole
    item = Item("en-1", "dialogue", tuple(Turn("…") for _ in turns), meant=meant(plan))
    return judge(item, records, ROBOT).kind


def test_a_dialogue_with_a_turn_asked_about_is_abstained_only_where_the_rest_fits() -> None:
    plan = "drive 1 m\nturn left 90 deg\ndrive 1 m"
    assert (
        dialogue(plan, ("completed", [forward(1)]), ("completed", [left(QUARTER), forward(1)])) == "correct"
    )
    assert dialogue(plan, ("completed", [forward(1)]), ("unclear", [])) == "abstained"
    assert dialogue(plan, ("unclear", []), ("completed", [left(QUARTER), forward(1)])) == "abstained"
    assert dialogue(plan, ("completed", [forward(1)]), ("completed", [])) == "wrong"
    assert dialogue(plan, ("completed", [forward(2.5)]), ("unclear", [])) == "wrong"
    assert dialogue(plan, ("unclear", []), ("completed", [left(-QUARTER)])) == "wrong"
