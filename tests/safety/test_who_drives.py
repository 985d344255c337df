"""Between sources Motion hands over in the open; what only a person may do nobody else can."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from chatrobot.core.events import Event, Finished, Notice
from chatrobot.governor.lease import RELEASERS
from chatrobot.link.envelope import Envelope
from chatrobot.link.in_process import InProcessLink
from chatrobot.link.motion_link import Sender
from tests.link.link_rigs import SimulatedRig


class Crowd:
    """Several sources at one Motion, each with a lease of its own that it keeps."""

    def __init__(self, folder: Path, *sources: str, releasers: frozenset[str] = RELEASERS) -> None:
        self.rig = SimulatedRig(folder, releasers)
        link = self.rig.link
        assert isinstance(link, InProcessLink)
        self._link, self.motion = link, link._motion
        self._senders = {source: Sender(source) for source in sources}
        self.events: list[Event] = []
        for source in sources:
            self.say(source, "hello")

    def say(self, source: str, word: Any, turn: int = 0, **payload: Any) -> None:
        envelope = self._senders[source].envelope(word, turn, **payload)
        received = Envelope.from_bytes(envelope.to_bytes())
        assert received is not None
        self.motion.receive(received)

    def live(self, duration_s: float) -> None:
        for _ in range(round(duration_s / 0.02)):
            for source in self._senders:
                self.say(source, "beat")
            self._link.step()
        while (event := self._link.next_event(0.0)) is not None:
            self.events.append(event)

    def end_of(self, turn: int) -> Finished:
        (end,) = [event for event in self.events if isinstance(event, Finished) and event.turn == turn]
        return end

    def notices(self) -> list[str]:
        return [event.reason.code for event in self.events if isinstance(event, Notice)]

    @property
    def is_moving(self) -> bool:
        return not self.rig.robot.true_twist.is_zero


ORDER = ["chatgpt_node", "agent", "console", "joystick"]


@pytest.mark.parametrize("low", range(3))
def test_a_higher_source_takes_over_and_everybody_hears_of_it(tmp_path: Path, low: int) -> None:
    lower, higher = ORDER[low], ORDER[low + 1]
    crowd = Crowd(tmp_path, lower, higher)
    crowd.say(lower, "plan", 1, plan_text="drive 5 m", mode="queue")
    crowd.live(1.0)
    assert crowd.is_moving
    crowd.say(higher, "plan", 2, plan_text="turn left 30 deg", mode="queue")
    crowd.live(4.0)
    ended = crowd.end_of(1)
    assert ended.outcome == "stopped"
    assert ended.reason is not None
    assert (ended.reason.code, ended.reason.values) == ("handed_over", {"source": lower, "to": higher})
    assert crowd.notices() == ["handed_over"]
    assert crowd.end_of(2).outcome == "completed"


@pytest.mark.parametrize("mode", ["queue", "replace", "append"])
@pytest.mark.parametrize("low", range(3))
def test_a_lower_source_is_refused_while_a_higher_one_drives(tmp_path: Path, low: int, mode: str) -> None:
    lower, higher = ORDER[low], ORDER[low + 1]
    crowd = Crowd(tmp_path, lower, higher)
    crowd.say(higher, "plan", 1, plan_text="drive 0.5 m", mode="queue")
    crowd.live(0.5)
    crowd.say(lower, "plan", 2, plan_text="turn left 90 deg", mode=mode)
    crowd.live(4.0)
    refused = crowd.end_of(2)
    assert refused.outcome == "refused"
    assert refused.reason is not None
    assert (refused.reason.code, refused.reason.values) == ("outranked", {"source": higher})
    assert crowd.end_of(1).outcome == "completed"
    crowd.say(lower, "plan", 3, plan_text="turn left 10 deg", mode=mode)
    crowd.live(3.0)
    assert crowd.end_of(3).outcome == "completed"


def test_equals_queue_up(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console", "program")
    crowd.say("console", "plan", 1, plan_text="drive 0.2 m", mode="queue")
    crowd.say("program", "plan", 2, plan_text="drive 0.2 m", mode="queue")
    crowd.live(5.0)
    assert [crowd.end_of(turn).outcome for turn in (1, 2)] == ["completed", "completed"]


@pytest.mark.parametrize("source", ORDER)
def test_anybody_may_stop_whoever_drives(tmp_path: Path, source: str) -> None:
    crowd = Crowd(tmp_path, "console" if source != "console" else "program", source)
    crowd.say(
        source if source == "joystick" else next(iter(crowd._senders)), "plan", 1, plan_text="drive 5 m"
    )
    crowd.live(1.0)
    assert crowd.is_moving
    crowd.say(source, "stop", 0)
    assert not any(crowd.rig.velocities[-1]), "the zero is out before `receive` returns"
    crowd.live(1.5)
    assert crowd.end_of(1).outcome == "stopped"
    assert not crowd.is_moving


@pytest.mark.parametrize("source", ["agent", "chatgpt_node", "joystick", "mcp", "whoever"])
def test_only_the_console_releases_an_emergency_stop(tmp_path: Path, source: str) -> None:
    crowd = Crowd(tmp_path, "console", source)
    crowd.say(source, "emergency_stop", why="test")
    crowd.say(source, "release")
    crowd.live(0.1)
    assert crowd.notices() == ["release_refused"]
    crowd.say("console", "plan", 1, plan_text="drive 1 m")
    crowd.live(0.5)
    assert crowd.end_of(1).outcome == "refused"
    crowd.say("console", "release")
    crowd.say("console", "plan", 2, plan_text="drive 0.1 m")
    crowd.live(2.0)
    assert crowd.end_of(2).outcome == "completed"
    crowd.say("console", "release")
    crowd.live(0.1)
    assert crowd.notices()[1:] == ["released", "none_to_release"]


def test_the_base_node_releases_an_emergency_stop_only_where_control_was_told_so(tmp_path: Path) -> None:
    for releasers, code, outcome in (
        (RELEASERS, "release_refused", "refused"),
        (RELEASERS | {"base"}, "released", "completed"),
    ):
        crowd = Crowd(tmp_path, "base", releasers=releasers)
        crowd.say("base", "emergency_stop", why="test")
        crowd.say("base", "release")
        crowd.live(0.1)
        assert crowd.notices() == [code]
        crowd.say("base", "plan", 1, plan_text="drive 0.1 m")
        crowd.live(2.0)
        assert crowd.end_of(1).outcome == outcome


@pytest.mark.parametrize("source", ["agent", "mcp", "chatgpt_node", "whoever"])
def test_an_agent_cannot_approve_what_a_person_was_asked(tmp_path: Path, source: str) -> None:
    crowd = Crowd(tmp_path, "console", source)
    crowd.say(source, "plan", 1, plan_text="drive 0.2 m", approve=True)
    crowd.live(0.2)
    crowd.say(source, "approve", 1, yes=True)
    crowd.live(1.0)
    assert not any(any(velocity) for velocity in crowd.rig.velocities)
    crowd.say("console", "approve", 1, yes=True)
    crowd.live(3.0)
    assert crowd.end_of(1).outcome == "completed"
