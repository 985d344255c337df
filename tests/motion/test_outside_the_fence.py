"""A robot that stands outside its fence: rehearsal says what the governor then does, and that it stands outside."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from tests.programs.scripted_model import program

from chatrobot.compose import Setup, connect
from chatrobot.core.event import Event
from chatrobot.core.events import Rehearsed, Result
from chatrobot.core.geometry import ORIGIN
from chatrobot.language.phrases import render_reason
from chatrobot.motion.planner import Planned, Planner
from chatrobot.plan.fenced_path import Fence
from chatrobot.plan.text import parse_plan
from chatrobot.programs.library import KeptProgram
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import Circle, Point, RobotProfile
from chatrobot.sim.world import EMPTY_WORLD
from chatrobot.testing.rig import Rig

DIAGONALLY_AHEAD = Circle(5.0, 5.0, 1.0)
BESIDE = Circle(0.0, 2.5, 1.0)
BEHIND = ((-3.0, -1.0), (-1.0, -1.0), (-1.0, 1.0), (-3.0, 1.0))
AHEAD = ((1.0, -1.0), (3.0, -1.0), (3.0, 1.0), (1.0, 1.0))
HALF_OUT = Circle(0.9, 0.1, 0.9)
"""Part of the footprint is inside."""
FENCES: dict[str, Fence] = {
    "diagonally ahead": DIAGONALLY_AHEAD, "beside": BESIDE, "behind": BEHIND, "ahead": AHEAD, "half out": HALF_OUT,
}  # fmt: skip
ROBOTS = ["wheeltec_mini_mec", "turtlebot3_burger"]
"""A mecanum and a differential base, both longer than wide: turning on the spot swings their corners out."""
PLANS = [
    "drive 2 m", "drive 2 m back", "drive 12 m", "turn left 90 deg", "turn right 30 deg", "turn left 180 deg",
    "arc left 300 deg radius 1 m", "turn left 45 deg\ndrive 7 m", "go to 5 5", "drive 0.3 m\nwait 1 s\ndrive 4 m back",
]  # fmt: skip


def fenced(robot: str, fence: Fence) -> RobotProfile:
    profile = load_profile(robot)
    kept = fence if isinstance(fence, Circle) else tuple(fence)
    wiring = replace(profile.wiring, scan_topic="")  # it sees nothing here, and its lidar takes its time
    return replace(
        profile, lidar=None, wiring=wiring, safety=replace(profile.safety, fence=kept, requires=())
    )


def planned(profile: RobotProfile, text: str) -> Planned:
    return Planner(profile, EMPTY_WORLD).plan(1, text, ORIGIN)


def drives(profile: RobotProfile, text: str) -> bool:
    """Whether the governor lets it through, to its end."""
    return Rig(profile).run(parse_plan(text)).outcome == "completed"


@pytest.mark.parametrize("text", PLANS)
@pytest.mark.parametrize("fence", FENCES)
@pytest.mark.parametrize("robot", ROBOTS)
def test_what_is_rehearsed_is_driven_and_what_is_offered_too(robot: str, fence: str, text: str) -> None:
    profile = fenced(robot, FENCES[fence])
    plan = planned(profile, text)
    assert plan.ok is drives(profile, text), plan.refusal
    if plan.possible:
        assert drives(profile, plan.possible), plan.possible


@pytest.mark.parametrize(
    ("text", "offered"),
    [("drive 8 m", "drive 5.35 m"), ("drive 12 m", "drive 5.35 m"), ("turn left 90 deg", "turn left 45 deg")],
)
def test_it_is_offered_as_far_as_it_comes_nearer(text: str, offered: str) -> None:
    plan = planned(fenced("wheeltec_mini_mec", DIAGONALLY_AHEAD), text)
    assert plan.refusal is not None
    assert plan.refusal.code == "outside_area"
    assert plan.refusal.values["outside_m"] == pytest.approx(math.hypot(5.0, 5.0) + 0.17 - 1.0, abs=0.02)
    assert plan.possible == offered


def test_a_turn_that_swings_no_corner_farther_out_is_driven() -> None:
    """Its footprint is all but a circle: on the spot it turns however far."""
    profile = fenced("turtlebot4", DIAGONALLY_AHEAD)
    assert planned(profile, "turn left 360 deg").ok
    assert drives(profile, "turn left 360 deg")


def test_what_comes_back_is_driven_and_told_that_it_stands_outside() -> None:
    shown = planned(fenced("wheeltec_mini_mec", BEHIND), "drive 1 m back").shown
    assert shown is not None
    assert [(found.severity, found.reason.code) for found in shown.findings] == [("note", "stands_outside")]


def test_at_the_edge_and_inside_nothing_is_told() -> None:
    for fence in (Circle(0.0, 0.0, 1.0), ((-1.0, -1.0), (0.158, -1.0), (0.158, 1.0), (-1.0, 1.0))):
        shown = planned(fenced("wheeltec_mini_mec", fence), "drive 0.5 m back").shown
        assert shown is not None
        assert not shown.findings


def test_what_leaves_on_the_other_side_is_refused_at_that_edge() -> None:
    plan = planned(fenced("wheeltec_mini_mec", AHEAD), "drive 5 m")
    assert plan.refusal is not None
    assert plan.refusal.code == "leaves_area"
    assert plan.refusal.values["total_m"] == pytest.approx(3.0 - 0.16, abs=0.05)
    assert plan.shown is not None
    assert [found.reason.code for found in plan.shown.findings] == ["stands_outside", "leaves_area"]


WORDS = {
    "en": ("I stand 6.25 m outside the allowed area", "Shall I drive forward 5.35 m?"),
    "de": ("Ich stehe 6,25 m außerhalb des erlaubten Bereichs", "Soll ich 5,35 m vorwärts fahren?"),
    "zh": ("我在允许的区域之外 6.25 米", "要我向前走 5.35 米吗？"),
}
STOPPED = {
    "en": "I stand 1.14 m outside the allowed area",
    "de": "ich stehe 1,14 m außerhalb des erlaubten Bereichs",
    "zh": "我在允许范围之外 1.14 米",
}
SAID = {"en": "forward 12 m", "de": "fahre 12 m vorwärts", "zh": "往前走 12 米"}


def fenced_file(folder: Path, fence: str = "{x_m = 5, y_m = 5, radius_m = 1}") -> str:
    from chatrobot.robots import load

    text = (Path(load.__file__).parent / "profiles" / "wheeltec_mini_mec.toml").read_text(encoding="utf-8")
    file = folder / "fenced.toml"
    file.write_text(f"{text}\n[safety]\nfence = {fence}\n", encoding="utf-8")
    return str(file)


@pytest.mark.parametrize("language", SAID)
def test_the_reply_says_that_it_stands_outside_and_what_it_may(language: str, tmp_path: Path) -> None:
    connection = connect(Setup(robot=fenced_file(tmp_path), world="empty", fast=True), lambda _event: None)
    session = connection.session
    try:
        turn = session.say(SAID[language])
        while turn not in session.results:
            session.pump(0.1)
    finally:
        connection.close()
    reply = session.results[turn].reply
    assert all(part in reply for part in WORDS[language]), reply


@pytest.mark.parametrize("language", SAID)
def test_the_governor_says_it_too(language: str) -> None:
    rig = Rig(fenced("wheeltec_mini_mec", BEHIND))
    executor = rig.run(parse_plan("drive 1 m"))
    assert executor.reason is not None
    assert (executor.outcome, executor.reason.code) == ("stopped", "outside_fence")
    assert STOPPED[language] in render_reason(executor.reason, language)


class TestPrograms:
    """A world with an area that a program's robot stands outside of, and a profile with a fence."""

    AREA = "allowed_area: [[2, -1], [4, -1], [4, 1], [2, 1]]\n"

    def run(self, body: str, tmp_path: Path, robot: str = "wheeltec_mini_mec") -> tuple[Rehearsed, Result]:
        world = tmp_path / "area.yaml"
        world.write_text(self.AREA)
        events: list[Event] = []
        in_world = str(world) if robot == "wheeltec_mini_mec" else "empty"
        connection = connect(Setup(robot=robot, world=in_world, fast=True, programs=True), events.append)
        session = connection.session
        try:
            assert session.authoring is not None
            turn = session.say_draft(session.authoring.draft_of(KeptProgram("test", program(body))))
            while turn not in session.results:
                session.pump(0.1)
        finally:
            connection.close()
        (rehearsed,) = [event for event in events if isinstance(event, Rehearsed)]
        return rehearsed, session.results[turn]

    @pytest.mark.parametrize(
        ("body", "codes", "outcome"),
        [
            ("self.drive(0.3, 0.0, 8.0)", ["stands_outside"], "completed"),
            ("self.drive(-0.3, 0.0, 2.0)", ["outside_area"], "refused"),
            ("self.drive(0.3, 0.0, 15.0)", ["stands_outside", "leaves_area"], "refused"),
        ],
        ids=["comes in", "goes away", "goes through"],
    )
    def test_it_may_come_in(self, body: str, codes: list[str], outcome: str, tmp_path: Path) -> None:
        rehearsed, result = self.run(body, tmp_path)
        assert [found.reason.code for found in rehearsed.findings] == codes
        assert result.outcome == outcome
        if outcome == "completed":
            assert result.path_m == pytest.approx(rehearsed.length_m, abs=0.02)

    def test_of_the_profiles_fence_it_is_told_too(self, tmp_path: Path) -> None:
        rehearsed, result = self.run("self.drive(0.3, 0.0, 2.0)", tmp_path, fenced_file(tmp_path))
        assert [found.reason.code for found in rehearsed.findings] == ["stands_outside"]
        assert result.outcome == "completed"


def test_an_area_counts_as_a_fence_does(tmp_path: Path) -> None:
    from chatrobot.sim.load import load_world

    world = tmp_path / "area.yaml"
    world.write_text(TestPrograms.AREA)
    corners: tuple[Point, ...] = ((2, -1), (4, -1), (4, 1), (2, 1))
    profile = load_profile("wheeltec_mini_mec")
    for text in ("drive 2 m", "drive 1 m back", "turn left 90 deg", "drive 6 m"):
        by_area = Planner(profile, load_world(str(world))).plan(1, text, ORIGIN)
        by_fence = planned(fenced("wheeltec_mini_mec", corners), text)
        assert (by_area.refusal, by_area.possible) == (by_fence.refusal, by_fence.possible)
