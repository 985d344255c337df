"""`chatrobot do --on dds` and the nodes on other wires."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import chatrobot
from chatrobot.core.errors import UsageError
from chatrobot.wire.connect import is_on_this_machine, wire_address
from chatrobot.wire.messages import Odometry, TwistMessage
from tests.nodes.node_rig import PATIENCE_S, Heard, NodeRig, running

pytestmark = pytest.mark.realtime


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeRig]:
    with running(tmp_path_factory.mktemp("nodes"), "input") as made:
        yield made


def begin(rig: NodeRig, *arguments: str, on: str = "dds") -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "chatrobot", "do", "--on", on, "--json", *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=rig.environment,
        text=True,
    )


def end(doing: subprocess.Popen[str]) -> tuple[int, list[dict[str, object]]]:
    out, err = doing.communicate(timeout=PATIENCE_S)
    assert out, err
    assert "Traceback" not in err
    return doing.returncode, [json.loads(line) for line in out.splitlines()]


def do(rig: NodeRig, *arguments: str) -> tuple[int, list[dict[str, object]]]:
    return end(begin(rig, *arguments))


def test_do_drives_a_robot_on_dds_once_it_is_approved(rig: NodeRig) -> None:
    code, events = do(rig, "forward 20 cm", "--yes")
    assert (code, events[-1]["outcome"]) == (0, "completed")
    assert rig.pose()[0] == pytest.approx(0.2, abs=0.01)
    code, events = do(rig, "forward 20 cm")  # nobody is there to be asked
    assert (code, events[-1]["outcome"]) == (4, "refused")
    assert rig.pose()[0] == pytest.approx(0.2, abs=0.01)


def test_two_robots_in_two_namespaces_on_one_domain_are_driven_apart(rig: NodeRig, tmp_path: Path) -> None:
    """At one time, one by its address, the other by its profile; the one without a namespace stands all the while."""
    builtin = Path(chatrobot.__file__).parent / "robots" / "profiles" / "wheeltec_mini_mec.toml"
    mine = tmp_path / "mine.toml"
    mine.write_text(
        builtin.read_text("utf-8").replace("\n[wiring]", '\n[wiring]\nnamespace = "right"'), "utf-8"
    )
    left, right = f"dds://{rig.domain}/left", f"dds://{rig.domain}/right"
    heard, truths = {}, {}
    for name in ("left", "right"):
        heard[name], truths[name] = Heard(), Heard()
        rig.ear.subscribe(f"/{name}/cmd_vel", TwistMessage, heard[name])
        rig.ear.subscribe(f"/{name}/chatrobot/sim/truth", Odometry, truths[name])
    robots = [rig.start("sim", "--on", on, "--world", "empty") for on in (left, right)]
    for robot in robots:
        robot.wait_for_line("it ends with Ctrl-C")
    x_m = rig.pose()[0]
    count = len(rig.velocities.all)
    both = (
        begin(rig, "forward 40 cm", "--yes", on=left),
        begin(rig, "backward 20 cm", "--yes", "--robot", str(mine)),
    )
    for doing in both:
        code, events = end(doing)
        assert (code, events[-1]["outcome"]) == (0, "completed")
        assert not any(event["event"] == "notice" for event in events)  # neither sees a rival in the other
    for name, went_m in (("left", 0.4), ("right", -0.2)):
        _, truth = truths[name].wait_for(lambda _: True, time.monotonic())
        assert truth.x_m == pytest.approx(went_m, abs=0.01)
        assert all(twist.vx_mps * went_m >= 0.0 for _, twist in heard[name].all if abs(twist.vx_mps) > 0.09)
    assert rig.pose()[0] == pytest.approx(x_m, abs=1e-6)
    assert len(rig.velocities.all) == count
    for robot in robots:
        robot.end()


def test_do_does_not_drive_a_robot_that_a_control_node_drives(rig: NodeRig) -> None:
    control = rig.start("node", "control", "--on", "dds")
    control.wait_for_line("control")
    code, events = do(rig, "forward 20 cm", "--yes")
    assert (code, events[-1]["outcome"]) == (4, "refused")
    assert "chatrobot_control" in str(events[-1]["reply"])
    control.end()


def test_the_nodes_run_on_a_local_wire_too(rig: NodeRig, tmp_path: Path) -> None:
    """Beside somebody on DDS, whom they leave alone."""
    count = len(rig.velocities.all)
    on = f"local:{tmp_path / 'robot.wire'}"
    robot = rig.start("sim", "--on", on, "--world", "empty")
    robot.wait_for_line("answers on")
    nodes = {name: rig.start("node", name, "--on", on) for name in ("control", "base", "input")}
    for name, node in nodes.items():
        node.wait_for_line(name)
    nodes["input"].say("forward 20 cm")
    assert "0.2" in nodes["input"].wait_for_line("Done")
    assert len(rig.velocities.all) == count
    for node in (nodes["input"], nodes["base"], nodes["control"], robot):
        node.end()


@pytest.mark.parametrize(
    ("on", "address"),
    [
        ("dds", "dds:"),
        ("dds://7/robot1", "dds://7/robot1"),
        ("rosbridge", "rosbridge:ws://localhost:9090"),
        ("rosbridge:ws://robot:9090", "rosbridge:ws://robot:9090"),
        ("local:/tmp/x.wire", "local:/tmp/x.wire"),
    ],
)
def test_on_names_a_wire(on: str, address: str) -> None:
    assert wire_address(on) == address


def test_there_is_no_other_wire() -> None:
    with pytest.raises(UsageError, match="dds"):
        wire_address("telepathy")


@pytest.mark.parametrize(
    ("reach", "address", "here"),
    [
        ("", "dds:", True),
        ("SUBNET", "dds:", False),
        ("", "local:/tmp/x.wire", True),
        ("", "rosbridge:ws://robot:9090", False),
    ],
)
def test_beats_are_faster_where_nobody_is_far(
    monkeypatch: pytest.MonkeyPatch, reach: str, address: str, here: bool
) -> None:
    for name in ("ROS_LOCALHOST_ONLY", "ROS_STATIC_PEERS", "CHATROBOT_PEERS", "CYCLONEDDS_URI"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", reach)
    assert is_on_this_machine(address) is here
