"""Beside eight processes that keep both cores busy what is asked for is done, and who dies or freezes stops the robot.

Two robots with their nodes at once, and short motions, so that 32 take ten seconds; `make busy` drives
two hundred, for a second each. Where a process gets no turn for too long, the robot is stopped and that is said;
such a line is driven again.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.nodes.busy import (
    FOUR_AT_ONCE,
    SHORT_LINES,
    TUTORIAL_LINES,
    busy_processes,
    drive_lines,
    freeze,
    kill,
)
from tests.nodes.node_rig import NodeRig

pytestmark = [pytest.mark.realtime, pytest.mark.alone]

SETS, MOTIONS = 2, 32
LINES = [*TUTORIAL_LINES[:4], *SHORT_LINES, *itertools.repeat(FOUR_AT_ONCE, 2)]
PROMISE_S = 0.25
FROZEN = ("base", "input", "control")
KILLED = ("base", "control")
"""One of each set; `make busy` and `make faults` strike the others, too."""


@pytest.fixture(scope="module")
def rigs(tmp_path_factory: pytest.TempPathFactory) -> Iterator[list[NodeRig]]:
    made: list[NodeRig] = []
    with ThreadPoolExecutor(SETS) as pool:
        try:
            for rig in pool.map(NodeRig, [tmp_path_factory.mktemp(f"set{count}") for count in range(SETS)]):
                made.append(rig)
            with busy_processes():
                yield made
        finally:
            list(pool.map(NodeRig.close, made))


def test_of_32_motions_none_ends_early_unsaid_and_none_reverses(rigs: list[NodeRig]) -> None:
    with ThreadPoolExecutor(SETS) as pool:
        driven = [one for of_one in pool.map(lambda rig: drive_lines(rig, LINES), rigs) for one in of_one]
    late = [one.late_s for one in driven if one.late_s]
    halted = sum(one.is_halted for one in driven)
    print(
        f"{len(late)} of {len(driven)} texts slowed by a late heartbeat, at most {max(late, default=0.0):.2f} s; "
        f"{halted} halted"
    )
    assert [str(one) for one in driven if one.problems] == []
    assert sum(len(one.line.twists) for one in driven if not one.is_halted) == MOTIONS


def test_whoever_freezes_or_dies_stops_the_robot_in_time_and_no_thaw_resumes_it(rigs: list[NodeRig]) -> None:
    def strike(rig: NodeRig, killed: str) -> dict[str, float]:
        took_s = {f"freeze of {whom}": freeze(rig, whom) for whom in FROZEN}
        return {**took_s, f"kill of {killed}": kill(rig, killed)}

    with ThreadPoolExecutor(SETS) as pool:
        blows = [blow for took_s in pool.map(strike, rigs, KILLED) for blow in took_s.items()]
    print(", ".join(f"{blow} {took_s * 1e3:.0f} ms" for blow, took_s in blows))
    assert [(blow, took_s) for blow, took_s in blows if took_s > PROMISE_S] == []
