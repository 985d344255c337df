"""Who is on the domain, and how we appear to the others (`ros2 node list`, `ros2 topic info`)."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterable, Iterator
from typing import Any, Literal

from cyclonedds.builtin import (
    BuiltinDataReader,
    BuiltinTopicDcpsParticipant,
    BuiltinTopicDcpsPublication,
    BuiltinTopicDcpsSubscription,
)
from cyclonedds.core import InstanceState, Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.internal import InvalidSample
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from chatrobot.core.errors import WireError
from chatrobot.wire.dds.definitions import MALFORMED
from chatrobot.wire.dds.ros_types import RosTypes
from chatrobot.wire.wire import Endpoint

_INFO_TOPIC = "ros_discovery_info"
_INFO_TYPE = "rmw_dds_common/msg/ParticipantEntitiesInfo"
_INFO_QOS = (Policy.Reliability.Reliable(0), Policy.Durability.TransientLocal)
_MANY = 1000
_OWN_ID = "CHATROBOT_ID"


def dds_topic_name(topic: str, namespace: str) -> str:
    """`cmd_vel` in namespace `robot1` is `rt/robot1/cmd_vel`; `/clock` is `rt/clock` in every namespace.

    Raises:
        WireError: no topic can be called that.
    """
    name = topic[1:] if topic.startswith("/") else f"{namespace.strip('/')}/{topic}".lstrip("/")
    parts = name.split("/")
    if not all(part.isascii() and part.replace("_", "a").isalnum() for part in parts):
        raise WireError(f"{topic!r} is not a topic name: letters, digits, _ and / between them")
    return f"rt/{name}"


def ros_topic_name(dds_topic: str) -> str:
    """`rt/robot1/odom` is `/robot1/odom`; empty for what is no ROS topic."""
    return dds_topic[2:] if dds_topic.startswith("rt/") else ""


def ros_type_name(dds_type: str) -> str:
    """`nav_msgs::msg::dds_::Odometry_` is `nav_msgs/msg/Odometry`; empty for what is no ROS message."""
    package, _, short = dds_type.partition("::msg::dds_::")
    return f"{package}/msg/{short.removesuffix('_')}" if short else ""


def own_id() -> str:
    """Return what marks the processes of one session as ours: made once, inherited by the processes we start."""
    return os.environ.setdefault(_OWN_ID, uuid.uuid4().hex)


def participant_qos() -> Qos:
    """Return how a participant of ours introduces itself."""
    return Qos(Policy.Userdata(f"enclave=/;chatrobot={own_id()};".encode()))


class Graph:
    """The participants and endpoints seen from one participant of ours.

    Args:
        name: our node's name.
        namespace: our node's namespace, `/` or `/robot1`.
    """

    def __init__(self, participant: DomainParticipant, types: RosTypes, name: str, namespace: str) -> None:
        self._types = types
        self._name, self._namespace = name, namespace
        self._guid = participant.get_guid()
        topic = Topic(participant, _INFO_TOPIC, types.topic_type(_INFO_TYPE))
        typehash = types.typehash(_INFO_TYPE)
        self._writer = DataWriter(participant, topic, Qos(*_INFO_QOS, Policy.History.KeepLast(1), typehash))
        self._infos = DataReader(participant, topic, Qos(*_INFO_QOS, Policy.History.KeepAll, typehash))
        self._nodes: dict[uuid.UUID, str] = {}
        self._participants = BuiltinDataReader(participant, BuiltinTopicDcpsParticipant)
        self._publications = BuiltinDataReader(participant, BuiltinTopicDcpsPublication)
        self._subscriptions = BuiltinDataReader(participant, BuiltinTopicDcpsSubscription)

    def announce(self, readers: Iterable[uuid.UUID], writers: Iterable[uuid.UUID]) -> None:
        """Say which endpoints are our node's; ROS lists a node once it has heard this."""
        node = {
            "node_namespace": self._namespace,
            "node_name": self._name,
            "reader_gid_seq": [self._gid(guid) for guid in readers],
            "writer_gid_seq": [self._gid(guid) for guid in writers],
        }
        fields = {"gid": self._gid(self._guid), "node_entities_info_seq": [node]}
        self._writer.write(self._types.sample(_INFO_TYPE, fields))

    def publishers_of(self, dds_topic: str) -> list[str]:
        """Return who else publishes there, sorted: node names where they tell them, otherwise process and host.

        Processes of the same session as this one (`own_id`) are left out.
        """
        strangers = self._strangers()
        nodes = self._hear_nodes()
        return sorted(
            {
                nodes.get(publication.key) or strangers[publication.participant_key]
                for publication in _alive(self._publications)
                if publication.topic_name == dds_topic and publication.participant_key in strangers
            }
        )

    def endpoints(self) -> list[Endpoint]:
        """The ROS topics' endpoints of all other participants."""
        return [
            *self._others(self._publications, "publishes"),
            *self._others(self._subscriptions, "listens"),
        ]

    def _others(self, reader: Any, role: Literal["publishes", "listens"]) -> Iterator[Endpoint]:
        for sample in _alive(reader):
            topic, type_name = ros_topic_name(sample.topic_name), ros_type_name(sample.type_name)
            if topic and type_name and sample.participant_key != self._guid:
                yield Endpoint(topic, type_name, role)

    def _strangers(self) -> dict[uuid.UUID, str]:
        """The participants that are not of our session: GUID and process."""
        return {
            participant.key: _process(participant.qos)
            for participant in _alive(self._participants)
            if _userdata(participant.qos).get("chatrobot") != own_id()
        }

    def _hear_nodes(self) -> dict[uuid.UUID, str]:
        """Node names by the GUID of their writers, as far as they have told."""
        for sample in self._infos.take(_MANY):
            if isinstance(sample, InvalidSample):
                continue
            try:
                info = self._types.read(_INFO_TYPE, sample.cdr)
                for node in info.node_entities_info_seq:
                    full_name = f"{node.node_namespace.rstrip('/')}/{node.node_name}"
                    for gid in node.writer_gid_seq:
                        self._nodes[uuid.UUID(bytes=bytes(gid.data)[:16])] = full_name
            except MALFORMED:
                continue  # another distribution's length of GIDs
        return self._nodes

    def _gid(self, guid: uuid.UUID) -> dict[str, Any]:
        length = len(self._types.message("rmw_dds_common/msg/Gid", {}).data)
        return {"data": list(guid.bytes.ljust(length, b"\0"))}


def _alive(reader: Any) -> list[Any]:
    """Those that are still there: who has left stays readable, with another state."""
    return [
        sample
        for sample in reader.read(_MANY)
        if sample.sample_info.valid_data and sample.sample_info.instance_state == InstanceState.Alive
    ]


def _userdata(qos: Qos) -> dict[str, str]:
    """The pairs of `key=value;` that ROS and we put there."""
    userdata = next((policy.data for policy in qos if isinstance(policy, Policy.Userdata)), b"")
    text = bytes(userdata).decode(errors="replace")
    return dict(pair.split("=", 1) for pair in text.split(";") if "=" in pair)


def _process(qos: Qos) -> str:
    """Return what a participant tells of its process; Cyclone and Fast DDS have keys of their own."""
    told = {policy.key: policy.value for policy in qos if isinstance(policy, Policy.Property)}
    name = told.get("__ProcessName") or told.get("fastdds.physical_data.process") or "a process"
    host = told.get("__Hostname") or told.get("fastdds.physical_data.host", "")
    return f"{name} {told.get('__Pid', '')}".strip() + (f" on {host}" if host else "")
