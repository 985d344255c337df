"""The part of `rclpy.node.Node` that knows names: its own, which are allowed, and who else is there."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from typing import Any

from chatrobot.programs.inside import graph
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.errors import (
    InvalidServiceNameException,
    InvalidTopicNameException,
    NodeNameNonExistentError,
)

LOOKS_EVERY_S = 0.1


class NodeGraph:
    """Resolves names and looks around within the program."""

    handle: Any

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        raise_for(topic_name_problem(topic), InvalidTopicNameException, topic)
        with self.handle:
            names = self.handle
            return resolve(topic, names.name, names.namespace, {} if only_expand else names.topics)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        raise_for(topic_name_problem(service), InvalidServiceNameException, service)
        with self.handle:
            names = self.handle
            return resolve(service, names.name, names.namespace, {} if only_expand else names.services)

    def count_publishers(self, topic_name: str) -> int:
        return len(graph.publishers[self.resolve_topic_name(topic_name)])

    def count_subscribers(self, topic_name: str) -> int:
        name = self.resolve_topic_name(topic_name)
        return len(graph.subscriptions[name]) + (name == get_link().settings.topics.get("cmd_vel"))

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


_SUBSTITUTION = re.compile(r"\{(\w*)\}")


def node_name_problem(name: str) -> tuple[str, int] | None:
    """What is wrong with a node's name and where; None where nothing is."""
    if not name:
        return "node name must not be empty", 0
    if name[0].isdigit():
        return "node name must not start with a number", 0
    return _bad_character("node name", name, "")


def topic_name_problem(name: str) -> tuple[str, int] | None:
    """What is wrong with a topic's or service's name as a program writes it, and where."""
    if not name:
        return "topic name must not be empty string", 0
    if name.endswith("/"):
        return "topic name must not end with a forward slash", len(name) - 1
    bad = _bad_character("topic name", name, "/~{}")
    if bad is not None:
        return bad
    if "~" in name[1:]:
        return "topic name must not have tilde '~' unless it is the first character", name.index("~", 1)
    if "//" in name:
        return "topic name must not contain repeated '/'", name.index("//") + 1
    at = 0
    for token in name.split("/"):
        if token[:1].isdigit():
            return "topic name token must not start with a number", at
        at += len(token) + 1
    return None


def namespace_problem(namespace: str) -> tuple[str, int] | None:
    if not namespace.startswith("/"):
        return "namespace must be absolute, it must lead with a '/'", 0
    problem = None if namespace == "/" else topic_name_problem(namespace)
    if problem is None:
        return None
    words = problem[0].replace(
        "topic name token must not start", "namespace must not have a token that starts"
    )
    return words.replace("topic name", "namespace").replace("'_', '~', '{', or '}'", "'_', or '/'"), problem[
        1
    ]


def resolve(name: str, node_name: str, namespace: str, remaps: Mapping[str, str]) -> str:
    """The full name, after remapping (by the written or by the full name)."""
    full = _expand(name, node_name, namespace)
    for source, target in remaps.items():
        if source == name or _expand(source, node_name, namespace) == full:
            return _expand(target, node_name, namespace)
    return full


def _expand(name: str, node_name: str, namespace: str) -> str:
    base = namespace.rstrip("/")
    name = _SUBSTITUTION.sub(lambda found: _substitute(name, found.group(1), node_name, base), name)
    if name.startswith("/"):
        return name
    if name.startswith("~"):
        return f"{base}/{node_name}{name[1:]}"
    return f"{base}/{name}"


def _substitute(name: str, word: str, node_name: str, namespace: str) -> str:
    values = {"node": node_name, "ns": namespace, "namespace": namespace}
    if word not in values:
        raise ValueError(f"topic name '{name}' is invalid: unknown substitution: {{{word}}}")
    return values[word].lstrip("/")


def _bad_character(what: str, name: str, also: str) -> tuple[str, int] | None:
    others = ", '_', '~', '{', or '}'" if also else " or '_'"
    for at, letter in enumerate(name):
        if not (letter.isascii() and (letter.isalnum() or letter == "_" or letter in also)):
            return f"{what} must not contain characters other than alphanumerics{others}", at
    return None


def raise_for(problem: tuple[str, int] | None, kind: Callable[[str, str, int], Exception], name: str) -> None:
    if problem is not None:
        raise kind(name, *problem)
