"""The message and service types that programs import, in the syntax of ROS's own .msg and .srv files, one a line.

A type without a package is of the package it stands in; `Header` is std_msgs's.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from chatrobot.programs.inside.messages import REGISTRY, message, service

_TABLE = """\
[builtin_interfaces.msg]
Time, Duration: int32 sec; uint32 nanosec
[std_msgs.msg]
Bool: bool data
Byte: byte data
Char: char data
ColorRGBA: float32 r; float32 g; float32 b; float32 a
Empty:
Float32: float32 data
Float64: float64 data
Header: builtin_interfaces/Time stamp; string frame_id
Int8: int8 data
Int16: int16 data
Int32: int32 data
Int64: int64 data
String: string data
UInt8: uint8 data
UInt16: uint16 data
UInt32: uint32 data
UInt64: uint64 data
MultiArrayDimension: string label; uint32 size; uint32 stride
MultiArrayLayout: MultiArrayDimension[] dim; uint32 data_offset
Float32MultiArray: MultiArrayLayout layout; float32[] data
Float64MultiArray: MultiArrayLayout layout; float64[] data
Int32MultiArray: MultiArrayLayout layout; int32[] data
UInt8MultiArray: MultiArrayLayout layout; uint8[] data
[geometry_msgs.msg]
Vector3, Point: float64 x; float64 y; float64 z
Point32: float32 x; float32 y; float32 z
Quaternion: float64 x 0; float64 y 0; float64 z 0; float64 w 1
Pose: Point position; Quaternion orientation
Pose2D: float64 x; float64 y; float64 theta
Transform: Vector3 translation; Quaternion rotation
Twist, Accel: Vector3 linear; Vector3 angular
Wrench: Vector3 force; Vector3 torque
Polygon: Point32[] points
PoseWithCovariance: Pose pose; float64[36] covariance
TwistWithCovariance: Twist twist; float64[36] covariance
PointStamped: Header header; Point point
PoseStamped: Header header; Pose pose
PoseArray: Header header; Pose[] poses
PoseWithCovarianceStamped: Header header; PoseWithCovariance pose
QuaternionStamped: Header header; Quaternion quaternion
TransformStamped: Header header; string child_frame_id; Transform transform
TwistStamped: Header header; Twist twist
TwistWithCovarianceStamped: Header header; TwistWithCovariance twist
Vector3Stamped: Header header; Vector3 vector
PolygonStamped: Header header; Polygon polygon
[nav_msgs.msg]
Odometry: Header header; string child_frame_id; geometry_msgs/PoseWithCovariance pose;
    geometry_msgs/TwistWithCovariance twist
Path: Header header; geometry_msgs/PoseStamped[] poses
MapMetaData: builtin_interfaces/Time map_load_time; float32 resolution; uint32 width; uint32 height;
    geometry_msgs/Pose origin
OccupancyGrid: Header header; MapMetaData info; int8[] data
GridCells: Header header; float32 cell_width; float32 cell_height; geometry_msgs/Point[] cells
[sensor_msgs.msg]
LaserScan: Header header; float32 angle_min; float32 angle_max; float32 angle_increment; float32 time_increment;
    float32 scan_time; float32 range_min; float32 range_max; float32[] ranges; float32[] intensities
Imu: Header header; geometry_msgs/Quaternion orientation; float64[9] orientation_covariance;
    geometry_msgs/Vector3 angular_velocity; float64[9] angular_velocity_covariance;
    geometry_msgs/Vector3 linear_acceleration; float64[9] linear_acceleration_covariance
BatteryState: Header header; float32 voltage; float32 temperature; float32 current; float32 charge;
    float32 capacity; float32 design_capacity; float32 percentage; uint8 power_supply_status;
    uint8 power_supply_health; uint8 power_supply_technology; bool present; float32[] cell_voltage;
    float32[] cell_temperature; string location; string serial_number
Image: Header header; uint32 height; uint32 width; string encoding; uint8 is_bigendian; uint32 step; uint8[] data
CompressedImage: Header header; string format; uint8[] data
JointState: Header header; string[] name; float64[] position; float64[] velocity; float64[] effort
Joy: Header header; float32[] axes; int32[] buttons
Range: Header header; uint8 radiation_type; float32 field_of_view; float32 min_range; float32 max_range;
    float32 range; float32 variance; uint8 ULTRASOUND=0; uint8 INFRARED=1
Temperature: Header header; float64 temperature; float64 variance
NavSatStatus: int8 status -2; uint16 service
NavSatFix: Header header; NavSatStatus status; float64 latitude; float64 longitude; float64 altitude;
    float64[9] position_covariance; uint8 position_covariance_type
PointField: string name; uint32 offset; uint8 datatype; uint32 count
PointCloud2: Header header; uint32 height; uint32 width; PointField[] fields; bool is_bigendian; uint32 point_step;
    uint32 row_step; uint8[] data; bool is_dense
[rcl_interfaces.msg]
ParameterType: uint8 PARAMETER_NOT_SET=0; uint8 PARAMETER_BOOL=1; uint8 PARAMETER_INTEGER=2;
    uint8 PARAMETER_DOUBLE=3; uint8 PARAMETER_STRING=4; uint8 PARAMETER_BYTE_ARRAY=5; uint8 PARAMETER_BOOL_ARRAY=6;
    uint8 PARAMETER_INTEGER_ARRAY=7; uint8 PARAMETER_DOUBLE_ARRAY=8; uint8 PARAMETER_STRING_ARRAY=9
ParameterValue: uint8 type; bool bool_value; int64 integer_value; float64 double_value; string string_value;
    byte[] byte_array_value; bool[] bool_array_value; int64[] integer_array_value; float64[] double_array_value;
    string[] string_array_value
Parameter: string name; ParameterValue value
FloatingPointRange: float64 from_value; float64 to_value; float64 step
IntegerRange: int64 from_value; int64 to_value; uint64 step
ParameterDescriptor: string name; uint8 type; string description; string additional_constraints; bool read_only;
    bool dynamic_typing; FloatingPointRange[<=1] floating_point_range; IntegerRange[<=1] integer_range
ParameterEvent: builtin_interfaces/Time stamp; string node; Parameter[] new_parameters;
    Parameter[] changed_parameters; Parameter[] deleted_parameters
ListParametersResult: string[] names; string[] prefixes
SetParametersResult: bool successful; string reason
Log: builtin_interfaces/Time stamp; uint8 level; string name; string msg; string file; string function; uint32 line
[example_interfaces.msg]
Bool: bool data
Float64: float64 data
Int64: int64 data
String: string data
[turtlesim.msg]
Pose: float32 x; float32 y; float32 theta; float32 linear_velocity; float32 angular_velocity
Color: uint8 r; uint8 g; uint8 b
[example_interfaces.srv]
AddTwoInts: int64 a; int64 b --- int64 sum
SetBool: bool data --- bool success; string message
Trigger: --- bool success; string message
[std_srvs.srv]
Empty: ---
SetBool: bool data --- bool success; string message
Trigger: --- bool success; string message
[turtlesim.srv]
Kill: string name ---
SetPen: uint8 r; uint8 g; uint8 b; uint8 width; uint8 off ---
Spawn: float32 x; float32 y; float32 theta; string name --- string name
TeleportAbsolute: float32 x; float32 y; float32 theta ---
TeleportRelative: float32 linear; float32 angular ---
"""


def kind(type_name: str) -> type[Any]:
    """Return the message class of that name, `package/Name`."""
    return REGISTRY[type_name]


def _made() -> Iterator[ModuleType]:
    sections = re.split(r"^\[(.+)\]\n", _TABLE.replace("\n    ", " "), flags=re.MULTILINE)[1:]
    for module_name, lines in zip(sections[::2], sections[1::2]):
        module = ModuleType(module_name, module_name)
        package, _, sort = module_name.partition(".")
        for line in lines.splitlines():
            names, fields = line.split(":", 1)
            for name in names.split(", "):
                type_name = f"{package}/{name}"
                made = (
                    message(type_name, fields) if sort == "msg" else service(type_name, *fields.split("---"))
                )
                setattr(module, name, made)
        yield module


INTERFACES = {module.__name__: module for module in _made()}
"""The modules of the table, by what programs call them."""
