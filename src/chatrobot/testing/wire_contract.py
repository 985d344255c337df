"""The promises of every wire, as tests: inherit `WireContract` and say how two ends are joined."""

from __future__ import annotations

import math
import queue
import threading
from collections.abc import Callable, Iterator
from typing import Generic

import pytest

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.wiring import Wiring
from chatrobot.execution.sensors import Sensors
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from chatrobot.wire import messages as sent
from chatrobot.wire.messages import Flag, LaserScan, Message, Number, Picture, Text
from chatrobot.wire.wire import M, Wire

Connect = Callable[[], Wire]
"""Makes a further end of one and the same wire."""
PATIENCE_S = 10.0
CAMERA = Wiring(camera_topic="camera", camera_type="CompressedImage")
"""How the ends of this suite are wired."""

ONE_OF_EACH: tuple[Message, ...] = (
    sent.TwistMessage(0.3, -0.1, 0.6),
    sent.Odometry(1.5, 1.0, 2.0, 3.0, 0.1, 0.2, 0.3),
    sent.Imu(1.5, 0.25),
    LaserScan(1.5, -math.pi, 0.0175, 0.05, 12.0, [1.0, math.inf, 0.07]),
    Picture(1.5, "rgb8", 2, 2, 8, bytes(range(0, 160, 10))),
    Flag(True),
    Number(87.5),
    Text("去厨房 — go to the kitchen"),
)
_ROWS = sent.PICTURE_BYTES // 512
_LARGEST = bytes(i * i % 251 for i in range(512 * _ROWS))
_SENT = [(type(message).__name__, "topic", message) for message in ONE_OF_EACH] + [
    ("large scan", "scan", LaserScan(1.0, -math.pi, 0.001, 0.05, 40.0, [i / 7.0 for i in range(6000)])),
    ("large picture", "camera/image_raw", Picture(1.0, "mono8", 512, _ROWS, 512, _LARGEST)),
    ("camera's own file", "camera", Picture(1.0, "jpeg", 0, 0, 0, b"\xff\xd8\xff and what follows")),
]


class Inbox(Generic[M]):
    """A listener on a topic, which is known to be listening once it is made."""

    def __init__(self, wire: Wire, topic: str, kind: type[M]) -> None:
        self._queue: queue.Queue[M] = queue.Queue()
        wire.subscribe(topic, kind, self._queue.put)
        heard = threading.Event()
        sync_topic = f"sync/{topic.strip('/')}/n{id(self)}"  # ROS's names do not begin with a digit
        wire.subscribe(sync_topic, Flag, lambda _: heard.set())
        wire.publish(sync_topic, Flag(True))
        assert heard.wait(PATIENCE_S)

    def next(self) -> M:
        """Return the next message, in the order they came."""
        return self._queue.get(timeout=PATIENCE_S)

    def take(self, count: int) -> list[M]:
        """Return the next `count` messages."""
        return [self.next() for _ in range(count)]


class WireContract:
    """Inherited by a test class that has a fixture `connect`: it makes a further end of one and the same wire."""

    sees_open_space = True
    """Infinity in a scan arrives as what it is: that nothing is there (REP-117)."""

    @pytest.fixture
    def connect(self) -> Iterator[Connect]:
        """Make a further end of one and the same wire; close them all after the test."""
        raise NotImplementedError("a class with the contract of wires needs a fixture 'connect'")

    def as_it_arrives(self, message: Message) -> object:
        """Return what equals `message` at the other end, where a backend's format rounds or translates clocks."""
        return message

    @pytest.mark.parametrize(("topic", "message"), [case[1:] for case in _SENT], ids=[c[0] for c in _SENT])
    def test_a_message_arrives_as_it_was_sent(self, connect: Connect, topic: str, message: Message) -> None:
        inbox = Inbox(connect(), topic, type(message))
        connect().publish(topic, message)
        arrived = inbox.next()
        assert type(arrived) is type(message)
        assert self.as_it_arrives(message) == arrived

    def test_a_text_with_half_a_character_ends_nothing(self, connect: Connect) -> None:
        inbox, sender = Inbox(connect(), "topic", Text), connect()
        sender.publish("topic", Text("half \ud800"))
        sender.publish("topic", Text("after"))
        assert inbox.take(2)[-1] == Text("after")

    def test_messages_arrive_in_the_order_they_were_sent(self, connect: Connect) -> None:
        inbox, sender = Inbox(connect(), "topic", Number), connect()
        for i in range(20):
            sender.publish("topic", Number(float(i)))
        assert inbox.take(20) == [Number(float(i)) for i in range(20)]

    def test_all_who_listen_hear_it_the_sender_and_each_callback_of_one_end_too(
        self, connect: Connect
    ) -> None:
        sender, other = connect(), connect()
        inboxes = [Inbox(wire, "topic", Text) for wire in (connect(), other, other, sender)]
        sender.publish("topic", Text("stop"))
        assert [inbox.next() for inbox in inboxes] == [Text("stop")] * 4

    def test_another_topic_or_type_is_not_delivered(self, connect: Connect) -> None:
        inbox, sender = Inbox(connect(), "topic", Number), connect()
        sender.publish("topic", Text("not a number"))
        for other in ("topic2", "topi", "other/topic", "Topic"):
            sender.publish(other, Number(1.0))
        sender.publish("topic", Number(2.0))
        assert inbox.next() == Number(2.0)

    def test_publishing_where_nobody_listens_is_fine(self, connect: Connect) -> None:
        connect().publish("nobody/listens", Number(1.0))

    @pytest.mark.parametrize("range_m", [math.nan, 0.0, -1.0, -math.inf])
    def test_a_scan_that_measured_nothing_is_blind_and_open_space_is_not(
        self, connect: Connect, range_m: float
    ) -> None:
        receiver, sender = connect(), connect()
        sensors = Sensors(load_profile(DEFAULT_PROFILE), RealClock())
        sensors.attach(receiver)
        inbox = Inbox(receiver, "scan", LaserScan)
        for ranges_m in ([range_m] * 8, [math.inf] * 8):
            assert sensors.scan is None
            sender.publish("scan", LaserScan(1.0, -math.pi, math.tau / 8, 0.05, 12.0, ranges_m))
            inbox.next()
        assert (sensors.scan is not None) == self.sees_open_space

    def test_a_callback_may_publish_and_subscribe(self, connect: Connect) -> None:
        wire, asker = connect(), connect()
        replies = Inbox(asker, "reply", Number)

        def answer(message: Number) -> None:
            wire.subscribe("question", Number, lambda _: None)
            wire.publish("reply", Number(message.data + 1.0))

        wire.subscribe("question", Number, answer)
        Inbox(wire, "settled", Flag)
        asker.publish("question", Number(1.0))
        assert replies.next() == Number(2.0)

    def test_a_closed_end_publishes_and_hears_nothing_and_the_others_go_on(self, connect: Connect) -> None:
        leaver, sender = connect(), connect()
        Inbox(leaver, "topic", Number)
        inbox = Inbox(connect(), "topic", Number)
        leaver.close()
        leaver.close()
        with pytest.raises(WireError):
            leaver.publish("topic", Number(1.0))
        with pytest.raises(WireError):
            leaver.subscribe("topic", Number, lambda _: None)
        sender.publish("topic", Number(2.0))
        assert inbox.next() == Number(2.0)

    def test_a_callback_may_close_its_own_end(self, connect: Connect) -> None:
        wire, sender = connect(), connect()
        closed = threading.Event()

        def leave(_: Number) -> None:
            wire.close()
            closed.set()

        wire.subscribe("topic", Number, leave)
        Inbox(wire, "settled", Flag)
        sender.publish("topic", Number(1.0))
        assert closed.wait(PATIENCE_S)
