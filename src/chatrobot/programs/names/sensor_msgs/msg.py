"""sensor_msgs.msg"""

from chatrobot.programs.inside.messages import message
from chatrobot.programs.names.geometry_msgs import msg as _geometry_msgs  # noqa: F401

_HEADER = "std_msgs/Header header; "

LaserScan = message(
    "sensor_msgs/LaserScan",
    _HEADER
    + "float32 angle_min; float32 angle_max; float32 angle_increment; float32 time_increment; float32 scan_time;"
    "float32 range_min; float32 range_max; float32[] ranges; float32[] intensities",
)
Imu = message(
    "sensor_msgs/Imu",
    _HEADER + "geometry_msgs/Quaternion orientation; float64[9] orientation_covariance;"
    "geometry_msgs/Vector3 angular_velocity; float64[9] angular_velocity_covariance;"
    "geometry_msgs/Vector3 linear_acceleration; float64[9] linear_acceleration_covariance",
)
BatteryState = message(
    "sensor_msgs/BatteryState",
    _HEADER + "float32 voltage; float32 temperature; float32 current;"
    "float32 charge; float32 capacity; float32 design_capacity;"
    "float32 percentage; uint8 power_supply_status; uint8 power_supply_health; uint8 power_supply_technology;"
    "bool present; float32[] cell_voltage; float32[] cell_temperature; string location; string serial_number",
)
Image = message(
    "sensor_msgs/Image",
    _HEADER + "uint32 height; uint32 width; string encoding; uint8 is_bigendian; uint32 step; uint8[] data",
)
CompressedImage = message("sensor_msgs/CompressedImage", _HEADER + "string format; uint8[] data")
JointState = message(
    "sensor_msgs/JointState",
    _HEADER + "string[] name; float64[] position; float64[] velocity; float64[] effort",
)
Joy = message("sensor_msgs/Joy", _HEADER + "float32[] axes; int32[] buttons")
Range = message(
    "sensor_msgs/Range",
    _HEADER + "uint8 radiation_type; float32 field_of_view; float32 min_range; float32 max_range;"
    "float32 range; float32 variance",
    ULTRASOUND=0,
    INFRARED=1,
)
Temperature = message("sensor_msgs/Temperature", _HEADER + "float64 temperature; float64 variance")
NavSatStatus = message("sensor_msgs/NavSatStatus", "int8 status -2; uint16 service")
NavSatFix = message(
    "sensor_msgs/NavSatFix",
    _HEADER + "sensor_msgs/NavSatStatus status; float64 latitude; float64 longitude; float64 altitude;"
    "float64[9] position_covariance; uint8 position_covariance_type",
)
PointField = message("sensor_msgs/PointField", "string name; uint32 offset; uint8 datatype; uint32 count")
PointCloud2 = message(
    "sensor_msgs/PointCloud2",
    _HEADER
    + "uint32 height; uint32 width; sensor_msgs/PointField[] fields; bool is_bigendian; uint32 point_step;"
    "uint32 row_step; uint8[] data; bool is_dense",
)
