"""A person's session and an agent's on one robot, on simulated and in real time: two lines, one Motion."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.link.leaving import abandon

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.errors import LinkError, UsageError
from chatrobot.core.events import Event, Finished, Notice, Ordered, Rehearsed, Started, Telemetry
from chatrobot.dialogue.options import Options
from chatrobot.link.motion_link import TURNS

PATIENCE = 400
AT_ONCE, ASKS = Options(), Options(approve=True)


def unheard(_event: Event) -> None:
    """Nobody listens."""


class Pair:
    """A person and an agent, pumped in turns in this thread, and what each of them hears."""

    def __init__(self, *, fast: bool, options: Options) -> None:
        self.heard: list[Event] = []
        self.heard_by_agent: list[Event] = []
        self.connection: Connection = connect(
            Setup(world="empty", fast=fast, options=options), self.heard.append
        )
        self.person = self.connection.session
        self.agent = self.connection.second_session("agent", self.heard_by_agent.append).session

    def until(self, wanted: Callable[[], object]) -> None:
        for _ in range(PATIENCE):
            if wanted():
                return
            self.person.pump(0.02)
            self.agent.pump(0.02)
        raise AssertionError(f"it did not come; the person heard {self.told(self.heard)[-8:]}")

    def until_agent_has(self, turn: int) -> None:
        self.until(lambda: turn in self.agent.results)

    def wait(self, periods: int) -> None:
        for _ in range(periods):
            self.person.pump(0.02)
            self.agent.pump(0.02)

    @staticmethod
    def told(events: list[Event]) -> list[Event]:
        return [event for event in events if not isinstance(event, Telemetry) and event.name != "progress"]

    def moves(self) -> bool:
        telemetry = [event for event in self.heard if isinstance(event, Telemetry)]
        return bool(telemetry) and telemetry[-1].twist.speed_mps > 0.1

    def close(self) -> None:
        with contextlib.suppress(LinkError):
            self.person.stop("test")
        self.connection.close()


@pytest.fixture(params=[True, pytest.param(False, marks=pytest.mark.realtime)], ids=["simulated", "process"])
def make(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., Pair]]:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    made: list[Pair] = []

    def build(options: Options = AT_ONCE) -> Pair:
        made.append(Pair(fast=request.param, options=options))
        return made[-1]

    yield build
    for pair in made:
        pair.close()


def of_kind(events: list[Event], kind: type[Event]) -> list[Event]:
    return [event for event in events if isinstance(event, kind)]


def notices(events: list[Event]) -> list[str]:
    return [event.reason.code for event in events if isinstance(event, Notice)]


def test_the_person_sees_the_agents_plan_and_says_yes(make: Callable[..., Pair]) -> None:
    pair = make(ASKS)
    turn = pair.agent.say("forward 0.2 m")
    pair.until(lambda: of_kind(pair.heard, Rehearsed))
    (ordered,), (rehearsed,) = of_kind(pair.heard, Ordered), of_kind(pair.heard, Rehearsed)
    assert isinstance(ordered, Ordered)
    assert (ordered.source, ordered.plan_text) == ("agent", "drive 0.2 m")
    assert isinstance(rehearsed, Rehearsed)
    assert rehearsed.needs_approval
    assert rehearsed.turn == ordered.turn == TURNS + turn
    pair.wait(20)
    assert not of_kind(pair.heard, Started)
    pair.person.approve(rehearsed.turn, True)
    pair.until(lambda: turn in pair.agent.results)
    assert pair.agent.results[turn].outcome == "completed"
    assert pair.agent.results[turn].path_m == pytest.approx(0.2, abs=0.02)


def test_an_agent_approves_nothing_and_releases_nothing(make: Callable[..., Pair]) -> None:
    pair = make(ASKS)
    turn = pair.agent.say("forward 0.2 m")
    pair.until(lambda: of_kind(pair.heard_by_agent, Rehearsed))
    pair.agent.approve(turn, True)
    own = pair.person.say("forward 0.3 m")
    pair.until(lambda: turn in pair.agent.results)
    pair.agent.approve(own, True)
    pair.wait(20)
    assert not of_kind(pair.heard, Started)
    pair.agent.emergency_stop("test")
    pair.agent.release()
    pair.until(lambda: "release_refused" in notices(pair.heard))
    pair.wait(10)
    assert "released" not in notices(pair.heard)


def test_what_asks_for_a_yes_asks_whatever_the_agents_options_say() -> None:
    heard: list[Event] = []
    connection = connect(Setup(world="empty", fast=True, options=ASKS), heard.append)
    agent = connection.second_session("agent", unheard, Options(approve=False)).session
    agent.say("forward 0.2 m")
    for _ in range(20):
        agent.pump(0.02)
    assert not of_kind(heard, Started)
    connection.close()


def test_turns_of_the_same_number_are_not_mistaken(make: Callable[..., Pair]) -> None:
    pair = make()
    first, other = pair.agent.say("forward 0.1 m"), pair.person.say("turn left 20 degrees")
    assert first == other == 1
    pair.until(lambda: 1 in pair.agent.results and 1 in pair.person.results)
    assert pair.person.results[1].outcome == "completed"
    assert pair.person.results[1].turned_rad == pytest.approx(0.35, abs=0.02)
    assert pair.agent.results[1].outcome in ("stopped", "refused")
    again = pair.agent.say("forward 0.1 m")
    pair.until(lambda: again in pair.agent.results)
    assert pair.agent.results[again].path_m == pytest.approx(0.1, abs=0.02)
    assert len(pair.person.results) == 1


def test_a_person_takes_over_and_the_agent_is_told(make: Callable[..., Pair]) -> None:
    pair = make()
    turn = pair.agent.say("forward 5 m")
    pair.until(pair.moves)
    pair.person.say("turn left 10 degrees")
    pair.until(lambda: turn in pair.agent.results)
    reason = pair.agent.results[turn].reason
    assert reason is not None
    assert (reason.code, reason.values) == ("handed_over", {"source": "agent", "to": "console"})
    assert notices(pair.heard_by_agent) == ["handed_over"]
    assert [event.turn for event in of_kind(pair.heard_by_agent, Notice)] == [0]


def test_an_agent_hears_nothing_of_a_persons_turns_but_where_the_robot_is(make: Callable[..., Pair]) -> None:
    pair = make()
    turn = pair.person.say("forward 0.1 m")
    pair.until(lambda: turn in pair.person.results)
    pair.wait(10)
    assert pair.told(pair.heard_by_agent) == []
    telemetry = of_kind(pair.heard_by_agent, Telemetry)
    assert telemetry
    assert {event.turn for event in telemetry} == {0}


def test_each_may_stop_and_a_stop_ends_what_the_agent_does(make: Callable[..., Pair]) -> None:
    pair = make()
    for stopper in (pair.person, pair.agent):
        turn = pair.agent.say("forward 5 m")
        pair.until(pair.moves)
        stopper.stop("test")
        pair.until_agent_has(turn)
        assert pair.agent.results[turn].outcome == "stopped"


def test_an_agent_that_is_lost_while_it_drives_stops_the_robot_alone(make: Callable[..., Pair]) -> None:
    pair = make()
    pair.agent.say("forward 5 m")
    pair.until(pair.moves)
    abandon(pair.agent._link)
    finished = []
    for _ in range(PATIENCE):
        pair.person.pump(0.02)
        finished = of_kind(pair.heard, Finished)
        if finished:
            break
    (end,) = finished
    assert isinstance(end, Finished)
    assert (end.outcome, end.reason and end.reason.code) == ("stopped", "source_lost")
    assert pair.person.do("forward 0.1 m").outcome == "completed"


def test_an_agent_that_is_lost_stops_nothing_of_a_persons(make: Callable[..., Pair]) -> None:
    pair = make()
    turn = pair.person.say("forward 1 m")
    pair.until(pair.moves)
    abandon(pair.agent._link)
    assert pair.person.see_through(turn).outcome == "completed"


def test_a_question_of_an_agent_that_is_lost_is_over(make: Callable[..., Pair]) -> None:
    pair = make(ASKS)
    pair.agent.say("forward 0.2 m")
    pair.until(lambda: of_kind(pair.heard, Rehearsed))
    abandon(pair.agent._link)
    for _ in range(PATIENCE):
        pair.person.pump(0.02)
        if of_kind(pair.heard, Finished):
            break
    pair.person.approve(TURNS + 1, True)
    for _ in range(20):
        pair.person.pump(0.02)
    assert not of_kind(pair.heard, Started)


def test_an_agents_session_that_is_closed_leaves_the_person_theirs(make: Callable[..., Pair]) -> None:
    pair = make()
    pair.agent.close()
    assert pair.person.do("forward 0.1 m").outcome == "completed"
    with pytest.raises(LinkError, match="second line is taken"):
        pair.connection.second_session("agent", unheard)


@pytest.mark.parametrize("source", ["console", "web", "base", "program", "joystick", "stick"])
def test_no_second_session_speaks_as_a_person(source: str) -> None:
    connection = connect(Setup(world="empty", fast=True), unheard)
    with pytest.raises(UsageError, match="speaks for an agent"):
        connection.second_session(source, unheard)
    connection.close()
