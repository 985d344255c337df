"""Over rosbridge, in real time: the network goes and comes back, and the very same session goes on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("websockets", reason="pip install 'chatrobot[rosbridge]'")

from tests.wire.fake_rosbridge import FakeRosbridge

from chatrobot.core.clock import RealClock
from chatrobot.core.events import Event, Finished, Notice
from chatrobot.link.processes import MotionProcess
from chatrobot.link.socket_link import SocketLink
from chatrobot.robots.load import load_profile
from chatrobot.sim.robot import SimRobot
from chatrobot.wire.messages import Message, TwistMessage
from chatrobot.wire.ros_messages import ros_form
from chatrobot.wire.wire import M, Wire

pytestmark = [pytest.mark.realtime, pytest.mark.alone]

PATIENCE_S = 20.0
PROFILE = load_profile("wheeltec_mini_mec")


class OnBoard(Wire):
    """The robot's own end, on the robot: no network lies between it and its rosbridge."""

    def __init__(self, bridge: FakeRosbridge, topics: tuple[str, ...] = ("odom", "imu")) -> None:
        self._bridge = bridge
        self._topics = topics

    def publish(self, topic: str, message: Message) -> None:
        form = ros_form(topic, type(message), PROFILE.wiring)
        if topic in self._topics:
            self._bridge.say(f"/{topic}", form.to_ros(message))

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:  # noqa: ARG002
        def hear(twist: Any) -> None:
            message: Any = TwistMessage(twist["linear"]["x"], twist["linear"]["y"], twist["angular"]["z"])
            callback(message)

        self._bridge.listen(f"/{topic}", hear)

    def close(self) -> None: ...


class Rig:
    """A robot that holds its last command for ever, its rosbridge, and Motion on what looks like another machine."""

    host = "127.1"
    """An address of this machine that does not look like one."""

    def __init__(self, bridge: FakeRosbridge, topics: tuple[str, ...] = ("odom", "imu")) -> None:
        self.bridge = bridge
        self.robot = SimRobot(PROFILE, wire=OnBoard(bridge, topics), clock=RealClock())
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._live)
        self._thread.start()
        self.events: list[Event] = []
        address = f"rosbridge:ws://{self.host}:{bridge.port}"
        self.link = SocketLink(MotionProcess.start([address], "wheeltec_mini_mec", "empty")[0])
        self.link.wait_until_ready()

    def _live(self) -> None:
        while not self._ended.wait(0.02):
            self.robot.step(time.monotonic() - self.robot.now_s)

    def wait_for(self, wanted: Callable[[Event], bool]) -> Event:
        for event in self.events:
            if wanted(event):
                return event
        ends_s = time.monotonic() + PATIENCE_S
        while time.monotonic() < ends_s:
            event = self.link.next_event(0.1)
            if event is not None:
                self.events.append(event)
                if wanted(event):
                    return event
        raise AssertionError(f"it did not come: {self.events[-3:]}")

    def notice(self, code: str) -> Event:
        return self.wait_for(lambda event: isinstance(event, Notice) and event.reason.code == code)

    def end_of(self, turn: int) -> Finished:
        end = self.wait_for(lambda event: isinstance(event, Finished) and event.turn == turn)
        assert isinstance(end, Finished)
        return end

    def wait_until(self, holds: Callable[[], bool]) -> float:
        began_s = time.monotonic()
        while not holds():
            assert time.monotonic() - began_s < PATIENCE_S
            time.sleep(0.01)
        return time.monotonic() - began_s

    def speed_mps(self) -> float:
        return self.robot.true_twist.speed_mps

    def close(self) -> None:
        self.link.close()
        self._ended.set()
        self._thread.join()
        self.bridge.stop()


@pytest.fixture
def rig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Rig]:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    made = Rig(FakeRosbridge())
    yield made
    made.close()


def test_the_session_tells_and_stops_and_recovers(rig: Rig) -> None:
    slow = rig.notice("drives_on_alone")
    assert isinstance(slow, Notice)
    rig.link.send("plan", 1, plan_text="drive 5 m at 0.5 m/s", mode="queue")
    refused = rig.end_of(1)
    assert (
        refused.outcome == "refused"
    )  # more than a robot may do that drives on alone when the network fails
    rig.link.send("plan", 2, plan_text="drive 5 m", mode="queue")
    rig.wait_until(lambda: rig.speed_mps() > 0.08)  # without a lidar it goes at the blind speed

    rig.bridge.stop()
    end = rig.end_of(2)
    assert end.reason is not None
    assert (end.outcome, end.reason.code in ("wire_gone", "odometry_silent")) == ("failed", True)
    rig.notice("wire_gone")
    rig.link.send("plan", 3, plan_text="drive 0.1 m", mode="queue")
    assert rig.end_of(3).outcome in ("refused", "failed")
    assert rig.speed_mps() > 0.08  # nobody can reach it

    rig.bridge.start()
    took_s = rig.wait_until(lambda: rig.speed_mps() < 0.005)
    print(f"it stands {took_s:.2f} s after the network is back")
    assert took_s < 2.0
    rig.notice("wire_back")
    rig.link.send("plan", 4, plan_text="drive 0.1 m", mode="queue")
    end = rig.end_of(4)
    assert (end.outcome, end.path_m) == ("completed", pytest.approx(0.1, abs=0.01))
