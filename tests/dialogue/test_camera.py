"""A robot's camera on its wire: looked at only while a model looks, and only what it sees now."""

from __future__ import annotations

import io
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PIL import Image
from tests.dialogue.scripted_model import ModelTalk

import chatrobot.compose as compose
from chatrobot.core.errors import WireError
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.dialogue.llm.camera import FRESH_S, WireCamera, wire_camera
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Picture
from chatrobot.wire.wire import Wire

PATIENCE_S = 10.0
ASKED = "tell me what stands before you, please"
RED, GREEN = (200, 0, 0), (0, 200, 0)


def picture(stamp_s: float, colour: tuple[int, int, int] = RED, size: int = 8) -> Picture:
    return Picture(stamp_s, "rgb8", size, size, 3 * size, bytes(colour) * size * size)


def colour_of(jpeg: bytes | None) -> object:
    assert jpeg is not None
    return pytest.approx(Image.open(io.BytesIO(jpeg)).getpixel((3, 3)), abs=12)


def wait_for(done: Callable[[], bool]) -> None:
    ends_s = time.monotonic() + PATIENCE_S
    while not done():
        assert time.monotonic() < ends_s
        time.sleep(0.002)


class Robot:
    """A robot with a camera, on a wire in this process and a clock of its own."""

    def __init__(self) -> None:
        self.hub = MemoryHub()
        self.now_s = 50.0
        self.opened = 0
        self.sender = self.hub.connect()
        self.camera = WireCamera(self._open, "camera", lambda: self.now_s)

    def _open(self) -> Wire:
        self.opened += 1
        return self.hub.connect()

    @property
    def listeners(self) -> int:
        return len(self.hub.subscribers.get("camera", ()))

    def look(self) -> None:
        self.camera.begin()
        wait_for(lambda: self.listeners > 0)

    def show(self, colour: tuple[int, int, int] = RED, age_s: float = 0.0) -> None:
        self.sender.publish("camera", picture(self.now_s - age_s, colour))


@pytest.fixture
def robot() -> Iterator[Robot]:
    made = Robot()
    yield made
    made.camera.end()


def test_nothing_is_opened_before_a_model_looks_and_nothing_stays_open_after(robot: Robot) -> None:
    assert (robot.opened, robot.listeners, robot.camera.take()) == (0, 0, None)
    robot.look()
    robot.camera.begin()
    assert (robot.opened, robot.listeners) == (1, 1)
    robot.camera.end()
    wait_for(lambda: robot.listeners == 0)
    robot.camera.end()
    assert robot.camera.take() is None


def test_only_the_newest_picture_is_shown(robot: Robot) -> None:
    robot.look()
    robot.show(RED)
    robot.show(GREEN)
    assert colour_of(robot.camera.take()) == GREEN


def test_a_picture_from_before_is_not_shown_as_what_is_seen_now(robot: Robot) -> None:
    robot.look()
    robot.show(age_s=FRESH_S + 0.1)
    assert not robot.camera.has_picture
    robot.show()
    assert robot.camera.has_picture
    robot.now_s += FRESH_S + 0.1
    assert not robot.camera.has_picture
    assert robot.camera.take() is None


def test_a_look_after_the_end_of_the_last_begins_with_nothing(robot: Robot) -> None:
    robot.look()
    robot.show()
    robot.camera.end()
    wait_for(lambda: robot.listeners == 0)
    robot.look()
    assert not robot.camera.has_picture


def test_where_nobody_answers_there_is_no_picture() -> None:
    asked = threading.Event()

    def refuse() -> Wire:
        asked.set()
        raise WireError("nobody is there")

    camera = WireCamera(refuse, "camera")
    camera.begin()
    assert asked.wait(PATIENCE_S)
    assert (camera.has_picture, camera.take()) == (False, None)
    camera.end()


def test_a_robot_without_a_camera_has_none() -> None:
    assert wire_camera("dds://1", Wiring()) is None


# --- a model's turn ---


class Talk(ModelTalk):
    """A conversation with a robot whose camera shows something once somebody looks."""

    def __init__(self, patch: pytest.MonkeyPatch, robot: Robot, *replies: object) -> None:
        patch.setattr(compose, "_camera", lambda *_: robot.camera)
        self.robot = robot
        super().__init__(*replies, world="empty")  # type: ignore[arg-type]


def show_when_looked_at(robot: Robot, *colours: tuple[int, int, int]) -> threading.Thread:
    def show() -> None:
        wait_for(lambda: robot.listeners > 0)
        for colour in colours:
            robot.show(colour)

    thread = threading.Thread(target=show)
    thread.start()
    return thread


def test_a_model_that_looks_is_shown_what_the_robot_sees(
    monkeypatch: pytest.MonkeyPatch, robot: Robot
) -> None:
    talk = Talk(monkeypatch, robot, "look camera", 'say "a green ball"')
    showing = show_when_looked_at(robot, RED, GREEN)
    assert talk.do(ASKED).reply == "a green ball"
    showing.join()
    assert "camera" in talk.model.asked[0][0].text
    assert "the camera picture is attached" in talk.model.last
    assert talk.model.asked[-1][-1].picture is not None
    wait_for(lambda: robot.listeners == 0)


@pytest.mark.parametrize(
    "text",
    [
        "what do you see?",
        "Can you see a red ball?",
        "What colour is the box before you?",
        "你看到了什么",
        "前面的球是什么颜色？",
    ],
)
def test_who_asks_what_there_is_to_see_asks_the_model_where_there_is_a_camera(
    monkeypatch: pytest.MonkeyPatch, robot: Robot, text: str
) -> None:
    talk = Talk(monkeypatch, robot, 'say "a ball"')
    assert talk.do(text).reply == "a ball"


@pytest.mark.parametrize("text", ["where are you?", "which way are you facing?"])
def test_what_no_picture_shows_is_still_answered_here(
    monkeypatch: pytest.MonkeyPatch, robot: Robot, text: str
) -> None:
    talk = Talk(monkeypatch, robot, 'say "never asked"')
    assert talk.do(text).outcome == "answered"
    assert not talk.model.asked


def test_without_a_camera_the_lidar_answers() -> None:
    talk = ModelTalk('say "never asked"')
    assert talk.do("what do you see?").outcome == "answered"
    assert not talk.model.asked


def test_a_model_that_does_not_look_costs_the_camera_nothing(
    monkeypatch: pytest.MonkeyPatch, robot: Robot
) -> None:
    talk = Talk(monkeypatch, robot, "drive 0.2 m\nlook scan", 'say "done"')
    assert talk.do(ASKED).outcome == "completed"
    assert robot.opened == 0


def test_a_camera_that_is_silent_is_waited_for_a_moment_and_then_told(
    monkeypatch: pytest.MonkeyPatch, robot: Robot
) -> None:
    monkeypatch.setattr("chatrobot.dialogue.llm.looking.LOOK_S", 0.05)
    talk = Talk(monkeypatch, robot, "look camera", 'say "I see nothing"')
    assert talk.do(ASKED).outcome == "answered"
    assert "no camera picture" in talk.model.last


def test_a_stop_ends_the_wait_for_a_picture(monkeypatch: pytest.MonkeyPatch, robot: Robot) -> None:
    monkeypatch.setattr("chatrobot.dialogue.llm.looking.LOOK_S", 60.0)
    talk = Talk(monkeypatch, robot, "look camera")
    turn = talk.session.say(ASKED)
    talk.pump_until(lambda: robot.listeners > 0)
    talk.session.say("stop")
    talk.pump_until(lambda: turn in talk.session.results)
    assert talk.session.results[turn].outcome == "stopped"
    wait_for(lambda: robot.listeners == 0)


def test_an_older_picture_is_not_sent_and_paid_for_again(
    monkeypatch: pytest.MonkeyPatch, robot: Robot
) -> None:
    talk = Talk(monkeypatch, robot, "look camera", "look camera", 'say "I see"')
    showing = show_when_looked_at(robot, RED)
    talk.do(ASKED)
    showing.join()
    assert [message.picture is not None for message in talk.model.asked[-1]].count(True) == 1
    assert talk.model.asked[-1][-1].picture is not None


@pytest.mark.parametrize("code", ["model_rejected", "model_server_error", "model_not_found"])
def test_a_model_that_cannot_see_goes_on_in_words(
    monkeypatch: pytest.MonkeyPatch, robot: Robot, code: str
) -> None:
    refusal = Reason(code, {"model": "blind", "host": "here", "said": "no images", "status": 400})
    talk = Talk(monkeypatch, robot, "look camera", [refusal], 'say "I cannot see"', 'say "still not"')
    showing = show_when_looked_at(robot, RED)
    assert talk.do(ASKED).reply == "I cannot see"
    showing.join()
    assert not any(message.picture for message in talk.model.asked[-1])
    assert "model_cannot_see" in talk.codes()
    talk.do(ASKED)
    assert "camera" not in talk.model.asked[-1][0].text


def test_a_refusal_without_a_picture_is_not_repeated(monkeypatch: pytest.MonkeyPatch, robot: Robot) -> None:
    refusal = Reason("model_rejected", {"model": "x", "host": "here", "said": "no", "status": 400})
    talk = Talk(monkeypatch, robot, [refusal])
    assert talk.do(ASKED).outcome == "failed"
    assert len(talk.model.asked) == 1


# --- on real wires ---

sys.path.insert(0, str(Path(__file__).parents[1] / "wire"))
COMPRESSED = Wiring(camera_topic="eye/compressed", camera_type="CompressedImage")
RAW = Wiring(camera_topic="eye/raw")


def as_sent(wiring: Wiring) -> Picture:
    """A green picture of 640 by 480."""
    if wiring is RAW:
        return picture(time.monotonic(), GREEN, 480)
    file = io.BytesIO()
    Image.new("RGB", (640, 480), GREEN).save(file, "JPEG")
    return Picture(time.monotonic(), "jpeg", 0, 0, 0, file.getvalue())


def look_through(address: str, wiring: Wiring, send: Callable[[], None]) -> bytes | None:
    camera = wire_camera(address, wiring)
    assert camera is not None
    camera.begin()
    ends_s = time.monotonic() + PATIENCE_S
    while not camera.has_picture and time.monotonic() < ends_s:
        send()
        time.sleep(0.05)
    try:
        return camera.take()
    finally:
        camera.end()


@pytest.mark.parametrize("wiring", [RAW, COMPRESSED], ids=["raw", "compressed"])
def test_pictures_come_over_dds_and_nobody_listens_before_and_after(wiring: Wiring) -> None:
    pytest.importorskip("cyclonedds")
    from dds_rig import DOMAIN_ID, HERE

    from chatrobot.wire.dds.wire import DdsWire

    driver = DdsWire(wiring, "camera_driver", discovery=HERE)
    topic = wiring.camera_topic or ""
    assert not driver.wait_for_listener(topic, Picture, 0.2)
    seen = look_through(f"dds://{DOMAIN_ID}", wiring, lambda: driver.publish(topic, as_sent(wiring)))
    assert colour_of(seen) == GREEN
    wait_for(lambda: not driver.wait_for_listener(topic, Picture, 0.0))
    driver.close()


@pytest.mark.parametrize("wiring", [RAW, COMPRESSED], ids=["raw", "compressed"])
def test_pictures_come_over_rosbridge(wiring: Wiring) -> None:
    pytest.importorskip("websockets")
    from fake_rosbridge import FakeRosbridge

    from chatrobot.wire.rosbridge.wire import RosbridgeWire

    server = FakeRosbridge()
    driver = RosbridgeWire(server.url, wiring)
    topic = wiring.camera_topic or ""
    seen = look_through(f"rosbridge:{server.url}", wiring, lambda: driver.publish(topic, as_sent(wiring)))
    assert colour_of(seen) == GREEN
    driver.close()
    server.stop()


def test_pictures_come_over_the_local_wire(tmp_path: Path) -> None:
    from chatrobot.wire.local import LocalHub

    hub = LocalHub(tmp_path / "wire")
    topic = COMPRESSED.camera_topic or ""

    def send() -> None:
        hub.poll(0.0)
        hub.publish(topic, as_sent(COMPRESSED))

    assert colour_of(look_through(f"local:{tmp_path / 'wire'}", COMPRESSED, send)) == GREEN
    hub.close()
