"""rclpy._rclpy_pybind11: the exceptions that programs may meet of what is C++ in ROS."""


class RCLError(RuntimeError):
    """A call failed below rclpy."""


class InvalidHandle(RuntimeError):
    """What is used has been destroyed."""


DESTROYED = "cannot use Destroyable because destruction was requested"
