"""What every wire promises. A backend inherits the tests by a subclass that says how its ends are joined."""

from __future__ import annotations

import math
import queue
import threading
from collections.abc import Callable, Iterator
from typing import Generic, TypeVar

import pytest

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.wiring import Wiring
from chatrobot.execution.sensors import Sensors
from chatrobot.robots.load import load_profile
from chatrobot.wire.messages import (
    PICTURE_BYTES,
    Flag,
    Imu,
    LaserScan,
    Message,
    Number,
    Odometry,
    Picture,
    Text,
    TwistMessage,
)
from chatrobot.wire.wire import Wire

M = TypeVar("M", bound=Message)
PATIENCE_S = 10.0
CAMERA = Wiring(camera_topic="camera", camera_type="CompressedImage")
"""How the ends of this suite are wired."""

ONE_OF_EACH: tuple[Message, ...] = (
    TwistMessage(0.3, -0.1, 0.6),
    Odometry(1.5, 1.0, 2.0, 3.0, 0.1, 0.2, 0.3),
    Imu(1.5, 0.25),
    LaserScan(1.5, -math.pi, 0.0175, 0.05, 12.0, [1.0, math.inf, 0.07]),
    Picture(1.5, "rgb8", 2, 2, 8, bytes(range(0, 160, 10))),
    Flag(True),
    Number(87.5),
    Text("去厨房 — go to the kitchen"),
)


class Inbox(Generic[M]):
    """Listens on a topic, and is known to be listening once it is made."""

    def __init__(self, wire: Wire, topic: str, kind: type[M]) -> None:
        self._queue: queue.Queue[M] = queue.Queue()
        wire.subscribe(topic, kind, self._queue.put)
        heard = threading.Event()
        sync_topic = f"sync/{topic.strip('/')}/n{id(self)}"  # ROS's names do not begin with a digit
        wire.subscribe(sync_topic, Flag, lambda _: heard.set())
        wire.publish(sync_topic, Flag(True))
        assert heard.wait(PATIENCE_S)

    def next(self) -> M:
        return self._queue.get(timeout=PATIENCE_S)

    def take(self, count: int) -> list[M]:
        return [self.next() for _ in range(count)]


class WireContract:
    @pytest.fixture
    def connect(self) -> Iterator[Callable[[], Wire]]:
        """Makes a further end of one and the same wire."""
        raise NotImplementedError

    def as_it_arrives(self, message: Message) -> object:
        """What equals `message` at the other end, where a backend's format rounds or translates clocks."""
        return message

    sees_open_space = True
    """Whether infinity arrives as what it is: that nothing is there (REP-117)."""

    @pytest.mark.parametrize("message", ONE_OF_EACH, ids=lambda message: type(message).__name__)
    def test_every_kind_of_message_arrives_as_it_was_sent(
        self, connect: Callable[[], Wire], message: Message
    ) -> None:
        inbox = Inbox(connect(), "topic", type(message))
        connect().publish("topic", message)
        arrived = inbox.next()
        assert type(arrived) is type(message)
        assert self.as_it_arrives(message) == arrived

    def test_a_text_with_half_a_character_ends_nothing(self, connect: Callable[[], Wire]) -> None:
        inbox = Inbox(connect(), "topic", Text)
        sender = connect()
        sender.publish("topic", Text("half \ud800"))
        sender.publish("topic", Text("after"))
        assert inbox.take(2)[-1] == Text("after")

    def test_messages_arrive_in_the_order_they_were_sent(self, connect: Callable[[], Wire]) -> None:
        inbox = Inbox(connect(), "topic", Number)
        sender = connect()
        for i in range(20):
            sender.publish("topic", Number(float(i)))
        assert inbox.take(20) == [Number(float(i)) for i in range(20)]

    def test_all_who_listen_hear_it(self, connect: Callable[[], Wire]) -> None:
        inboxes = [Inbox(connect(), "topic", Number) for _ in range(3)]
        connect().publish("topic", Number(1.0))
        assert [inbox.next() for inbox in inboxes] == [Number(1.0)] * 3

    def test_two_callbacks_of_one_end_both_hear_it(self, connect: Callable[[], Wire]) -> None:
        wire = connect()
        inboxes = [Inbox(wire, "topic", Number) for _ in range(2)]
        connect().publish("topic", Number(1.0))
        assert [inbox.next() for inbox in inboxes] == [Number(1.0)] * 2

    def test_a_sender_that_listens_hears_itself(self, connect: Callable[[], Wire]) -> None:
        wire = connect()
        inbox = Inbox(wire, "topic", Text)
        wire.publish("topic", Text("stop"))
        assert inbox.next() == Text("stop")

    def test_a_message_of_another_type_is_not_delivered(self, connect: Callable[[], Wire]) -> None:
        inbox = Inbox(connect(), "topic", Number)
        sender = connect()
        sender.publish("topic", Text("not a number"))
        sender.publish("topic", Number(2.0))
        assert inbox.next() == Number(2.0)

    def test_a_topic_nobody_here_asked_for_is_not_delivered(self, connect: Callable[[], Wire]) -> None:
        inbox = Inbox(connect(), "topic", Number)
        sender = connect()
        for other in ("topic2", "topi", "other/topic", "Topic"):
            sender.publish(other, Number(1.0))
        sender.publish("topic", Number(2.0))
        assert inbox.next() == Number(2.0)

    def test_publishing_where_nobody_listens_is_fine(self, connect: Callable[[], Wire]) -> None:
        connect().publish("nobody/listens", Number(1.0))

    def test_a_large_scan_passes(self, connect: Callable[[], Wire]) -> None:
        inbox = Inbox(connect(), "scan", LaserScan)
        scan = LaserScan(1.0, -math.pi, 0.001, 0.05, 40.0, [i / 7.0 for i in range(6000)])
        connect().publish("scan", scan)
        assert self.as_it_arrives(scan) == inbox.next()

    @pytest.mark.parametrize("range_m", [math.nan, 0.0, -1.0, -math.inf])
    def test_a_scan_that_measured_nothing_is_blind_and_open_space_is_not(
        self, connect: Callable[[], Wire], range_m: float
    ) -> None:
        receiver, sender = connect(), connect()
        sensors = Sensors(load_profile("wheeltec_mini_mec"), RealClock())
        sensors.attach(receiver)
        inbox = Inbox(receiver, "scan", LaserScan)
        for ranges_m in ([range_m] * 8, [math.inf] * 8):
            assert sensors.scan is None
            sender.publish("scan", LaserScan(1.0, -math.pi, math.tau / 8, 0.05, 12.0, ranges_m))
            inbox.next()
        assert (sensors.scan is not None) == self.sees_open_space

    def test_a_picture_passes(self, connect: Callable[[], Wire]) -> None:
        inbox = Inbox(connect(), "camera/image_raw", Picture)
        rows = PICTURE_BYTES // 512
        picture = Picture(1.0, "mono8", 512, rows, 512, bytes(i * i % 251 for i in range(512 * rows)))
        connect().publish("camera/image_raw", picture)
        assert self.as_it_arrives(picture) == inbox.next()

    def test_a_picture_of_the_camera_arrives_as_the_file_it_is(self, connect: Callable[[], Wire]) -> None:
        inbox = Inbox(connect(), "camera", Picture)
        picture = Picture(1.0, "jpeg", 0, 0, 0, b"\xff\xd8\xff and what follows")
        connect().publish("camera", picture)
        assert self.as_it_arrives(picture) == inbox.next()

    def test_a_callback_may_publish_and_subscribe(self, connect: Callable[[], Wire]) -> None:
        wire, asker = connect(), connect()
        replies = Inbox(asker, "reply", Number)

        def answer(message: Number) -> None:
            wire.subscribe("question", Number, lambda _: None)
            wire.publish("reply", Number(message.data + 1.0))

        wire.subscribe("question", Number, answer)
        Inbox(wire, "settled", Flag)
        asker.publish("question", Number(1.0))
        assert replies.next() == Number(2.0)

    def test_publishing_after_closing_is_an_error(self, connect: Callable[[], Wire]) -> None:
        wire = connect()
        wire.close()
        with pytest.raises(WireError):
            wire.publish("topic", Number(1.0))

    def test_subscribing_after_closing_is_an_error(self, connect: Callable[[], Wire]) -> None:
        wire = connect()
        wire.close()
        with pytest.raises(WireError):
            wire.subscribe("topic", Number, lambda _: None)

    def test_closing_twice_does_no_harm(self, connect: Callable[[], Wire]) -> None:
        wire = connect()
        Inbox(wire, "topic", Number)
        wire.close()
        wire.close()

    def test_the_others_go_on_when_one_leaves(self, connect: Callable[[], Wire]) -> None:
        leaver, stayer, sender = connect(), connect(), connect()
        Inbox(leaver, "topic", Number)
        inbox = Inbox(stayer, "topic", Number)
        leaver.close()
        sender.publish("topic", Number(1.0))
        assert inbox.next() == Number(1.0)

    def test_a_callback_may_close_its_own_end(self, connect: Callable[[], Wire]) -> None:
        wire, sender = connect(), connect()
        closed = threading.Event()

        def leave(_: Number) -> None:
            wire.close()
            closed.set()

        wire.subscribe("topic", Number, leave)
        Inbox(wire, "settled", Flag)
        sender.publish("topic", Number(1.0))
        assert closed.wait(PATIENCE_S)
