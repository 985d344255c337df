"""ROS messages as rosidl generates them for Python, as far as our nodes use them: typed, zeroed, checked on setting.

Humble's checks: a float field takes floats alone. Jazzy as installed leaves them out; what passes here passes there.
"""

from __future__ import annotations

from array import array
from types import ModuleType
from typing import Any, ClassVar

_DEFINITIONS = {
    "std_msgs/Bool": "bool data",
    "std_msgs/Float64": "double data",
    "std_msgs/String": "string data",
    "builtin_interfaces/Time": "int32 sec, uint32 nanosec",
    "std_msgs/Header": "builtin_interfaces/Time stamp, string frame_id",
    "geometry_msgs/Vector3": "double x, double y, double z",
    "geometry_msgs/Point": "double x, double y, double z",
    "geometry_msgs/Quaternion": "double x, double y, double z, double w",
    "geometry_msgs/Twist": "geometry_msgs/Vector3 linear, geometry_msgs/Vector3 angular",
    "geometry_msgs/TwistStamped": "std_msgs/Header header, geometry_msgs/Twist twist",
    "geometry_msgs/Pose": "geometry_msgs/Point position, geometry_msgs/Quaternion orientation",
    "geometry_msgs/PoseWithCovariance": "geometry_msgs/Pose pose",
    "geometry_msgs/TwistWithCovariance": "geometry_msgs/Twist twist",
    "geometry_msgs/Transform": "geometry_msgs/Vector3 translation, geometry_msgs/Quaternion rotation",
    "geometry_msgs/TransformStamped": "std_msgs/Header header, string child_frame_id, "
    "geometry_msgs/Transform transform",
    "tf2_msgs/TFMessage": "sequence<geometry_msgs/TransformStamped> transforms",
    "nav_msgs/Odometry": "std_msgs/Header header, string child_frame_id, geometry_msgs/PoseWithCovariance pose, "
    "geometry_msgs/TwistWithCovariance twist",
    "sensor_msgs/Imu": "std_msgs/Header header, geometry_msgs/Vector3 angular_velocity",
    "sensor_msgs/LaserScan": "std_msgs/Header header, float angle_min, float angle_max, float angle_increment, "
    "float range_min, float range_max, sequence<float> ranges",
    "sensor_msgs/Image": "std_msgs/Header header, uint32 height, uint32 width, string encoding, "
    "uint8 is_bigendian, uint32 step, sequence<uint8> data",
    "sensor_msgs/CompressedImage": "std_msgs/Header header, string format, sequence<uint8> data",
    "sensor_msgs/BatteryState": "float percentage, bool present",
    "diagnostic_msgs/KeyValue": "string key, string value",
    "diagnostic_msgs/DiagnosticStatus": "octet level, string name, string message, string hardware_id, "
    "sequence<diagnostic_msgs/KeyValue> values",
    "diagnostic_msgs/DiagnosticArray": "std_msgs/Header header, sequence<diagnostic_msgs/DiagnosticStatus> status",
}
_ZEROS: dict[str, Any] = {
    "bool": False, "double": 0.0, "float": 0.0, "string": "", "octet": b"\0", "int32": 0, "uint32": 0,
    "uint8": 0,
}  # fmt: skip
_SEQUENCES = {"float": "f", "double": "d", "uint8": "B"}


class Message:
    """Base of all: only known fields, only values of their type."""

    FIELDS: ClassVar[dict[str, str]] = {}

    def __init__(self) -> None:
        for name, kind in self.FIELDS.items():
            object.__setattr__(self, name, _zero(kind))

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        return dict(cls.FIELDS)

    def __setattr__(self, name: str, value: Any) -> None:
        kind = self.FIELDS.get(name)
        if kind is None:
            raise AttributeError(f"'{type(self).__name__}' object has no attribute '{name}'")
        expected = type(_zero(kind))
        if expected is array and isinstance(value, list):
            value = array(_SEQUENCES[kind[9:-1]], value)
        assert isinstance(value, expected), f"The '{name}' field must be of type '{expected.__name__}'"
        if isinstance(value, list):
            assert all(isinstance(item, CLASSES[kind[9:-1]]) for item in value)
        object.__setattr__(self, name, value)


def _zero(kind: str) -> Any:
    if kind in _ZEROS:
        return _ZEROS[kind]
    if kind.startswith("sequence<"):
        inner = kind[9:-1]
        return array(_SEQUENCES[inner]) if inner in _SEQUENCES else []
    return CLASSES[kind]()


def _make(name: str, definition: str) -> type[Message]:
    fields = {field: kind for kind, field in (part.split() for part in definition.split(", "))}
    return type(name.partition("/")[2], (Message,), {"FIELDS": fields})


CLASSES: dict[str, type[Message]] = {name: _make(name, text) for name, text in _DEFINITIONS.items()}


def modules() -> dict[str, ModuleType]:
    """`geometry_msgs`, `geometry_msgs.msg` and so on, for `sys.modules`."""
    made: dict[str, ModuleType] = {}
    for name, known in CLASSES.items():
        package, _, short = name.partition("/")
        for module in (package, f"{package}.msg"):
            made.setdefault(module, ModuleType(module))
        setattr(made[f"{package}.msg"], short, known)
    return made
