"""The simulated robot and the three nodes, each a process as a person would start it, on a DDS domain of their own.

Stamps are of the machine's monotonic clock, taken in this process, which is none of the four.
"""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest

pytest.importorskip(
    "cyclonedds", reason="cyclonedds has no wheel for this machine or Python: DDS stays untested here"
)

from chatrobot.core.wiring import Wiring
from chatrobot.wire.dds.wire import DdsWire
from chatrobot.wire.discovery import Discovery
from chatrobot.wire.messages import Flag, Odometry, Text, TwistMessage
from tests.processes import PATIENCE_S, Heard, TalkingProcess

_STRANGER = Path(__file__).with_name("stranger.py")
_WORKER = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
_OF_ITS_OWN = range(1 + 30 * (_WORKER % 3), 31 + 30 * (_WORKER % 3))
_domains = itertools.cycle(random.Random(os.getpid()).sample(_OF_ITS_OWN, len(_OF_ITS_OWN)))
"""Domains of this run's own, and of this worker's where three run side by side."""


LAUNCH_REPEATS_S = 0.02
"""`ros2 launch` hands on what the terminal has sent to all already so much later."""


class Node(TalkingProcess):
    """A process of ours."""

    def __init__(self, arguments: list[str], environment: dict[str, str]) -> None:
        super().__init__([sys.executable, *arguments], environment)

    def strike(self, name: str) -> float:
        now_s = time.monotonic()
        os.kill(self.process.pid, getattr(signal, name))
        return now_s

    def ask_to_end(self) -> None:
        """Thaw it, and ask it to end."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.process.pid, signal.SIGCONT)
            self.process.terminate()

    def end(self) -> None:
        """Ask it to end, and see that it has."""
        self.ask_to_end()
        try:
            self.process.wait(10.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait(10.0)


class NodeRig:
    """Everything running, and an ear for what goes over the wire. `namespace`: of the robot and its nodes."""

    def __init__(self, folder: Path, *nodes: str, namespace: str = "") -> None:
        self.domain = next(_domains)
        self.on = f"dds://{self.domain}/{namespace}" if namespace else "dds"
        kept = {
            k: v for k, v in os.environ.items() if not k.startswith(("ROS_", "CYCLONE", "CHATROBOT_", "XDG_"))
        }
        self.environment = {
            **kept,
            "ROS_DOMAIN_ID": str(self.domain),
            "XDG_RUNTIME_DIR": str(folder),
            "XDG_CONFIG_HOME": str(folder / "config"),
            "PYTHONUNBUFFERED": "1",
        }
        self._all: list[Node] = []
        here = Discovery(domain_id=self.domain)
        self.ear = DdsWire(Wiring(), "ear", namespace=namespace, discovery=here)
        self.velocities, self.truth, self.replies, self.events = Heard(), Heard(), Heard(), Heard()
        self.ear.subscribe("cmd_vel", TwistMessage, self.velocities)
        self.ear.subscribe("chatrobot/sim/truth", Odometry, self.truth)
        self.ear.subscribe("chatrobot/reply", Text, self.replies)
        self.ear.subscribe("chatrobot/events", Text, lambda message: self.events(json.loads(message.data)))
        self.robot = self.start("sim", "--on", self.on, "--world", "empty")
        self.nodes = {
            name: self.start("node", name, "--on", self.on) for name in nodes or ("control", "base", "input")
        }
        self.robot.wait_for_line("it ends with Ctrl-C")
        for name, node in self.nodes.items():
            node.wait_for_line(name)
        self.truth.wait_for(lambda _: True)

    def start(self, *arguments: str) -> Node:
        node = Node(["-m", "chatrobot", *arguments], self.environment)
        self._all.append(node)
        return node

    def replace(self, name: str, *more: str) -> None:
        """A new one in the place of a node that has ended, or was killed."""
        self.nodes[name].end()
        self.nodes[name] = self.start("node", name, "--on", self.on, *more)
        self.nodes[name].wait_for_line(name)

    def drive(self, text: str = "forward 100 m at 0.3 m/s") -> float:
        """Type it until the robot is at speed: who has just come may not have met everybody yet. When it was said."""
        for _ in range(5):
            said_s = self.nodes["input"].say(text)
            with contextlib.suppress(AssertionError):
                self.truth.wait_for(lambda odometry: odometry.vx_mps > 0.25, said_s, 3.0)
                return said_s
        raise AssertionError(f"it does not move: {self.events.all[-3:]}")

    def rest(self) -> None:
        """Until the robot stands, and whatever was under way has been told."""
        self.publish("chatrobot/stop", Flag(True))
        now_s = time.monotonic()
        self.truth.wait_for(lambda odometry: abs(odometry.vx_mps) < 0.005, now_s)
        time.sleep(0.3)

    def publish(self, topic: str, message: Text | Flag) -> float:
        """Put it on the wire once somebody listens; when that was."""
        assert self.ear.wait_for_listener(topic, type(message), PATIENCE_S)
        now_s = time.monotonic()
        self.ear.publish(topic, message)
        return now_s

    def stranger_says(self, topic: str, text: str) -> float:
        """A process that is none of ours says it once and leaves."""
        began_s = time.monotonic()
        subprocess.run(
            [sys.executable, str(_STRANGER), str(self.domain), topic, text],
            check=True,
            timeout=PATIENCE_S,
            env=self.environment,
        )
        return began_s

    def do(self, text: str) -> dict[str, Any]:
        """Type it; the result of its turn."""
        said_s = self.nodes["input"].say(text)
        return self.result(said_s)

    def result(self, since_s: float, reply: str = "") -> dict[str, Any]:
        """The first result since then whose reply begins like this."""
        _, event = self.events.wait_for(
            lambda event: event["event"] == "result" and event["reply"].startswith(reply), since_s
        )
        print("result:", event)  # pytest shows it where the test fails, with the reason
        return dict(event)

    def event(self, name: str, since_s: float = 0.0) -> dict[str, Any]:
        _, event = self.events.wait_for(lambda event: event["event"] == name, since_s)
        return dict(event)

    def pose(self) -> tuple[float, float, float]:
        """Where the robot really is now."""
        now_s = time.monotonic()
        _, odometry = self.truth.wait_for(lambda _: True, now_s)
        return odometry.x_m, odometry.y_m, odometry.yaw_rad

    def guard(self) -> psutil.Process:
        """That of control."""
        children = psutil.Process(self.nodes["control"].process.pid).children()
        return next(child for child in children if "chatrobot.guard" in child.cmdline())

    def interrupt_all(self) -> float:
        """Ctrl-C as under `ros2 launch`: to every process of it at once, and again a moment later. When that was."""
        processes = [node.process for node in (self.robot, *self.nodes.values())]
        struck_s = time.monotonic()
        for _ in range(2):
            for process in processes:
                if process.poll() is None:
                    process.send_signal(signal.SIGINT)
            time.sleep(LAUNCH_REPEATS_S)
        return struck_s

    def close(self) -> None:
        robot, *nodes = self._all
        for node in nodes:
            node.ask_to_end()
        for node in (*nodes, robot):  # control sees it stand
            node.end()
        self.ear.close()


@contextlib.contextmanager
def running(folder: Path, *nodes: str, namespace: str = "") -> Iterator[NodeRig]:
    rig = NodeRig(folder, *nodes, namespace=namespace)
    try:
        yield rig
    finally:
        rig.close()
