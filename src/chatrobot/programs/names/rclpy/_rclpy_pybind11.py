"""rclpy._rclpy_pybind11: what programs may meet of what is C++ in ROS: exceptions and handles."""

from __future__ import annotations


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
