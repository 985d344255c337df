"""`chatrobot do --on dds` and the nodes on other wires."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from chatrobot.core.errors import UsageError
from chatrobot.wire.connect import is_on_this_machine, wire_address
from tests.nodes.node_rig import PATIENCE_S, NodeRig, running

pytestmark = pytest.mark.realtime


def do(rig: NodeRig, *arguments: str) -> tuple[int, list[dict[str, object]]]:
    done = subprocess.run(
        [sys.executable, "-m", "chatrobot", "do", "--on", "dds", "--json", *arguments],
        capture_output=True,
        env=rig.environment,
        timeout=PATIENCE_S,
        text=True,
    )
    assert "Traceback" not in done.stderr
    return done.returncode, [json.loads(line) for line in done.stdout.splitlines()]


def test_do_drives_a_robot_on_dds_once_it_is_approved(tmp_path: Path) -> None:
    with running(tmp_path, "input") as rig:
        code, events = do(rig, "forward 20 cm", "--yes")
        assert (code, events[-1]["outcome"]) == (0, "completed")
        assert rig.pose()[0] == pytest.approx(0.2, abs=0.01)
        code, events = do(rig, "forward 20 cm")  # nobody is there to be asked
        assert (code, events[-1]["outcome"]) == (4, "refused")
        assert rig.pose()[0] == pytest.approx(0.2, abs=0.01)


def test_do_does_not_drive_a_robot_that_a_control_node_drives(tmp_path: Path) -> None:
    with running(tmp_path, "control") as rig:
        code, events = do(rig, "forward 20 cm", "--yes")
        assert (code, events[-1]["outcome"]) == (4, "refused")
        assert "chatrobot_control" in str(events[-1]["reply"])


def test_the_nodes_run_on_a_local_wire_too(tmp_path: Path) -> None:
    with running(tmp_path, "input") as rig:  # its environment, and somebody to keep apart from
        on = f"local:{tmp_path / 'robot.wire'}"
        rig.start("sim", "--on", on, "--world", "empty").wait_for_line("answers on")
        nodes = {name: rig.start("node", name, "--on", on) for name in ("control", "base", "input")}
        for name, node in nodes.items():
            node.wait_for_line(name)
        nodes["input"].say("forward 20 cm")
        assert "0.2" in nodes["input"].wait_for_line("Done")
        assert not rig.velocities.all


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
