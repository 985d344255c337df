"""What can be done of a plan that something blocks is offered as a plan that passes its own rehearsal."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.plan.rehearsal import Rehearsal, rehearse
from chatrobot.plan.text import format_plan, parse_plan
from tests.plan.kernels import pass_all
from tests.plan.robots import MECANUM
from tests.plan.worlds import WALL_AHEAD, BoxWorld, flat

AT_THE_WALL = Pose(2.0 - 0.23, 0.0, 0.0)


def rehearsed(text: str, world: BoxWorld = WALL_AHEAD, start: Pose = ORIGIN) -> Rehearsal:
    return rehearse(parse_plan(text), MECANUM, world, start, pass_all)


def possible(text: str, world: BoxWorld = WALL_AHEAD, start: Pose = ORIGIN) -> str:
    """What is offered, in one line."""
    found = rehearsed(text, world, start).possible
    return format_plan(found).replace("\n", "; ") if found is not None else ""


@pytest.mark.parametrize(
    ("asked", "offered"),
    [
        ("drive 5 m", "drive 1.75 m"),
        ("drive 5 m at 0.5 m/s", "drive 1.75 m at 0.5 m/s"),
        (
            "turn left 90 deg\nturn right 90 deg\ndrive 5 m",
            "turn left 90 deg; turn right 90 deg; drive 1.75 m",
        ),
        ("drive 0.5 m\nwait 1 s\ndrive 5 m", "drive 0.5 m; wait 1 s; drive 1.25 m"),
        ("repeat 3\ndrive 0.6 m\nend", "repeat 2; drive 0.6 m; end; drive 0.55 m"),
        ("drive 1 m\ndrive 0.74 m\ndrive 1 m", "drive 1 m; drive 0.74 m"),
    ],
)
def test_the_free_part_is_offered_with_all_that_comes_before(asked: str, offered: str) -> None:
    assert " ".join(possible(asked).split()) == offered


@pytest.mark.parametrize("text", ["drive 5 m", "drive 0.5 m\ndrive 5 m", "drive 1 m\nwait 1 s\ndrive 5 m"])
def test_the_reason_says_how_much_of_the_whole_way_is_free(text: str) -> None:
    found = rehearsed(text).refusal
    assert found is not None
    assert found.reason.values["free_m"] == 1.75
    assert found.reason.values["total_m"] == pytest.approx(1.76, abs=0.01)


def test_a_turn_is_offered_as_far_as_it_goes() -> None:
    found = rehearsed("turn left 90 deg", start=Pose(2.0 - 0.27, 0.0, 0.0))
    assert found.refusal is not None
    assert found.refusal.reason.values["free_deg"] >= 10
    assert found.possible is not None
    assert "deg" in format_plan(found.possible)


@pytest.mark.parametrize("text", ["drive 1 m", "drive 0.1 m\nturn left 90 deg"])
def test_nothing_is_offered_where_nothing_useful_is_free(text: str) -> None:
    found = rehearsed(text, start=AT_THE_WALL)
    assert not found.ok
    assert found.possible is None


@pytest.mark.parametrize(
    "text", ["turn left 90 deg", "turn left 30 deg; turn right 30 deg; drive 1 m toward 180 deg", "go to 0 1"]
)
def test_what_cannot_begin_beside_a_wall_is_offered_after_a_drive_away_from_it(text: str) -> None:
    offered = possible(text.replace("; ", "\n"), start=AT_THE_WALL)
    assert offered == f"drive 0.2 m back; {text.replace(' toward 180 deg', ' back')}"
    assert rehearsed(offered.replace("; ", "\n"), start=AT_THE_WALL).ok


def test_what_nothing_blocks_offers_nothing() -> None:
    assert rehearsed("drive 1 m").possible is None
    assert rehearsed("drive 1 m at 50 m/s").possible is None


def test_what_comes_first_counts_wall_or_area() -> None:
    world = BoxWorld([(2.0, -1.0, 2.1, 1.0)], area=[(-1, -1), (1, -1), (1, 1), (-1, 1)])
    found = rehearsed("drive 5 m", world)
    assert found.refusal is not None
    assert (found.refusal.reason.code, found.refusal.reason.values["free_m"]) == ("leaves_area", 0.75)
    assert possible("drive 5 m", world) == "drive 0.75 m"


LINES = st.sampled_from(
    ["drive {a} m", "drive {a} m left", "drive {a} s back", "turn left {b} deg", "turn right {b} deg",
     "arc left {b} deg radius 0.4 m", "twist 0.2 0.1 0.3 for {a} s", "go to {a} 0.2"]
)  # fmt: skip
plans = st.lists(
    st.tuples(LINES, st.integers(2, 30), st.integers(5, 200)).map(
        lambda made: made[0].format(a=made[1] / 10, b=made[2])
    ),
    min_size=1,
    max_size=5,
)


@settings(max_examples=150, deadline=None)
@given(plans)
def test_what_is_offered_may_run_from_the_same_place(lines: list[str]) -> None:
    text = "\n".join(lines)
    offered = rehearsed(text, flat()).possible
    if offered is not None:
        assert rehearsed(format_plan(offered), flat()).ok, (text, format_plan(offered))
