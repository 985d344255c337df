"""rclpy.exceptions and rclpy._rclpy_pybind11: what rclpy raises, and what stands below all that a node makes."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any


class RCLError(RuntimeError):
    """A call failed below rclpy."""


class NodeNameNonExistentError(RCLError):
    """There is no such node to look at."""


class RCLInvalidROSArgsError(RCLError):
    """What stands behind `--ros-args` cannot be read."""


class UnknownROSArgsError(RuntimeError):
    """Behind `--ros-args` stands what ROS does not know."""


class InvalidHandle(RuntimeError):
    """What is used has been destroyed."""


class Destroyable:
    """What stands below an entity; `with` it the entity can be used, until it was destroyed."""

    def __init__(self) -> None:
        self.is_destroyed = False

    def __enter__(self) -> None:
        if self.is_destroyed:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")

    def __exit__(self, *_: object) -> None:
        """It is still there."""

    def destroy_when_not_in_use(self) -> None:
        self.is_destroyed = True


class Entity:
    """Something that a node made, which a callback group has: usable until it was destroyed."""

    def __init__(self, handle: Destroyable) -> None:
        self.__handle = handle

    @property
    def handle(self) -> Any:
        return self.__handle

    def destroy(self) -> None:
        self.__handle.destroy_when_not_in_use()


class Queue(Destroyable):
    """What waits at an entity until an executor takes it; `wake` is the executor's."""

    def __init__(self, wake: Callable[[], None], name: str) -> None:
        super().__init__()
        self.wake = wake
        self.name = name
        self.queue: deque[Any] = deque()

    @property
    def is_waiting(self) -> bool:
        return bool(self.queue)

    def put(self, item: Any) -> None:
        self.queue.append(item)
        self.wake()


class NotInitializedException(Exception):
    """Something was used before `rclpy.init()`."""

    def __init__(self, message: str | None = None) -> None:
        text = "rclpy.init() has not been called."
        super().__init__(f"{text} msg:{message}" if message else text)


class NameValidationException(Exception):
    """A name that ROS does not take."""

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__(f"Invalid {name_type}: {error_msg}:\n  '{name}'\n   {' ' * invalid_index}^")


class InvalidNamespaceException(NameValidationException):
    """Of a node."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidNodeNameException(NameValidationException):
    """Of a node."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("node name", name, error_msg, invalid_index)


class InvalidTopicNameException(NameValidationException):
    """Of a topic."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("topic name", name, error_msg, invalid_index)


class InvalidServiceNameException(NameValidationException):
    """Of a service."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("service name", name, error_msg, invalid_index)


class ParameterException(Exception):
    """Base of what is wrong with parameters."""

    def __init__(self, error_msg: str, parameters: str | list[str]) -> None:
        super().__init__(f"{error_msg}: {parameters}")


class ParameterNotDeclaredException(ParameterException):
    """Used, but never declared."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("Invalid access to undeclared parameter(s)", parameters)


class ParameterAlreadyDeclaredException(ParameterException):
    """Declared twice."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("Parameter(s) already declared", parameters)


class InvalidParameterException(ParameterException):
    """A name that no parameter can have."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Invalid parameter name", parameter_name)


class InvalidParameterTypeException(ParameterException):
    """A value of another type than the parameter has."""

    def __init__(self, desired_parameter: Any, expected_type: str) -> None:
        name, value, kind = desired_parameter.name, desired_parameter.value, desired_parameter.type_.name
        super().__init__(
            f"Trying to set parameter '{name}' to '{value}' of type '{kind}', expecting type '{expected_type}'",
            name,
        )


class InvalidParameterValueException(ParameterException):
    """A value that a callback or the descriptor does not allow."""

    def __init__(self, parameter: str, value: Any, reason: str) -> None:
        super().__init__(f"Invalid parameter value ({value}) for parameter. Reason: {reason}", parameter)


class ParameterImmutableException(ParameterException):
    """A read-only parameter."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter_name)


class ParameterUninitializedException(ParameterException):
    """Declared with a type, but without a value."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(f"The parameter '{parameter_name}' is not initialized", parameter_name)


class ROSInterruptException(Exception):
    """rclpy was shut down while something slept."""

    def __init__(self) -> None:
        super().__init__("rclpy.shutdown() has been called")
