"""The part of `rclpy.node.Node` that knows names: its own, and who else is there."""

from __future__ import annotations

from chatrobot.programs.inside import graph, ros_names
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException
from chatrobot.programs.names.rclpy.node_checks import raise_for


class NodeGraph:
    """Resolves names and looks around within the program."""

    _name: str
    _namespace: str

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        raise_for(ros_names.topic_name_problem(topic), InvalidTopicNameException, topic)
        remaps = {} if only_expand else get_link().settings.remaps
        return ros_names.resolve(topic, self._name, self._namespace, remaps)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        raise_for(ros_names.topic_name_problem(service), InvalidServiceNameException, service)
        remaps = {} if only_expand else get_link().settings.remaps
        return ros_names.resolve(service, self._name, self._namespace, remaps)

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
        return [node.get_name() for node in graph.nodes]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return [(node.get_name(), node.get_namespace()) for node in graph.nodes]
