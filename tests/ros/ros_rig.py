"""Real ROS 2 for tests: the ament packages built with colcon, and processes started with `ros2 run` and `ros2 launch`.

Where it is missing the tests of this folder are left out, and pytest's summary says so (conftest.py).
"""

from __future__ import annotations

import contextlib
import itertools
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from tests.processes import Heard, TalkingProcess

PACKAGES = Path(__file__).parents[2] / "ros"
SOURCE = Path(__file__).parents[2] / "src"
PATIENCE_S = 60.0
ROBOT = "wheeltec_mini_mec"
_domains = itertools.cycle(random.Random(os.getpid()).sample(range(91, 100), 9))
"""Where the tests of DDS do not go: both may run on one machine."""


def next_domain() -> str:
    return str(next(_domains))


class Process(TalkingProcess):
    """A process of ROS's or ours."""

    patience_s = PATIENCE_S

    def interrupt(self) -> float:
        """Ctrl-C: to the whole group, as a terminal does it."""
        now_s = time.monotonic()
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGINT)
        return now_s

    def end(self) -> int:
        """Ctrl-C, and see that it has ended; its exit code."""
        if self.process.poll() is None:
            self.interrupt()
        try:
            return self.process.wait(20.0)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
            raise

    def interrupt_below(self) -> None:
        """Ctrl-C to all that it has started in its group, not to itself: `ros2 launch` may hang at a second one."""
        for pid in self._below():
            with contextlib.suppress(ProcessLookupError):
                if os.getpgid(pid) == self.process.pid:
                    os.kill(pid, signal.SIGINT)

    def guard(self) -> int:
        """The process of the guard below it."""
        return next(
            pid for pid in self._below() if b"chatrobot.guard" in Path(f"/proc/{pid}/cmdline").read_bytes()
        )

    def _below(self) -> list[int]:
        found: list[int] = []
        waiting = [self.process.pid]
        while waiting:
            pid = waiting.pop()
            with contextlib.suppress(OSError):  # it has ended meanwhile
                for children in Path(f"/proc/{pid}/task").glob("*/children"):
                    waiting += map(int, children.read_text().split())
            found.append(pid)
        return found[1:]


def has_ended(pid: int) -> bool:
    """It may wait for whoever has adopted it to look after it."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except FileNotFoundError:
        return True


def wait_for_end(pid: int, timeout_s: float) -> None:
    ends_s = time.monotonic() + timeout_s
    while not has_ended(pid):
        assert time.monotonic() < ends_s, f"process {pid} is there after {timeout_s:g} s"
        time.sleep(0.01)


class Workspace:
    """A colcon workspace with our two packages, built, and its environment."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        (folder / "src").mkdir()
        (folder / "src" / "chatrobot_ros").symlink_to(PACKAGES)
        # As in a virtual environment: this Python runs colcon, and so stands in the executables' first line.
        self.build = subprocess.run(
            [sys.executable, "-m", "colcon", "build"],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=300,
            env=os.environ,
        )
        assert self.build.returncode == 0, self.build.stdout + self.build.stderr
        sourced = subprocess.run(
            ["bash", "-c", "source install/local_setup.bash && env -0"],
            cwd=folder,
            capture_output=True,
            check=True,
            env=os.environ,
        )
        pairs = (entry.decode().partition("=") for entry in sourced.stdout.split(b"\0") if entry)
        self.environment = {name: value for name, _, value in pairs}

    def environment_for(self, folder: Path, domain: str, reach: str = "LOCALHOST") -> dict[str, str]:
        python_path = os.pathsep.join([str(SOURCE), self.environment.get("PYTHONPATH", "")])
        folder.chmod(0o700)
        return {
            **self.environment,
            "PYTHONPATH": python_path,
            "PYTHONUNBUFFERED": "1",
            "QT_QPA_PLATFORM": "offscreen",
            "ROS_AUTOMATIC_DISCOVERY_RANGE": reach,
            "ROS_DOMAIN_ID": domain,
            "XDG_CONFIG_HOME": str(folder / "config"),
            "XDG_RUNTIME_DIR": str(folder),
        }


class Rig:
    """One domain: processes started by their ROS names, and an ear that is a ROS node itself."""

    def __init__(self, workspace: Workspace, folder: Path, robot: str, ear_args: Sequence[str]) -> None:
        from chatrobot.robots.load import load_profile
        from chatrobot.wire.ros import connect_ros

        self.domain = next_domain()
        self.environment = workspace.environment_for(folder, self.domain)
        self._processes: list[Process] = []
        self.wiring = load_profile(robot).wiring
        with _environment_variable("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"):
            self.ear: Any = connect_ros(f"ros://{self.domain}", self.wiring, "ear", ear_args)

    def hear(self, topic: str, kind: Any) -> Heard:
        heard = Heard(PATIENCE_S)
        self.ear.subscribe(topic, kind, heard)
        return heard

    def start(self, *arguments: str, **more: str) -> Process:
        process = Process(list(arguments), {**self.environment, **more})
        self._processes.append(process)
        return process

    def run(self, package: str, executable: str, *arguments: str) -> Process:
        return self.start("ros2", "run", package, executable, *arguments)

    def ask(self, *arguments: str) -> str:
        """What a command of `ros2` prints, its warnings too."""
        done = subprocess.run(
            ["ros2", *arguments], capture_output=True, text=True, timeout=PATIENCE_S, env=self.environment
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout + done.stderr

    def close(self) -> None:
        for process in reversed(self._processes):
            process.end()
        self.ear.close()


@contextlib.contextmanager
def rig_of(
    workspace: Workspace, folder: Path, robot: str = ROBOT, ear_args: Sequence[str] = ()
) -> Iterator[Rig]:
    rig = Rig(workspace, folder, robot, ear_args)
    try:
        yield rig
    finally:
        rig.close()


@contextlib.contextmanager
def _environment_variable(name: str, value: str) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(name, value)
        yield
