"""The part of `rclpy.node.Node` that knows names: its own, and who else is there."""

from __future__ import annotations

import time
from typing import Any

from chatrobot.programs.inside import graph, ros_names
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy._rclpy_pybind11 import NodeNameNonExistentError
from chatrobot.programs.names.rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException
from chatrobot.programs.names.rclpy.node_checks import raise_for

LOOKS_EVERY_S = 0.1


class NodeGraph:
    """Resolves names and looks around within the program."""

    handle: Any

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        raise_for(ros_names.topic_name_problem(topic), InvalidTopicNameException, topic)
        with self.handle:
            names = self.handle
            return ros_names.resolve(topic, names.name, names.namespace, {} if only_expand else names.topics)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        raise_for(ros_names.topic_name_problem(service), InvalidServiceNameException, service)
        with self.handle:
            names = self.handle
            return ros_names.resolve(
                service, names.name, names.namespace, {} if only_expand else names.services
            )

    def count_publishers(self, topic_name: str) -> int:
        return graph.count_publishers(self.resolve_topic_name(topic_name))

    def count_subscribers(self, topic_name: str) -> int:
        name = self.resolve_topic_name(topic_name)
        return graph.count_subscriptions(name) + (name == get_link().settings.topics.get("cmd_vel"))

    def get_topic_names_and_types(self, no_demangle: bool = False) -> list[tuple[str, list[str]]]:
        return graph.topic_types()

    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]:
        return graph.service_types()

    def get_node_names(self) -> list[str]:
        return [node.handle.name for node in graph.nodes]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return [(node.handle.name, node.handle.namespace) for node in graph.nodes]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        return [(*names, "/") for names in self.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        return [node.handle.full_name for node in graph.nodes]

    def count_clients(self, service_name: str) -> int:
        name = self.resolve_service_name(service_name)
        return sum(client.service_name == name for node in graph.nodes for client in node.clients)

    def count_services(self, service_name: str) -> int:
        name = self.resolve_service_name(service_name)
        return sum(service.service_name == name for node in graph.nodes for service in node.services)

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> list[tuple[str, list[str]]]:
        return _topics(_node(node_name, node_namespace).publishers)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> list[tuple[str, list[str]]]:
        return _topics(_node(node_name, node_namespace).subscriptions)

    def get_service_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> list[tuple[str, list[str]]]:
        return _services(_node(node_name, node_namespace).services)

    def get_client_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> list[tuple[str, list[str]]]:
        return _services(_node(node_name, node_namespace).clients)

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[Any]:
        return self.__info(topic_name, "publishers")

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[Any]:
        return self.__info(topic_name, "subscriptions")

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Nodes outside the program are not seen."""
        until_s = time.monotonic() + timeout
        while fully_qualified_node_name not in self.get_fully_qualified_node_names():
            if time.monotonic() >= until_s:
                return False
            time.sleep(LOOKS_EVERY_S)
        return True

    def __info(self, topic_name: str, kind: str) -> list[Any]:
        name = self.resolve_topic_name(topic_name)
        return [
            TopicEndpointInfo(node, entity)
            for node in graph.nodes
            for entity in getattr(node, kind)
            if entity.topic_name == name
        ]


class TopicEndpointInfo:
    """Who publishes on a topic or listens to it."""

    def __init__(self, node: Any, entity: Any) -> None:
        self.node_name = node.handle.name
        self.node_namespace = node.handle.namespace
        self.topic_type = entity.msg_type._type_name
        self.qos_profile = entity.qos_profile


def _node(name: str, namespace: str) -> Any:
    for node in graph.nodes:
        if (node.handle.name, node.handle.namespace) == (name, namespace):
            return node
    raise NodeNameNonExistentError(
        f"Cannot get the topics or services of a nonexistent node: {namespace}/{name}"
    )


def _topics(entities: Any) -> list[tuple[str, list[str]]]:
    return sorted((entity.topic_name, [entity.msg_type._type_name]) for entity in entities)


def _services(entities: Any) -> list[tuple[str, list[str]]]:
    return sorted((entity.service_name, [entity.srv_type._type_name]) for entity in entities)
