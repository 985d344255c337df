"""The wire over the real rosbridge_server keeps the contract of wires, and drives a robot: the fake of tests/wire knows
no more than this."""

from __future__ import annotations

import itertools
import json
import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from ros_rig import SOURCE, Process, next_domain

sys.path.insert(0, str(Path(__file__).parents[1] / "wire"))
from about import About

from chatrobot.core.wiring import Wiring
from chatrobot.motion.topic_discovery import fit
from chatrobot.testing.wire_contract import CAMERA, Inbox, WireContract
from chatrobot.wire.messages import Message, Number, TwistMessage
from chatrobot.wire.rosbridge.wire import RosbridgeWire
from chatrobot.wire.wire import Endpoint

pytestmark = pytest.mark.realtime
PATIENCE_S = 60.0
_namespaces = (f"test{number}" for number in itertools.count())


class Server:
    """rosbridge_websocket, and rosapi where it is built, on a domain of their own."""

    def __init__(self, folder: Path) -> None:
        folder.chmod(0o700)
        with socket.create_server(("127.0.0.1", 0)) as probe:
            self.port = probe.getsockname()[1]
        self.environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join([str(SOURCE), os.environ.get("PYTHONPATH", "")]),
            "PYTHONUNBUFFERED": "1",
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_DOMAIN_ID": next_domain(),
            "XDG_CONFIG_HOME": str(folder / "config"),
            "XDG_RUNTIME_DIR": str(folder),
        }
        self._processes: list[Process] = []
        self.bridge = self.start_bridge()
        self.start("ros2", "run", "rosapi", "rosapi_node")

    @property
    def url(self) -> str:
        return f"ws://127.0.0.1:{self.port}"

    def start(self, *arguments: str) -> Process:
        process = Process(list(arguments), self.environment)
        self._processes.append(process)
        return process

    def start_bridge(self) -> Process:
        node = ("ros2", "run", "rosbridge_server", "rosbridge_websocket")
        self.bridge = self.start(*node, "--ros-args", "-p", f"port:={self.port}", "-p", "address:=127.0.0.1")
        self.bridge.wait_for_line("started on port")
        return self.bridge

    def close(self) -> None:
        for process in reversed(self._processes):
            process.end()


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    made = Server(tmp_path_factory.mktemp("rosbridge"))
    yield made
    made.close()


@pytest.fixture
def connect(server: Server) -> Iterator[Callable[..., RosbridgeWire]]:
    """Ends in a namespace of this test's own: the server remembers types for a while."""
    namespace = next(_namespaces)
    wires: list[RosbridgeWire] = []

    def connect_one(wiring: Wiring = Wiring(), inner: str = "") -> RosbridgeWire:  # noqa: B008
        wires.append(RosbridgeWire(server.url, wiring, namespace=f"{namespace}{inner}"))
        return wires[-1]

    yield connect_one
    for wire in wires:
        wire.close()


class TestRealRosbridge(WireContract):
    @pytest.fixture
    def connect(self, connect: Callable[..., RosbridgeWire]) -> Callable[[], RosbridgeWire]:  # type: ignore[override]
        return lambda: connect(CAMERA)

    def as_it_arrives(self, message: Message) -> About:
        return About(message)

    def test_messages_arrive_in_the_order_they_were_sent(self, connect: Callable[..., RosbridgeWire]) -> None:
        """Ten at once: the server's own listener keeps no more of a burst."""
        inbox, sender = Inbox(connect(), "topic", Number), connect()
        for i in range(10):
            sender.publish("topic", Number(float(i)))
        assert inbox.take(10) == [Number(float(i)) for i in range(10)]


def test_two_robots_in_two_namespaces_are_driven_apart(connect: Callable[..., RosbridgeWire]) -> None:
    left, right = connect(inner="/left"), connect(inner="/right")
    inbox = Inbox(right, "cmd_vel", TwistMessage)
    left.publish("cmd_vel", TwistMessage(1.0, 0.0, 0.0))
    connect(inner="/right").publish("cmd_vel", TwistMessage(2.0, 0.0, 0.0))
    assert inbox.next() == TwistMessage(2.0, 0.0, 0.0)


class TestARobotBehindIt:
    @pytest.fixture(scope="class")
    def robot(self, server: Server) -> Process:
        robot = server.start(sys.executable, "-m", "chatrobot", "sim", "--on", "ros", "--world", "empty")
        robot.wait_for_line("it ends with Ctrl-C")
        return robot

    def do(self, server: Server, text: str) -> dict[str, object]:
        """The result, with the time that was announced."""
        done = subprocess.run(
            [
                sys.executable,
                "-m",
                "chatrobot",
                "do",
                text,
                "--on",
                f"rosbridge:{server.url}",
                "--yes",
                "--json",
            ],
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            env=server.environment,
        )
        assert "Traceback" not in done.stderr
        events = [json.loads(line) for line in done.stdout.splitlines()]
        announced_s = [event["duration_s"] for event in events if event["event"] == "rehearsed"]
        said = [event["reason"] for event in events if event["event"] == "notice"]
        return {**events[-1], "announced_s": announced_s, "said": said}

    def test_it_is_driven(self, server: Server, robot: Process) -> None:
        assert robot.process.poll() is None
        result = self.do(server, "forward 30 cm, then turn left")
        assert result["outcome"] == "completed", result
        pose = result["pose"]
        assert isinstance(pose, dict)
        assert pose["x_m"] == pytest.approx(0.3, abs=0.02)

    def test_open_space_is_crossed_at_normal_speed(self, server: Server, robot: Process) -> None:
        """Its scan is infinity all around: in JSON that would be null, and 20 s."""
        assert robot.process.poll() is None
        result = self.do(server, "forward 2 m")
        assert result["outcome"] == "completed", result
        assert result["announced_s"] == [pytest.approx(7.0, abs=0.1)]
        assert isinstance(result["duration_s"], float)
        assert result["duration_s"] < 12.0, "7 s on an idle machine"
        assert "open_space_unknown" not in str(result["said"])

    def test_rosapi_tells_how_the_robot_is_wired(self, server: Server, robot: Process) -> None:
        """The bridge itself says nothing of a type that nobody takes: it only logs."""
        assert robot.process.poll() is None
        wire = RosbridgeWire(server.url, Wiring())
        wanted = {
            Endpoint("/cmd_vel", "geometry_msgs/msg/Twist", "listens"),
            Endpoint("/odom", "nav_msgs/msg/Odometry", "publishes"),
        }
        ends_s = time.monotonic() + PATIENCE_S
        while not wanted <= set(wire.survey()):
            assert time.monotonic() < ends_s
            time.sleep(0.1)
        fitted, said = fit(Wiring(cmd_vel_type="TwistStamped"), wire.survey(), wire.resolve)
        assert (fitted, [reason.code for reason in said]) == (Wiring(), ["cmd_vel_type_found"])
        wire.close()

    def test_a_bridge_that_was_gone_is_found_again(self, server: Server, robot: Process) -> None:
        assert robot.process.poll() is None
        wire = RosbridgeWire(server.url, Wiring())
        try:
            server.bridge.end()
            while wire.is_connected:
                time.sleep(0.01)
            server.start_bridge()
            ends_s = time.monotonic() + PATIENCE_S
            while not wire.is_connected:
                assert time.monotonic() < ends_s
                time.sleep(0.01)
        finally:
            wire.close()
        assert self.do(server, "backward 10 cm")["outcome"] == "completed"
