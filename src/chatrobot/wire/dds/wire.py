"""The wire over DDS: one participant, one thread that delivers, any thread publishes."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from cyclonedds.core import DDSException, GuardCondition, WaitSet
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.internal import dds_infinity

from chatrobot.core.errors import WireError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.dds.endpoints import Port, Reader, Writer
from chatrobot.wire.dds.fence import fence_in
from chatrobot.wire.dds.graph import Graph, dds_topic_name, participant_qos
from chatrobot.wire.dds.ros_types import RosTypes
from chatrobot.wire.discovery import Discovery, configuration, discovery_from, machine_addresses
from chatrobot.wire.messages import Message
from chatrobot.wire.ros_messages import RosForm, is_sensor, read_depth, ros_form
from chatrobot.wire.wire import Endpoint, M, Wire

_GID_24_DISTRIBUTIONS = ("foxy", "galactic", "humble", "iron")

_domains: dict[int, Domain] = {}
_domains_lock = threading.Lock()


class DdsWire(Wire):
    """A process's end of a DDS domain, a ROS 2 node to others. They meet within about 0.1 s, not at once: what is
    published before a listener is found is lost, so `wait_for_listener` where a single message matters.

    Relative topics are the robot's (`rt/<namespace>/<topic>`), absolute ones (`/clock`) are taken as they are.

    Args:
        wiring: the robot's topics and types.
        node_name: how we appear in `ros2 node list`.
        namespace: of the robot, `robot1`; empty for none.
        discovery: whom to meet; by default what the environment asks for.

    Raises:
        WireError: DDS cannot be opened here.
        UsageError: an environment variable cannot be used.
    """

    knows_others = True
    sees_others_leave = True

    def __init__(
        self, wiring: Wiring, node_name: str, *, namespace: str = "", discovery: Discovery | None = None
    ) -> None:
        discovery = discovery or discovery_from(os.environ)
        distribution = os.environ.get("ROS_DISTRO", "").lower()
        self._types = RosTypes(24 if distribution in _GID_24_DISTRIBUTIONS else 16)
        self._wiring = wiring
        self.namespace = namespace.strip("/")
        self._lock = threading.Lock()
        self._writers: dict[tuple[str, object], Writer] = {}
        self._readers: dict[tuple[str, type], Reader] = {}
        self._closed = False
        with _as_wire_error(f"DDS cannot be opened on domain {discovery.domain_id}"):
            _open_domain(discovery)
            participant = DomainParticipant(discovery.domain_id, participant_qos())
            self._participant: DomainParticipant | None = participant
            self._graph: Graph | None = Graph(participant, self._types, node_name, f"/{self.namespace}")
            self._waitset: WaitSet | None = WaitSet(participant)
            self._wake = GuardCondition(participant)
            self._waitset.attach(self._wake)
            self._graph.announce((), ())
        self._thread = threading.Thread(target=self._deliver, args=(self._waitset,), name="dds", daemon=True)
        self._thread.start()

    def publish(self, topic: str, message: Message) -> None:
        writer = self._writers.get((topic, type(message)))
        if writer is None:
            writer = self._open_writer(topic, type(message))
        writer.write(message)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        with self._lock, _as_wire_error(f"cannot listen on {topic}"):
            participant, waitset, graph = self._open()
            reader = self._readers.get((topic, kind))
            if reader is None:
                reader = Reader(participant, self._types, self._port(topic, kind))
                reader.callbacks = (callback,)
                self._readers = {**self._readers, (topic, kind): reader}
                waitset.attach(reader.condition)
                self._announce(graph)
            else:
                reader.callbacks = (*reader.callbacks, callback)

    def publish_fields(
        self, topic: str, type_name: str, fields: Mapping[str, Any], *, is_kept: bool = False
    ) -> None:
        writer = self._writers.get((topic, type_name))
        if writer is None:
            form = RosForm(type_name, dict, lambda _: None)
            port = Port(self._name(topic), form, best_effort=False, is_kept=is_kept)
            writer = self._open_writer(topic, type_name, port)
        writer.write_fields(fields)

    def advertise(self, topic: str, kind: type[Message]) -> None:
        if (topic, kind) not in self._writers:
            self._open_writer(topic, kind)

    def wait_for_listener(self, topic: str, kind: type[Message], timeout_s: float, count: int = 1) -> bool:
        return self._open_writer(topic, kind).wait_for_listeners(count, timeout_s)

    def publishers_of(self, topic: str) -> list[str]:
        graph = self._graph
        with _as_wire_error(f"cannot see who publishes {topic}"):
            return [] if graph is None else graph.publishers_of(self._name(topic))

    def rewire(self, wiring: Wiring) -> None:
        self._wiring = wiring

    def survey(self) -> list[Endpoint]:
        graph = self._graph
        with _as_wire_error("cannot see who is there"):
            return [] if graph is None else graph.endpoints()

    def resolve(self, topic: str) -> str:
        return "/" + self._name(topic).removeprefix("rt/")

    def close(self) -> None:
        with self._lock:
            if self._closed:
                return
            self._closed = True
        self._wake.set(True)
        if self._thread is not threading.current_thread():
            self._thread.join()
        with self._lock:
            # Cyclone frees what nobody refers to any more.
            self._writers, self._readers = {}, {}
            self._waitset = self._graph = self._participant = None

    def _deliver(self, waitset: WaitSet) -> None:
        while not self._closed:
            waitset.wait(dds_infinity)
            for reader in tuple(self._readers.values()):
                if not self._closed:
                    reader.deliver()

    def _open_writer(self, topic: str, kind: Any, port: Port | None = None) -> Writer:
        with self._lock, _as_wire_error(f"cannot publish on {topic}"):
            participant, _, graph = self._open()
            writer = self._writers.get((topic, kind))
            if writer is None:
                writer = Writer(participant, self._types, port or self._port(topic, kind))
                self._writers = {**self._writers, (topic, kind): writer}
                self._announce(graph)
            return writer

    def _open(self) -> tuple[DomainParticipant, WaitSet, Graph]:
        if self._closed or self._participant is None or self._waitset is None or self._graph is None:
            raise WireError("this end of the wire is closed")
        return self._participant, self._waitset, self._graph

    def _port(self, topic: str, kind: type[Any]) -> Port:
        form = ros_form(topic, kind, self._wiring)
        return Port(self._name(topic), form, is_sensor(topic, kind, self._wiring), read_depth(kind))

    def _name(self, topic: str) -> str:
        return dds_topic_name(topic, self.namespace)

    def _announce(self, graph: Graph) -> None:
        graph.announce(
            [reader.guid for reader in self._readers.values()],
            [writer.guid for writer in self._writers.values()],
        )


def _open_domain(discovery: Discovery) -> None:
    """Cyclone configures a domain once a process; the reference must live as long as its participants."""
    with _domains_lock:
        if discovery.domain_id not in _domains:
            addresses = machine_addresses()
            config = configuration(discovery, addresses)
            _domains[discovery.domain_id] = Domain(discovery.domain_id, config)
            if discovery.this_machine_only:
                try:
                    fence_in(discovery.domain_id, addresses)
                except OSError as error:
                    raise WireError(
                        f"this system cannot keep DDS to this machine ({error}); to speak to the whole network"
                        " set ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET"
                    ) from error


@contextlib.contextmanager
def _as_wire_error(what: str) -> Iterator[None]:
    try:
        yield
    except DDSException as error:
        raise WireError(f"{what}: {error}") from error
