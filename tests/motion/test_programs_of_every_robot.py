"""The rehearsal of a program says what every built-in robot then does, however long its base holds a velocity."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import pytest
from tests.programs.scripted_model import program

from chatrobot.compose import Setup, connect
from chatrobot.core.event import Event
from chatrobot.core.events import Rehearsed, Result, TruePose
from chatrobot.programs.library import KeptProgram
from chatrobot.robots.load import list_profiles, load_profile
from chatrobot.robots.profile import MotionBudget

ROBOTS = [entry.name for entry in list_profiles()]
MEASURED = [robot for robot in ROBOTS if load_profile(robot).has_odometry]
"""The others know no place in a world, so there are no walls for them."""
DRIVES_S = 6.0
"""Longer than any base holds a velocity that is not said again; and what open loop allows."""
AGAIN_AND_AGAIN = """\
for _ in range({ticks}):
    self.drive({speed_mps}, {rate_radps}, 0.1)"""
ONCE = "self.drive({speed_mps}, {rate_radps}, {seconds})"


def speed_of(robot: str) -> float:
    return load_profile(robot).defaults.speed_mps


def written(robot: str, way: str, rate_radps: float = 0.0) -> str:
    body = way.format(
        ticks=round(DRIVES_S / 0.1), seconds=DRIVES_S, speed_mps=speed_of(robot), rate_radps=rate_radps
    )
    return program(body).replace("/cmd_vel", f"/{load_profile(robot).wiring.cmd_vel_topic}")


class Run:
    """One program from its rehearsal to its end, on simulated time."""

    def __init__(self, robot: str, code: str, world: str = "empty", **limits: float) -> None:
        self.events: list[Event] = []
        open_loop = not load_profile(robot).has_odometry
        setup = Setup(
            robot=robot, world=world, fast=True, trace=True, programs=True, open_loop=open_loop,
            budget=MotionBudget(**limits),
        )  # fmt: skip
        connection = connect(setup, self.events.append)
        try:
            session = connection.session
            assert session.authoring is not None
            turn = session.say_draft(session.authoring.draft_of(KeptProgram("test", code)))
            while turn not in session.results:
                session.pump(0.1)
            self.result: Result = session.results[turn]
        finally:
            connection.close()
        (self.rehearsed,) = [event for event in self.events if isinstance(event, Rehearsed)]

    @property
    def driven_m(self) -> float:
        """By the truth: one of the robots measures nothing."""
        poses = [event for event in self.events if isinstance(event, TruePose)]
        return sum(math.hypot(b.x_m - a.x_m, b.y_m - a.y_m) for a, b in itertools.pairwise(poses))


@pytest.mark.parametrize("rate_radps", [0.0, 0.2])
@pytest.mark.parametrize("way", [AGAIN_AND_AGAIN, ONCE], ids=["again and again", "once"])
@pytest.mark.parametrize("robot", ROBOTS)
def test_a_program_is_rehearsed_as_far_as_it_drives(robot: str, way: str, rate_radps: float) -> None:
    run = Run(robot, written(robot, way, rate_radps))
    assert run.result.outcome == "completed"
    assert run.rehearsed.length_m == pytest.approx(run.driven_m, rel=0.02, abs=0.02)
    if robot in MEASURED:
        assert run.result.path_m == pytest.approx(run.driven_m, rel=0.02, abs=0.02)
    holds_s = load_profile(robot).wiring.base_timeout_s if way == ONCE else None
    assert run.driven_m == pytest.approx(speed_of(robot) * min(DRIVES_S, holds_s or DRIVES_S), rel=0.1)


@pytest.mark.parametrize("robot", MEASURED)
def test_a_wall_in_the_way_of_a_program_is_found_before_it_drives(robot: str, tmp_path: Path) -> None:
    wall_m = 0.6 * speed_of(robot) * DRIVES_S + load_profile(robot).footprint_radius_m
    file = tmp_path / "walled.yaml"
    file.write_text(
        f"obstacles: [{{name: wall, rectangle: {{x_m: {wall_m + 0.05}, y_m: 0, length_m: 0.1, width_m: 4}}}}]\n"
    )
    run = Run(robot, written(robot, AGAIN_AND_AGAIN), str(file))
    assert {found.reason.code for found in run.rehearsed.findings} == {"would_collide"}
    assert (run.result.outcome, run.driven_m) == ("refused", 0.0)


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_program_that_would_drive_farther_than_its_budget_is_refused(robot: str) -> None:
    run = Run(robot, written(robot, AGAIN_AND_AGAIN), max_distance_m=0.6 * speed_of(robot) * DRIVES_S)
    assert run.result.reason is not None
    assert (run.result.outcome, run.result.reason.code) == ("refused", "over_max_distance")
    assert run.driven_m == 0.0
