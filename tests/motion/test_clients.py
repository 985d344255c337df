"""A flood of sources nobody has heard of leaves no traces, and takes nothing from whoever drives."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.safety.test_who_drives import Crowd

from chatrobot.governor.lease import Leases
from chatrobot.link.envelope import Envelope
from chatrobot.motion.clients import MANY_SOURCES, MOST_SOURCES, Clients
from chatrobot.motion.goal_queue import GoalQueue
from chatrobot.motion.safety import competing_controllers
from chatrobot.motion.safety.competing_controllers import CompetingControllers
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Text


class Rig:
    """Sources and what is kept of what they said."""

    def __init__(self) -> None:
        self.leases, self.goal_queue, self.engaged = Leases(), GoalQueue(), set[str]()
        self.sources = Clients(self.leases, self.engaged.__contains__, self.goal_queue.forget)

    def say(self, lease: str, word: str, now_s: float, sequence: int = 1) -> None:
        envelope = Envelope(word, "agent", lease, sequence, payload={"term_s": 0.3})  # type: ignore[arg-type]
        if word == "stop":
            self.goal_queue.void_turn(lease, 1)
        self.sources.note(lease, now_s)
        if not self.goal_queue.is_old(envelope):
            self.sources.hear(envelope, now_s)
            if word == "goodbye":
                self.sources.leave(lease)

    @property
    def kept(self) -> int:
        goal_queue, sources = self.goal_queue, self.sources
        return max(
            map(len, (goal_queue._sequences, goal_queue._void_turns, sources._known, sources._leaving))
        )


@pytest.mark.parametrize("word", ["hello", "stop", "goodbye", "look"])
def test_what_is_kept_of_ever_new_sources_is_bounded(word: str) -> None:
    rig = Rig()
    for number in range(5 * MANY_SOURCES):
        rig.say(f"new-{number}", word, number * 0.01)
        if word == "hello" and number % 2:
            rig.sources.lose(f"new-{number}")
    assert rig.kept <= 2 * MANY_SOURCES


def test_in_a_flood_of_sources_that_are_all_there_none_is_opened_beyond_a_limit() -> None:
    rig = Rig()
    for number in range(2 * MOST_SOURCES):
        rig.say(f"new-{number}", "hello", 1.0)
    assert rig.kept <= 2 * MOST_SOURCES
    assert not rig.leases.is_valid(f"new-{2 * MOST_SOURCES - 1}", 1.0)
    rig.say("late", "hello", 2.0)
    assert rig.leases.is_valid("late", 2.0), "those before have fallen silent"


def test_who_drives_or_waits_is_never_forgotten() -> None:
    rig = Rig()
    rig.say("driver", "hello", 0.0, sequence=7)
    rig.say("driver", "goodbye", 0.0, sequence=8)
    rig.engaged.add("driver")
    for number in range(3 * MOST_SOURCES):
        rig.say(f"new-{number}", "hello", 0.0)
    assert rig.leases.is_valid("driver", 1e6), "what is queued is still done"
    assert rig.goal_queue.is_old(Envelope("plan", "agent", "driver", 8))
    assert rig.sources.has_left("driver")


def test_what_comes_late_from_a_source_that_left_and_was_forgotten_moves_nothing() -> None:
    rig = Rig()
    rig.say("gone", "hello", 0.0)
    rig.say("gone", "goodbye", 0.0, sequence=2)
    for number in range(2 * MANY_SOURCES):
        rig.say(f"new-{number}", "hello", number * 0.01)
    assert not rig.sources.has_left("gone")
    rig.say("gone", "plan", 20.0, sequence=1)
    assert not rig.leases.is_valid("gone", 20.0)


def test_a_plan_is_driven_to_its_end_through_a_flood_of_sources(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "agent")
    crowd.say("agent", "plan", 1, plan_text="drive 0.5 m")
    for step in range(60):
        for number in range(MANY_SOURCES // 10):
            flooding = Envelope("hello", "agent", f"flood-{step}-{number}", 1, payload={"term_s": 1.0})
            crowd.motion.receive(flooding)
        crowd.live(0.02)
    crowd.live(2.0)
    assert crowd.end_of(1).outcome == "completed"
    assert len(crowd.motion._clients._known) <= MOST_SOURCES


def test_of_a_flood_of_rivals_the_last_heard_are_kept_and_one_that_beats_is_seen() -> None:
    others = CompetingControllers(MemoryHub().connect(), "ours", "cmd_vel")
    for number in range(10 * competing_controllers.MANY_MOTIONS):
        for name in (f"flood-{number}", "rival"):
            beat = {"id": name, "node": name, "host": "far", "pid": 1}
            others._hear(Text(json.dumps(beat)))
    assert len(others._heard) == competing_controllers.MANY_MOTIONS
    assert "rival (process 1 on far)" in others.motions()
