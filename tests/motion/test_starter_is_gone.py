"""Whoever started Motion has left before it was ready (Ctrl-C at the start): it ends without a word."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest
from tests.processes import PATIENCE_S, wait_until

from chatrobot.link.processes import MotionProcess, spawn

pytestmark = pytest.mark.realtime

PROFILE, WORLD = "wheeltec_mini_mec", "empty"


@pytest.fixture(params=[1, 2], ids=["one robot", "a class"])
def wires(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[list[str]]:
    """The wires of simulated robots that stay."""
    paths = [tmp_path / f"robot-{place}.wire" for place in range(request.param)]
    named = [word for path in paths for word in ("--socket", str(path))]
    process = spawn("chatrobot.sim", *named, "--profile", PROFILE, "--world", WORLD)
    wait_until(lambda: all(path.exists() for path in paths))
    yield [str(path) for path in paths]
    process.terminate()
    process.wait(PATIENCE_S)


def test_motion_ends_quietly_and_its_guard_with_it(
    wires: list[str], capfd: pytest.CaptureFixture[str]
) -> None:
    motions = MotionProcess.start(wires, PROFILE, WORLD)
    process = motions[0].process
    for motion in motions:
        motion.close()
    family = psutil.Process(process.pid)
    wait_until(lambda: bool(family.children()))
    children = family.children()
    assert process.wait(PATIENCE_S) == 0
    _, alive = psutil.wait_procs(children, timeout=PATIENCE_S)
    assert not alive
    assert capfd.readouterr().err == ""
