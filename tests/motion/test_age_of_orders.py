"""The process that serves a page beats on while its person is gone: Motion goes by how long ago the page was heard."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.events import Event, Telemetry


class Page:
    """A page that is heard, or is not; and a session whose orders come from it."""

    def __init__(self, *, fast: bool) -> None:
        self.age_s = 0.0
        self.heard: list[Event] = []
        self.connection: Connection = connect(
            Setup(world="empty", fast=fast, age_s=lambda: self.age_s), self.heard.append
        )
        self.session = self.connection.session

    @property
    def speed_mps(self) -> float:
        told = [event for event in self.heard if isinstance(event, Telemetry)]
        return told[-1].twist.speed_mps if told else 0.0

    def until(self, wanted: Callable[[], object]) -> None:
        for _ in range(400):
            if wanted():
                return
            self.session.pump(0.02)
        raise AssertionError("it did not come")


@pytest.fixture(params=[True, pytest.param(False, marks=pytest.mark.realtime)], ids=["simulated", "process"])
def page(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Page]:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    made = Page(fast=request.param)
    yield made
    made.session.stop("test")
    made.connection.close()


def test_a_page_that_is_silent_stops_what_it_ordered(page: Page) -> None:
    turn = page.session.say("forward 10 m")
    page.until(lambda: page.speed_mps > 0.2)
    page.age_s = 5.0
    result = page.session.see_through(turn)
    assert result.outcome in ("stopped", "failed")
    assert result.reason is not None
    assert result.reason.code in ("lease_lapsed", "beat_late")
    page.age_s = 0.0
    assert page.session.do("forward 0.1 m").outcome == "completed", "told anew, it goes on"


def test_a_page_that_is_late_slows_the_robot_and_no_more(page: Page) -> None:
    turn = page.session.say("forward 2 m at 0.4 m/s")
    page.until(lambda: page.speed_mps > 0.35)
    page.age_s = 0.14
    page.until(lambda: page.speed_mps < 0.34)
    page.age_s = 0.0
    assert page.session.see_through(turn).outcome == "completed"


def test_with_no_page_at_all_nothing_is_limited_while_nothing_moves(page: Page) -> None:
    page.age_s = 1e6
    for _ in range(20):
        page.session.pump(0.02)
    page.age_s = 0.0
    assert page.session.do("forward 0.1 m").outcome == "completed"


def test_what_a_page_that_is_gone_had_asked_for_does_not_set_out(page: Page) -> None:
    page.age_s = 1e6
    result = page.session.do("forward 0.1 m")
    assert result.outcome in ("refused", "stopped", "failed")
    assert result.path_m == pytest.approx(0.0, abs=0.005)
