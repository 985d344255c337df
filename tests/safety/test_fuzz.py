"""Two thousand sequences of `make fuzz`, and the same promises kept in front of a state machine that shrinks."""

from __future__ import annotations

import random

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule
from scripts import fuzz

from chatrobot.core.geometry import Twist

SEQUENCES = 1_000
CHUNKS = 2


@pytest.mark.slow
@pytest.mark.parametrize("chunk", range(CHUNKS))
def test_no_sequence_of_commands_breaks_a_promise(chunk: int) -> None:
    assert fuzz.run_chunk(chunk, SEQUENCES // CHUNKS) == ""


def test_the_fuzzer_drives_every_profile_with_and_without_all_rules() -> None:
    robots = fuzz.profiles()
    assert {robot.name for robot in robots if robot.safety.fence is None} == {robot.name for robot in robots}
    assert {robot.name for robot in robots if robot.safety.fence is not None} == {
        robot.name for robot in robots
    }


def test_the_fuzzer_notices_a_governor_that_lets_through_what_was_asked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("chatrobot.governor.governor.make_kernel", lambda _: lambda _sent, asked, _dt: asked)
    assert fuzz.run_chunk(0, 50) != ""


def test_the_fuzzer_notices_a_robot_that_is_fast_in_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("chatrobot.governor.space_rules.AWAY_MPS", 0.3)
    assert fuzz.run_chunk(0, 200) != ""


def test_the_fuzzer_notices_a_robot_that_comes_nearer_in_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("chatrobot.governor.space_rules.NEARER_M", 0.5)
    assert fuzz.run_chunk(0, 200) != ""


speeds = st.floats(allow_nan=True, allow_infinity=True) | st.floats(-3.0, 3.0)
sources = st.integers(0, len(fuzz.SOURCES) - 1)


class GovernorMachine(RuleBasedStateMachine):
    """The fuzzer's own model, driven by hypothesis, which finds the shortest way to break a promise."""

    @initialize(number=st.integers(0, len(fuzz.profiles()) - 1), seed=st.integers(0, 9))
    def build(self, number: int, seed: int) -> None:
        self.sequence = fuzz.Sequence(fuzz.profiles()[number], random.Random(seed))

    @rule(number=sources)
    def a_source_says_hello(self, number: int) -> None:
        self.sequence.open(self.sequence.sources[number])

    @rule(number=sources)
    def a_motion_begins(self, number: int) -> None:
        self.sequence.begin(self.sequence.sources[number])

    @rule(number=sources, vx=speeds, vy=speeds, wz=speeds)
    def a_source_asks_and_beats(self, number: int, vx: float, vy: float, wz: float) -> None:
        source = self.sequence.sources[number]
        self.sequence.beat(source)
        self.sequence.ask(source, Twist(vx, vy, wz))

    @rule(number=sources, vx=speeds)
    def a_source_asks_without_a_beat(self, number: int, vx: float) -> None:
        self.sequence.ask(self.sequence.sources[number], Twist(vx, 0.0, 0.0))

    @rule(number=sources)
    def a_source_ends(self, number: int) -> None:
        self.sequence.end(self.sequence.sources[number])

    @rule(duration_s=st.sampled_from([0.02, 0.02, 0.02, 0.1, 0.31, 5.0, -0.01, -1.0]))
    def time_passes(self, duration_s: float) -> None:
        self.sequence.now_s += duration_s

    @rule()
    def somebody_stops(self) -> None:
        self.sequence.stop()

    @rule()
    def an_emergency_stop(self) -> None:
        self.sequence.latch()

    @rule()
    def a_release(self) -> None:
        self.sequence.release()

    @rule()
    def a_scan_comes(self) -> None:
        self.sequence.scan()

    @rule()
    def limits_shrink(self) -> None:
        self.sequence.narrow()

    @rule()
    def a_thread_that_slept_sends(self) -> None:
        self.sequence.send_late()


TestGovernorMachine = GovernorMachine.TestCase
TestGovernorMachine.settings = settings(max_examples=60, stateful_step_count=50, deadline=None)
