"""The programs of tests/programs do under real rclpy what they are expected to do, and so what they do in the box.

`tests/programs/test_programs.py` holds the box to the same expectations. Programs that need a robot's answers are left
to it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "programs"))
sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.programs.expectations import Expected, Phase, all_programs, is_alike, phases_of

from chatrobot.core.geometry import Twist

RECORDER = Path(__file__).with_name("record_program.py")
ELSEWHERE = {"box", "humble" if os.environ.get("ROS_DISTRO") != "humble" else ""}
"""Jazzy takes an int in a float field, and then sends nonsense or dies."""
PROGRAMS = [each for each in all_programs() if each.robot is None and each.only not in ELSEWHERE - {""}]
LIMIT_S = 50.0
ENDLESS_S = 4.0
LATE_S = 0.3
"""Real time comes late, on a busy machine more so; a phase of seconds is still that phase."""
LATE_SHARE = 0.03
AT_ONCE = 3


def record(expected: Expected, folder: Path) -> dict[str, Any]:
    result = folder / f"{expected.name}.json"
    program = folder / f"{expected.name}.py"
    program.write_text(expected.source, encoding="utf-8")
    limit_s = ENDLESS_S if expected.ends in ("horizon", "stuck") else LIMIT_S
    environment = {**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    subprocess.run(
        [sys.executable, str(RECORDER), str(program), str(result), str(limit_s)],
        env=environment,
        timeout=LIMIT_S + 30.0,
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    return dict(json.loads(result.read_text(encoding="utf-8")))


@pytest.fixture(scope="session")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Future[dict[str, Any]]]:
    """All programs run, some at once: most of their time is waiting."""
    folder = tmp_path_factory.mktemp("programs")
    pool = ThreadPoolExecutor(AT_ONCE)
    return {expected.name: pool.submit(record, expected, folder) for expected in PROGRAMS}


def ends_alike(told: dict[str, Any], expected: Expected) -> bool:
    if expected.raises is not None:
        kind, text = expected.raises
        return told["how"] == "raised" and told["kind"] == kind and text in told["text"]
    return bool(told["how"] == ("horizon" if expected.ends == "stuck" else expected.ends))


@pytest.mark.slow
@pytest.mark.realtime
@pytest.mark.parametrize("expected", PROGRAMS, ids=lambda expected: expected.name)
def test_program_does_under_rclpy_what_it_does_in_the_box(
    recordings: dict[str, Future[dict[str, Any]]], expected: Expected
) -> None:
    told = recordings[expected.name].result()
    assert ends_alike(told, expected), told
    if expected.phases is not None:
        found = phases_of([(t_s, Twist(vx, 0.0, wz)) for t_s, vx, wz in told["stream"]])
        longest_s = max((phase[0] for phase in expected.phases if phase[0] != float("inf")), default=0.0)
        assert is_alike(_rounded(found), expected.phases, LATE_S + LATE_SHARE * longest_s), found


def _rounded(phases: list[Phase]) -> list[Phase]:
    return [(seconds, round(speed, 9), round(rate, 9)) for seconds, speed, rate in phases]
