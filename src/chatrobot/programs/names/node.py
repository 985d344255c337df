"""rclpy.node

A program derives from `Node`. So nothing here has a name that rclpy's has not, for a method or an attribute of the
program could take its place; and what is used of `self` is what rclpy uses, so that an override which breaks rclpy's
constructor breaks this one.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import FunctionType
from typing import Any

from chatrobot.programs.inside import graph
from chatrobot.programs.inside.interfaces import kind
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.clock import Clock, ROSClock
from chatrobot.programs.names.context import get_default_context, parsed
from chatrobot.programs.names.errors import (
    Destroyable,
    InvalidNamespaceException,
    InvalidNodeNameException,
    NotInitializedException,
)
from chatrobot.programs.names.logging import RcutilsLogger, get_logger
from chatrobot.programs.names.node_entities import NodeEntities, destroy
from chatrobot.programs.names.node_graph import NodeGraph, namespace_problem, node_name_problem, raise_for
from chatrobot.programs.names.node_parameters import NodeParameters
from chatrobot.programs.names.qos import qos_profile_parameter_events
from chatrobot.programs.names.task import CallbackGroup, MutuallyExclusiveCallbackGroup
from chatrobot.programs.ros_args import RosArguments

PARAMETER_EVENTS = "/parameter_events"
ParameterEvent = kind("rcl_interfaces/ParameterEvent")


class NodeHandle(Destroyable):
    """The names of a node, as its program and the arguments have them."""

    def __init__(self, name: str, namespace: str | None, arguments: RosArguments) -> None:
        super().__init__()
        given = arguments.namespace(name)
        space = (namespace or "") if given is None else given
        self.name = arguments.node_name(name)
        self.namespace = space if space.startswith("/") else f"/{space}"
        raise_for(node_name_problem(self.name), InvalidNodeNameException, self.name)
        raise_for(namespace_problem(self.namespace), InvalidNamespaceException, self.namespace)
        self.topics = arguments.names(name, "topic")
        for topic, led_to in get_link().settings.remaps.items():
            self.topics.setdefault(topic, led_to)
        self.services = arguments.names(name, "service")
        self.parameters = arguments.values(self.name)

    @property
    def full_name(self) -> str:
        return f"{self.namespace.rstrip('/')}/{self.name}"


class Node(NodeEntities, NodeParameters):
    """What a program's class derives from."""

    def __init__(
        self,
        node_name: str,
        *,
        context: Any = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: list[Any] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
        rosout_qos_profile: Any = None,
    ) -> None:
        self._context = get_default_context() if context is None else context
        NodeEntities.__init__(self)
        self.__waitables: list[Any] = []
        self.__executor: Any = None
        self._default_callback_group = MutuallyExclusiveCallbackGroup()
        if not self._context.ok():
            raise NotInitializedException("cannot create node")
        given = self._context._ros_arguments if use_global_arguments else RosArguments()
        self.__node = NodeHandle(node_name, namespace, given.overridden_by(parsed(cli_args or ())))
        with self.handle:
            self._logger = get_logger(self.__node.full_name.strip("/").replace("/", "."))
        graph.nodes.append(self)
        self._parameter_event_publisher = self.create_publisher(
            ParameterEvent, PARAMETER_EVENTS, qos_profile_parameter_events
        )
        self._clock = ROSClock()
        overrides = {**self.__node.parameters, **{p.name: p.value for p in parameter_overrides or ()}}
        NodeParameters.__init__(
            self, overrides, allow_undeclared_parameters, automatically_declare_parameters_from_overrides
        )

    # --- what it is ---

    def get_name(self) -> str:
        with self.handle:
            return str(self.handle.name)

    def get_namespace(self) -> str:
        with self.handle:
            return str(self.handle.namespace)

    def get_fully_qualified_name(self) -> str:
        with self.handle:
            return str(self.handle.full_name)

    def get_logger(self) -> RcutilsLogger:
        return self._logger

    def get_clock(self) -> Clock:
        return self._clock

    @property
    def context(self) -> Any:
        return self._context

    @property
    def handle(self) -> Any:
        return self.__node

    @handle.setter
    def handle(self, value: Any) -> None:
        raise AttributeError("handle cannot be modified after node creation")

    @property
    def default_callback_group(self) -> CallbackGroup:
        return self._default_callback_group

    @property
    def waitables(self) -> Iterator[Any]:
        yield from tuple(self.__waitables)

    def add_waitable(self, waitable: Any) -> None:
        """Nothing in the box waits for one."""
        self.__waitables.append(waitable)
        self._wake_executor()

    def remove_waitable(self, waitable: Any) -> None:
        self.__waitables.remove(waitable)
        self._wake_executor()

    @property
    def executor(self) -> Any:
        return self.__executor

    @executor.setter
    def executor(self, new_executor: Any) -> None:
        previous = self.__executor
        if previous is new_executor:
            return
        self.__executor = new_executor
        if previous is not None:
            previous.remove_node(self)
        if new_executor is not None:
            new_executor.add_node(self)

    def _wake_executor(self) -> None:
        executor = self.executor
        if executor:
            executor.wake()

    def destroy_node(self) -> None:
        """Everything it made is destroyed; a second time does nothing."""
        if self.__executor is not None:
            self.__executor.remove_node(self)
        for entities in (
            self._publishers, self._subscriptions, self._clients, self._services, self._timers, self._guards,
        ):  # fmt: skip
            for entity in tuple(entities):
                destroy(entities, entity)
        self.__node.destroy_when_not_in_use()
        if self in graph.nodes:
            graph.nodes.remove(self)


for _part in (NodeEntities, NodeGraph, NodeParameters):
    for _name, _value in vars(_part).items():
        if isinstance(_value, FunctionType):
            _value.__qualname__ = f"Node.{_name}"  # what a complaint about its arguments calls it
