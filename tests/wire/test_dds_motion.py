"""A robot, Motion and guard in processes of their own, on DDS alone: the same promises as on the local wire."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from dds_rig import DOMAIN_ID, HERE, PATIENCE_S
from tests.session.joint_rigs import PROFILE, finished, moving, send_plan

from chatrobot.core.wiring import Wiring
from chatrobot.session.processes import MotionProcess
from chatrobot.session.socket_joint import SocketJoint
from chatrobot.wire.dds.wire import DdsWire
from chatrobot.wire.messages import TwistMessage

pytestmark = pytest.mark.realtime

ADDRESS = f"dds://{DOMAIN_ID}"
PROMISE_S = 0.25


class DdsRig:
    def __init__(self) -> None:
        command = [
            sys.executable,
            "-m",
            "chatrobot.sim",
            "--on",
            ADDRESS,
            "--profile",
            PROFILE,
            "--world",
            "empty",
        ]
        self.robot = subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True)
        assert self.robot.stdout is not None
        assert select.select([self.robot.stdout], [], [], PATIENCE_S)[0]
        assert self.robot.stdout.readline() == b"ready\n"
        self.joint = SocketJoint(MotionProcess.start(ADDRESS, PROFILE, "empty"))
        self.joint.wait_until_ready()
        self.heard: list[tuple[float, TwistMessage]] = []
        self.ear = DdsWire(Wiring(), "ear", discovery=HERE)
        self.ear.subscribe(
            "cmd_vel", TwistMessage, lambda twist: self.heard.append((time.monotonic(), twist))
        )

    @property
    def velocities(self) -> list[TwistMessage]:
        return [twist for _, twist in self.heard]

    def seconds_to_rest(self, since_s: float) -> float:
        """From `since_s` to the first zero after the last velocity, once only zeros have come for a while."""
        deadline_s = since_s + PATIENCE_S
        while time.monotonic() < deadline_s:
            self.joint.next_event(0.02)
            moving_s = [at_s for at_s, twist in self.heard if any(twist)]
            zeros_s = [at_s for at_s, twist in self.heard if not any(twist) and at_s > moving_s[-1]]
            if zeros_s and time.monotonic() > zeros_s[0] + 0.3:
                return zeros_s[0] - since_s
        raise AssertionError("no zero came")

    def close(self) -> None:
        self.joint.close()
        self.ear.close()
        self.robot.terminate()
        self.robot.communicate(timeout=PATIENCE_S)


@pytest.fixture
def rig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[DdsRig]:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    made = DdsRig()
    yield made
    made.close()


def test_a_plan_is_driven_and_measured(rig: DdsRig) -> None:
    send_plan(rig, 1, "drive 0.3 m")  # type: ignore[arg-type]
    end = finished(rig, 1)  # type: ignore[arg-type]
    assert end.outcome == "completed"
    assert end.path_m == pytest.approx(0.3, abs=0.01)


def test_stop_ends_what_runs(rig: DdsRig) -> None:
    send_plan(rig, 1, "drive 5 m")  # type: ignore[arg-type]
    moving(rig, 1)  # type: ignore[arg-type]
    said_s = time.monotonic()
    rig.joint.send("stop", why="test")
    assert finished(rig, 1).outcome == "stopped"  # type: ignore[arg-type]
    assert rig.seconds_to_rest(said_s) < PROMISE_S


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
def test_when_motion_dies_or_freezes_the_guard_stops_the_robot(rig: DdsRig, how: signal.Signals) -> None:
    send_plan(rig, 1, "drive 100 m at 0.3 m/s")  # type: ignore[arg-type]
    moving(rig, 1)  # type: ignore[arg-type]
    struck_s = time.monotonic()
    os.kill(rig.joint.process.pid, how)
    assert rig.seconds_to_rest(struck_s) < PROMISE_S
    if how == signal.SIGSTOP:
        os.kill(rig.joint.process.pid, signal.SIGCONT)
