"""A half of the last release and one of this: they refuse each other in one sentence, and a stop gets through."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from chatrobot.core.errors import LinkError
from chatrobot.core.events import Finished
from chatrobot.language.phrases import render_reason
from chatrobot.link.envelope import PROTOCOL
from chatrobot.link.motion_link import Sender
from chatrobot.link.processes import MotionProcess, spawn
from chatrobot.link.socket_link import SocketLink
from chatrobot.link.topic_link import CHATGPT_NODE, CONTROL, EVENTS, TopicLink
from chatrobot.wire.local import PACKET_BYTES, LocalHub, LocalWire
from chatrobot.wire.messages import Text, TwistMessage

PATIENCE_S = 30.0
SENTENCE = (
    "Motion runs link protocol {}, the dialogue {}: install the same version of chatrobot on both sides."
)


def old(word: str, sequence: int, turn: int = 0, **payload: Any) -> bytes:
    """An envelope as release 0.1 wrote it."""
    fields = {"word": word, "source": "console", "lease": "old", "sequence": sequence, "turn": turn}
    return json.dumps({**fields, "payload": payload}, separators=(",", ":")).encode()


def wait_for(holds: Callable[[], bool]) -> None:
    ends_s = time.monotonic() + PATIENCE_S
    while not holds():
        assert time.monotonic() < ends_s
        time.sleep(0.01)


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    path = tmp_path / "robot.wire"
    process = spawn(
        "chatrobot.sim", "--socket", str(path), "--profile", "wheeltec_mini_mec", "--world", "empty"
    )
    wait_for(path.exists)
    yield path
    process.terminate()
    process.wait(PATIENCE_S)


@pytest.fixture
def velocities(robot: Path) -> Iterator[list[TwistMessage]]:
    ear, heard = LocalWire(robot), list[TwistMessage]()
    ear.subscribe("cmd_vel", TwistMessage, heard.append)
    yield heard
    ear.close()


@pytest.mark.realtime
def test_on_a_socket_an_old_console_is_refused_and_its_stop_is_heard(
    robot: Path, velocities: list[TwistMessage]
) -> None:
    motion = MotionProcess.start([str(robot)], "wheeltec_mini_mec", "empty")[0]
    line, ends = motion.line, dict[int, Any]()
    assert line.recv(PACKET_BYTES) == f"ready {PROTOCOL}".encode()

    def read() -> None:
        while packet := line.recv(PACKET_BYTES):
            event = json.loads(packet)
            if event["event"] == "finished":
                ends[event["turn"]] = event

    threading.Thread(target=read, daemon=True).start()
    line.send(old("hello", 1, term_s=0.18, process=""))
    line.send(old("plan", 2, 1, plan_text="drive 1 m", mode="queue"))
    wait_for(lambda: 1 in ends)
    assert ends[1]["outcome"] == "refused"
    assert ends[1]["reason"] == {"code": "other_protocol", "motion": PROTOCOL, "dialogue": 1}
    assert not any(map(any, velocities))

    ours = Sender("console")
    line.send(ours.envelope("hello", term_s=1.0).to_bytes())
    line.send(ours.envelope("plan", 2, plan_text="drive 5 m").to_bytes())
    wait_for(lambda: any(map(any, velocities)))
    line.send(old("stop", 3, why="old"))
    wait_for(lambda: 2 in ends)
    assert ends[2]["outcome"] == "stopped"
    assert not any(velocities[-1])
    line.send(ours.envelope("goodbye").to_bytes())
    motion.process.wait(PATIENCE_S)


def test_on_a_socket_an_old_motion_is_refused() -> None:
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    process = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    theirs.send(b"ready")
    with pytest.raises(LinkError, match=rf"protocol 1, this process {PROTOCOL}: install the same version"):
        SocketLink(MotionProcess(process, ours)).wait_until_ready()
    assert process.wait(PATIENCE_S) != 0


@pytest.fixture
def hub(tmp_path: Path) -> Iterator[Path]:
    served, ended = LocalHub(tmp_path / "hub"), threading.Event()

    def serve() -> None:
        while not ended.is_set():
            served.poll(0.02)

    thread = threading.Thread(target=serve)
    thread.start()
    yield served.path
    ended.set()
    thread.join()
    served.close()


def test_on_topics_an_old_motion_is_refused_and_hears_a_stop(hub: Path) -> None:
    control, heard = LocalWire(hub), list[dict[str, Any]]()
    control.subscribe(CHATGPT_NODE, Text, lambda message: heard.append(json.loads(message.data)))
    wire = LocalWire(hub)
    link = TopicLink(wire, "base", is_on_this_machine=True)
    link.open()
    about = {"id": "old", "node": "chatrobot_control", "host": "robot", "pid": 7, "hears": []}
    ended = threading.Event()

    def beat() -> None:
        while not ended.wait(0.1):
            control.publish(CONTROL, Text(json.dumps(about)))

    threading.Thread(target=beat, daemon=True).start()
    link.send("plan", 1, plan_text="drive 1 m")
    end = link.next_event(PATIENCE_S)
    assert isinstance(end, Finished)
    assert end.outcome == "failed"
    assert end.reason is not None
    assert render_reason(end.reason, "en") == SENTENCE.format(1, PROTOCOL)
    link.send("stop", 1, why="x")
    wait_for(lambda: any(said["word"] == "stop" for said in heard))
    assert not any(said["word"] == "plan" for said in heard)
    stop = next(said for said in heard if said["word"] == "stop")
    assert stop.keys() == {"word", "source", "lease", "sequence", "turn", "payload"}, (
        "as release 0.1 reads it"
    )
    assert stop["payload"].keys() <= {"why", "keep"}
    ended.set()
    link.close()
    control.close()
    wire.close()


@pytest.mark.realtime
def test_on_topics_an_old_base_is_refused_and_its_stop_is_heard(
    robot: Path, velocities: list[TwistMessage]
) -> None:
    node = subprocess.Popen(
        [sys.executable, "-m", "chatrobot", "node", "control", "--on", f"local:{robot}"],
        stdin=subprocess.DEVNULL,
        env={**os.environ},
    )
    base, ends = LocalWire(robot), dict[int, Any]()

    def hear(message: Text) -> None:
        event = json.loads(message.data)
        if event["event"] == "finished":
            ends[event["turn"]] = event

    base.subscribe(EVENTS, Text, hear)
    wire = LocalWire(robot)
    ours = TopicLink(wire, "base", is_on_this_machine=True)
    ours.open()
    wait_for(lambda: ours.has_control)
    base.publish(CHATGPT_NODE, Text(old("hello", 1, term_s=0.18, process="").decode()))
    base.publish(CHATGPT_NODE, Text(old("plan", 2, 1, plan_text="drive 1 m", mode="queue").decode()))
    wait_for(lambda: 1 in ends)
    assert ends[1]["reason"] == {"code": "other_protocol", "motion": PROTOCOL, "dialogue": 1}
    assert not any(map(any, velocities))
    ours.send("plan", 2, plan_text="drive 5 m")
    wait_for(lambda: any(map(any, velocities)))
    base.publish(CHATGPT_NODE, Text(old("stop", 3, why="old").decode()))
    wait_for(lambda: 2 in ends)
    assert ends[2]["outcome"] == "stopped"
    assert not any(velocities[-1])
    ours.close()
    node.terminate()
    node.wait(PATIENCE_S)
    base.close()
    wire.close()
