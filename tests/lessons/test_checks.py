"""What each check says is measured on true poses, in sentences that say how far off it is."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import Twist
from chatrobot.core.sensed_events import ObstacleChanged, TruePose
from chatrobot.lessons.checks import CHECKS
from chatrobot.lessons.run import LessonRun
from chatrobot.lessons.words import describe_finding
from chatrobot.sim.trace import Sample
from tests.eval.traces import forward, left, rest, trace
from tests.lessons.made import FOOTPRINT, drive, judged, sheet_with

QUARTER = math.pi / 2
SQUARE = trace(*[piece for _ in range(4) for piece in (forward(1.0), left(QUARTER))])
THERE_AND_BACK = trace(forward(1.0), rest(2.0), forward(-1.0))

ROWS = [
    ("ends_at: {x_m: 1, y_m: 0}", trace(forward(1.0)), "done", "the robot stands at the goal"),
    ("ends_at: {x_m: 2, y_m: 1}", trace(forward(1.0)), "missing", "1.41 m away, ahead to the left ("),
    ("ends_at: {place: start}", THERE_AND_BACK, "done", "stands at the start"),
    ("heading_deg: 90", trace(left(QUARTER)), "done", "it looks the right way"),
    ("heading_deg: {is: -90, within: 5}", trace(left(QUARTER)), "missing", "180° further"),
    ("heading_deg: 90", trace(left(QUARTER / 2)), "missing", "45° further to the left"),
    ("heading_deg: -90", trace(left(-QUARTER / 2)), "missing", "45° further to the right"),
    ("turned_deg: {at_least: 350}", trace(left(4 * QUARTER)), "done", "turned by 360°"),
    ("turned_deg: {at_least: 350}", trace(left(QUARTER)), "missing", "at least 350° is asked for"),
    ("path_m: {at_least: 1.5}", trace(forward(1.0)), "missing", "it has driven 1.00 m, and at least 1.5 m"),
    ("path_m: {at_most: 1.5}", THERE_AND_BACK, "broken", "it drove 2.00 m, and at most 1.5 m"),
    ("corners: 4", SQUARE, "done", "corners: 4"),
    ("corners: 3", SQUARE, "broken", "corners on the way: 4, and 3 is asked for"),
    ("corners: 0", trace((math.tau, Twist(0.3, 0.0, 1.0))), "done", "corners: 0"),
    ("area_m2: {at_least: 0.9, at_most: 1.1}", SQUARE, "done", "encloses 1.00 m²"),
    ("area_m2: {at_least: 0.9}", THERE_AND_BACK, "missing", "0.00 m² so far"),
    ("time_s: {at_most: 5}", THERE_AND_BACK, "broken", "it drove for 6.0 s, and at most 5 s is allowed"),
    ("stands_s: {at_least: 1.5}", THERE_AND_BACK, "done", "stood for 2.0 s"),
    ("stands_s: {at_least: 1.5}", trace(rest(3.0), forward(1.0), rest(3.0)), "missing", "stood for 0.0 s"),
    ("top_speed_mps: {at_most: 0.2}", trace(forward(1.0)), "broken", "0.50 m/s, and at most 0.2 m/s is allowed"),
]  # fmt: skip


@pytest.mark.parametrize(("check", "driven", "state", "said"), ROWS)
def test_a_check_says_how_it_stands_by_the_true_pose(
    check: str, driven: list[Sample], state: str, said: str
) -> None:
    finding = judged(check, driven)
    assert finding.state == state
    assert said in describe_finding(finding, "en")
    chinese = describe_finding(finding, "zh")
    assert "{" not in chinese
    assert any("一" <= char <= "鿿" for char in chinese)


def test_every_check_that_measures_is_in_the_table_or_below() -> None:
    tried = {row[0].partition(":")[0] for row in ROWS}
    assert set(CHECKS) - tried == {
        "passes", "ends_clear_m", "keeps_clear_m", "touches_nothing", "commands", "forbidden", "plan_text", "plan_has",
        "program",
    }  # fmt: skip


def test_places_are_passed_in_their_order_and_named_in_the_language_of_the_pupil() -> None:
    """From the start of the flat the living room lies 1.1 m ahead and 0.7 m to the left."""
    driven = trace(forward(1.1), left(QUARTER), forward(0.7))
    assert judged("passes: [start, living room]", driven, "home").state == "done"
    finding = judged("passes: [living room, start]", driven, "home")
    assert finding.state == "missing"
    assert "第 2/2 个地点起点" in describe_finding(finding, "zh")
    assert "客厅" in describe_finding(judged("passes: [living room]", trace(left(1.0)), "home"), "zh")


def test_what_the_edge_comes_near_to_is_measured_and_named() -> None:
    """The kitchen wall is 2.85 m ahead of the start, and the footprint reaches 0.1 m."""
    finding = judged("keeps_clear_m: 0.5", trace(forward(2.5), forward(-2.0)), "home")
    assert finding.state == "broken"
    assert "within 0.25 m of the kitchen wall" in describe_finding(finding, "en")
    assert judged("keeps_clear_m: 0.2", trace(forward(2.5)), "home").state == "done"
    assert judged("ends_clear_m: {at_least: 0.2, at_most: 0.3}", trace(forward(2.5)), "home").state == "done"
    assert judged("touches_nothing: true", trace(forward(2.749)), "home").state == "broken"
    assert judged("touches_nothing: true", trace(forward(2.74)), "home").state == "done"
    assert judged("touches_nothing: true", trace(forward(2.7)), "empty").state == "done"


def test_an_obstacle_that_was_put_there_counts_from_then_on() -> None:
    run = LessonRun(sheet_with("touches_nothing: true, path_m: {at_least: 9}"), FOOTPRINT)
    box = ((0.9, -0.2), (1.3, -0.2), (1.3, 0.2), (0.9, 0.2))
    assert drive(run, trace(forward(1.0), forward(-1.0))).findings[0].state == "done"
    run.hear(ObstacleChanged(0, "box", box))
    assert run.hear(TruePose(0, 9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)) is None
    finding = drive(run, trace(forward(0.8)), turn=2).findings[0]
    assert (finding.state, finding.values["thing"]) == ("broken", ("box",))
    run.hear(ObstacleChanged(0, "box", ()))
    assert drive(run, trace(forward(-0.5)), turn=3).findings[0].state == "broken", (
        "what was touched was touched"
    )


@pytest.mark.parametrize(
    ("check", "text", "plan_text", "state"),
    [
        ("commands: {at_most: 1}", "forward", "", "done"),
        ("forbidden: [triangle]", "drive a Triangle now", "", "broken"),
        ("forbidden: [go]", "I am gone: forward 1 m", "", "done"),
        ("forbidden: {en: [triangle], zh: [三角]}", "走一个三角形", "", "broken"),
        ("plan_text: true", "drive 1 m", "drive 1 m", "done"),
        ("plan_text: true", "forward 1 m", "drive 1 m", "broken"),
        ("plan_has: [repeat]", "…", "repeat 4\n  drive 1 m\nend", "done"),
        ("plan_has: repeat", "repeat that", "drive 1 m", "missing"),
        ("program: true", "write a program", "", "missing"),
    ],
)
def test_the_means_are_judged_by_what_was_typed_and_what_ran(
    check: str, text: str, plan_text: str, state: str
) -> None:
    finding = judged(check, trace(forward(1.0)), text=text, plan_text=plan_text)
    assert finding.state == state
    assert "{" not in describe_finding(finding, "en")
