"""One topic's writer or reader, and what goes through it: planar messages on our side, ROS messages on the other."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any, NamedTuple

from cyclonedds.core import (
    DDSException,
    DDSStatus,
    InstanceState,
    Policy,
    Qos,
    ReadCondition,
    SampleState,
    ViewState,
    WaitSet,
)
from cyclonedds.domain import DomainParticipant
from cyclonedds.internal import InvalidSample
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from chatrobot.core.errors import WireError
from chatrobot.wire.dds.definitions import MALFORMED
from chatrobot.wire.dds.ros_types import CdrSample, RosTypes
from chatrobot.wire.messages import Message
from chatrobot.wire.ros_messages import Listener, RosForm, with_wall_stamp
from chatrobot.wire.stamps import StampTranslator

_WRITE_DEPTH = 10
"""ROS's; how much a reader keeps nobody asks."""
_TAKE_AT_ONCE = 64
_ANY = SampleState.Any | ViewState.Any | InstanceState.Any


class Port(NamedTuple):
    """A topic as ROS sees it. `best_effort`: its publishers may use the QoS of sensors; `depth`: of a reader.

    `is_kept`: of a writer, whose last message goes to readers that come later, too, as ROS's transient local
    publishers do it.
    """

    dds_topic: str
    form: RosForm
    best_effort: bool
    depth: int = 1
    is_kept: bool = False


class Writer:
    """Publishes on one topic. Any thread may; nothing waits for a listener that does not read."""

    def __init__(self, participant: DomainParticipant, types: RosTypes, port: Port) -> None:
        self._types, self._form = types, port.form
        name = port.form.type_name
        topic: Any = Topic(participant, port.dds_topic, types.topic_type(name))
        # Reliable and volatile is what default ROS endpoints ask for. The blocking time stays at zero: a queue of
        # old velocities for a frozen listener would help nobody.
        qos = Qos(
            Policy.Reliability.Reliable(0),
            Policy.History.KeepLast(1 if port.is_kept else _WRITE_DEPTH),
            Policy.Durability.TransientLocal if port.is_kept else Policy.Durability.Volatile,
            types.typehash(name),
        )
        self._participant = participant
        self._writer: DataWriter[Any] = DataWriter(participant, topic, qos)
        self.guid = self._writer.get_guid()

    def write(self, message: Message) -> None:
        """Send; dropped where a listener does not keep up.

        Raises:
            WireError: the wire is closed.
        """
        self.write_fields(self._form.to_ros(with_wall_stamp(message)))

    def write_fields(self, fields: Mapping[str, Any]) -> None:
        """Send a ROS message as nested dictionaries; as `write` otherwise."""
        try:
            self._writer.write(self._types.sample(self._form.type_name, fields))
        except DDSException as error:
            if error.code != DDSException.DDS_RETCODE_TIMEOUT:
                raise WireError(f"publishing failed: {error}") from error

    def listener_count(self) -> int:
        """Return how many listeners are known."""
        status: Any = self._writer.get_publication_matched_status()  # type: ignore[no-untyped-call]
        return int(status.current_count)

    def wait_for_listeners(self, count: int, timeout_s: float) -> bool:
        """Block until at least `count` listen; False where they don't in time."""
        ends_s = time.monotonic() + timeout_s
        self._writer.set_status_mask(DDSStatus.PublicationMatched)
        waitset = WaitSet(self._participant)
        waitset.attach(self._writer)
        while self.listener_count() < count:
            left_s = ends_s - time.monotonic()
            if left_s <= 0.0:
                return False
            waitset.wait(duration(seconds=left_s))
        return True


class Reader(Listener):
    """Listens on one topic for all callbacks of this end."""

    def __init__(
        self,
        participant: DomainParticipant,
        types: RosTypes,
        port: Port,
    ) -> None:
        super().__init__(port.form)
        self._types = types
        name = port.form.type_name
        topic: Any = Topic(participant, port.dds_topic, types.topic_type(name))
        reliability = Policy.Reliability.BestEffort if port.best_effort else Policy.Reliability.Reliable(0)
        qos = Qos(
            reliability,
            Policy.History.KeepLast(port.depth),
            Policy.Durability.Volatile,
            # Other programs may name a message's fields as they like: ROS matches by the type's name.
            Policy.TypeConsistency.AllowTypeCoercion(True, True, True, False, False),
            types.typehash(name),
        )
        self._reader: DataReader[Any] = DataReader(participant, topic, qos)
        self.condition = ReadCondition(self._reader, _ANY)
        self.guid = self._reader.get_guid()
        self._clocks: dict[int, StampTranslator] = {}

    def deliver(self) -> None:
        """Hand what has come to the callbacks."""
        for sample in self._reader.take(_TAKE_AT_ONCE):
            if isinstance(sample, InvalidSample):
                continue  # a publisher has left
            self._deliver_one(sample)

    def _deliver_one(self, sample: CdrSample) -> None:
        received_s = time.monotonic()
        try:
            ros_message = self._types.read(self.form.type_name, sample.cdr)
        except MALFORMED:
            return  # a wire never dies of a bad packet
        clock = self._clocks.setdefault(sample.sample_info.publication_handle, StampTranslator())
        self.hear(ros_message, lambda stamp_s: clock.local_s(stamp_s, received_s))
