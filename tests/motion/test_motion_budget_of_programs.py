"""A program drives at most its motion budget; one whose rehearsal did not end runs for a minute."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.programs.scripted_model import program

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.events import Event, Notice, Progress, Rehearsed, Result, TruePose
from chatrobot.programs.library import KeptProgram
from chatrobot.robots.profile import MotionBudget

CIRCLES = program("while True:\n    self.drive(0.4, 0.5, 0.1)")
TWO_METRES = program("self.drive(0.4, 0.0, 5.0)")


class Runner:
    """Runs programs on simulated time, under a budget that each test chooses."""

    def __init__(self, folder: Path) -> None:
        self.events: list[Event] = []
        self.connection: Connection = connect(
            Setup(fast=True, trace=True, world="empty", folder=folder, programs=True), self.events.append
        )
        self.session = self.connection.session

    def run(self, code: str, **limits: float | str) -> Result:
        self.session._link._motion._budgets.current = MotionBudget()  # type: ignore[attr-defined]
        if limits:
            self.session.limit(**limits)
        self.session.pump(0.1)
        self.events.clear()
        assert self.session.authoring is not None
        turn = self.session.say_draft(self.session.authoring.draft_of(KeptProgram("test", code)))
        while turn not in self.session.results:
            self.session.pump(0.1)
        return self.session.results[turn]

    def codes(self) -> list[str]:
        return [event.reason.code for event in self.events if isinstance(event, Notice)]


@pytest.fixture(scope="module")
def runner(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Runner]:
    made = Runner(tmp_path_factory.mktemp("config"))
    yield made
    made.connection.close()


def test_a_program_without_an_end_runs_for_a_minute_and_that_is_said_before_and_after(runner: Runner) -> None:
    result = runner.run(CIRCLES)
    assert runner.codes() == ["endless_program_limit"]
    assert result.outcome == "stopped"
    assert result.reason is not None
    assert (result.reason.code, result.reason.values) == ("endless_program_stopped", {"max_s": 60.0})
    assert 58.0 <= result.duration_s <= 60.1
    assert "--max-time" in result.reply


@pytest.mark.parametrize(("max_time_s", "least_s", "most_s"), [(5.0, 4.0, 5.1), (90.0, 88.0, 90.1)])
def test_a_time_that_somebody_chose_holds_for_it(
    runner: Runner, max_time_s: float, least_s: float, most_s: float
) -> None:
    assert least_s <= runner.run(CIRCLES, max_time_s=max_time_s).duration_s <= most_s


def test_without_a_limit_of_time_it_drives_as_far_as_it_may(runner: Runner) -> None:
    result = runner.run(CIRCLES, max_time_s="none", max_distance_m=40.0)
    assert result.reason is not None
    assert result.reason.code == "max_distance_reached"
    assert 39.8 <= result.path_m <= 40.0


def test_it_is_brought_to_stand_by_braking(runner: Runner) -> None:
    runner.run(CIRCLES, max_time_s=5.0)
    speeds = [event.vx_mps for event in runner.events if isinstance(event, TruePose)]
    limits = runner.connection.profile.limits
    slowest_ramp = max(before - after for before, after in itertools.pairwise(speeds))
    assert slowest_ramp <= limits.acceleration_mps2 * 0.02 + 1e-6


def test_a_program_with_an_end_has_the_budget_of_a_text(runner: Runner) -> None:
    assert runner.run(TWO_METRES).outcome == "completed"
    refused = runner.run(TWO_METRES, max_distance_m=1.5)
    assert refused.reason is not None
    assert (refused.outcome, refused.reason.code) == ("refused", "over_max_distance")


def test_a_program_without_an_end_has_no_total_and_no_percentage(runner: Runner) -> None:
    result = runner.run(CIRCLES, max_time_s=20.0)
    assert result.reply.split("So far: ")[1].startswith(f"drove {result.path_m:.2f} m, turned")
    assert {event.fraction for event in runner.events if isinstance(event, Progress)} == {None}
    assert [event.open_ended for event in runner.events if isinstance(event, Rehearsed)] == [True]


def test_a_program_that_ends_by_itself_after_more_than_a_minute_is_not_cut(runner: Runner) -> None:
    result = runner.run(program("self.drive(0.3, 0.0, 90.0)"))
    assert (result.outcome, runner.codes()) == ("completed", [])
    assert "of 27.00 m" in result.reply
    refused = runner.run(program("self.drive(0.3, 0.0, 90.0)"), max_time_s=70.0)
    assert refused.reason is not None
    assert refused.reason.code == "over_max_time"


def test_a_program_with_an_end_has_both(runner: Runner) -> None:
    assert f"of {2.0:.2f} m" in runner.run(TWO_METRES).reply
    assert None not in {event.fraction for event in runner.events if isinstance(event, Progress)}
