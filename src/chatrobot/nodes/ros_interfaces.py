"""The ROS interfaces of a node: declared parameters, log, services and diagnostics."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, NamedTuple

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException

from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.wiring import Wiring
from chatrobot.nodes.log import Severity
from chatrobot.options import Parameter, Value
from chatrobot.wire.ros.convert import message_class
from chatrobot.wire.ros.node import RosNode
from chatrobot.wire.ros.wire import RosWire

SIMULATED_TIME_S = 10.0
"""A node that is to follow `/clock` waits so long for it."""
DIAGNOSTICS = "/diagnostics"
_ARRAY = "diagnostic_msgs/msg/DiagnosticArray"
_LEVELS = {"ok": b"\0", "warn": b"\1", "error": b"\2"}


class Diagnosis(NamedTuple):
    """How a node is: one diagnostic_msgs/DiagnosticStatus."""

    level: Literal["ok", "warn", "error"]
    message: str
    values: Mapping[str, object]


class RosInterfaces:
    """A ROS node with its parameters read, before anything else is known of it.

    Args:
        name: of the node, unless the arguments name it otherwise.
        parameters: what it declares.
        defaults: values that go before the declared defaults; ROS's own go before both.
        ros_args: what stood behind `--ros-args`.

    Raises:
        UsageError: an argument or a parameter cannot be used.
        WireError: ROS cannot be opened, or nobody tells the simulated time that is asked for.
    """

    def __init__(
        self,
        name: str,
        parameters: Sequence[Parameter],
        defaults: Mapping[str, Value],
        ros_args: Sequence[str],
        *,
        namespace: str = "",
        domain_id: int | None = None,
    ) -> None:
        self.node = RosNode(name, namespace=namespace, ros_args=ros_args, domain_id=domain_id)
        try:
            self.values: dict[str, Any] = {}
            for known in parameters:
                instead = known.open_loop if self.values.get("open_loop") else None
                default = defaults.get(known.name, known.default if instead is None else instead)
                self.values[known.name] = self._declare(known, default)
            if self.node.has_own_time and not self.node.wait_for_time(SIMULATED_TIME_S):
                raise WireError("use_sim_time is set, but nothing is published on /clock")
        except (UsageError, WireError):
            self.node.close()
            raise
        self._wire: RosWire | None = None

    def connect(self, _address: str, wiring: Wiring, _name: str) -> RosWire:
        """This node's end of the wire (a `chatrobot.wire.connect.Connect`)."""
        self._wire = RosWire(wiring, self.node)
        return self._wire

    def log(self, severity: Severity, text: str) -> None:
        """Into ROS's log (a `chatrobot.nodes.log.Write`)."""
        self.node.log(severity, text)

    def serve(self, name: str, act: Callable[[], tuple[bool, str]]) -> None:
        """Offer a std_srvs/Trigger. `act` gives success and a sentence; it runs on the node's thread."""
        from std_srvs.srv import Trigger

        def answer(_request: Any, response: Any) -> Any:
            response.success, response.message = act()
            return response

        self.node.handle.create_service(Trigger, name, answer)

    def diagnose(self, hardware: str, look: Callable[[], Diagnosis]) -> None:
        """Tell on /diagnostics how this node is, with the period of its parameter.

        Where ROS's message is not installed, the node does without and says so once.
        """
        try:
            message_class(_ARRAY)
        except UsageError as error:
            self.log("warn", f"There are no diagnostics: {error}.")
            return
        handle = self.node.handle
        name = f"{handle.get_namespace().rstrip('/')}/{handle.get_name()}"

        def tell() -> None:
            if self._wire is not None and not self.node.is_closed:
                self._wire.publish_fields(
                    DIAGNOSTICS, _ARRAY, _as_fields(name, hardware, look(), handle.get_clock().now())
                )

        period_s = self.values["diagnostics_period_s"]
        # Not ROS's time: a simulation that stands still must not silence this.
        handle.create_timer(period_s, tell, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _declare(self, parameter: Parameter, default: Value) -> Any:
        descriptor = ParameterDescriptor(description=parameter.description, read_only=True)
        if parameter.choices:
            descriptor.additional_constraints = f"one of {', '.join(parameter.choices)}"
        if parameter.bounds is not None:
            lowest, highest = parameter.bounds
            if isinstance(parameter.default, float):
                descriptor.floating_point_range = [FloatingPointRange(from_value=lowest, to_value=highest)]
            else:
                descriptor.integer_range = [IntegerRange(from_value=int(lowest), to_value=int(highest))]
        try:
            value = self.node.handle.declare_parameter(parameter.name, default, descriptor).value
        except (InvalidParameterTypeException, InvalidParameterValueException) as error:
            raise UsageError(str(error), where=parameter.name, allowed=parameter.description) from error
        if parameter.choices and value not in parameter.choices:
            raise UsageError(
                f"{value!r} cannot be used", where=parameter.name, allowed=", ".join(parameter.choices)
            )
        return value


def _as_fields(name: str, hardware: str, diagnosis: Diagnosis, now: Any) -> dict[str, Any]:
    sec, nanosec = now.seconds_nanoseconds()
    status = {
        "level": _LEVELS[diagnosis.level],
        "name": name,
        "message": diagnosis.message,
        "hardware_id": hardware,
        "values": [{"key": key, "value": str(value)} for key, value in diagnosis.values.items()],
    }
    return {"header": {"stamp": {"sec": sec, "nanosec": nanosec}}, "status": [status]}
