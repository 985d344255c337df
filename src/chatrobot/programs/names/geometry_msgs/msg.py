"""geometry_msgs.msg"""

from chatrobot.programs.inside.messages import message
from chatrobot.programs.names.std_msgs import msg as _std_msgs  # noqa: F401

_HEADER = "std_msgs/Header header; "
_XYZ = "float64 x; float64 y; float64 z"

Vector3 = message("geometry_msgs/Vector3", _XYZ)
Point = message("geometry_msgs/Point", _XYZ)
Point32 = message("geometry_msgs/Point32", "float32 x; float32 y; float32 z")
Quaternion = message("geometry_msgs/Quaternion", "float64 x 0; float64 y 0; float64 z 0; float64 w 1")
Pose = message("geometry_msgs/Pose", "geometry_msgs/Point position; geometry_msgs/Quaternion orientation")
Pose2D = message("geometry_msgs/Pose2D", "float64 x; float64 y; float64 theta")
Transform = message(
    "geometry_msgs/Transform", "geometry_msgs/Vector3 translation; geometry_msgs/Quaternion rotation"
)
Twist = message("geometry_msgs/Twist", "geometry_msgs/Vector3 linear; geometry_msgs/Vector3 angular")
Accel = message("geometry_msgs/Accel", "geometry_msgs/Vector3 linear; geometry_msgs/Vector3 angular")
Wrench = message("geometry_msgs/Wrench", "geometry_msgs/Vector3 force; geometry_msgs/Vector3 torque")
Polygon = message("geometry_msgs/Polygon", "geometry_msgs/Point32[] points")
PoseWithCovariance = message(
    "geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose; float64[36] covariance"
)
TwistWithCovariance = message(
    "geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist; float64[36] covariance"
)
PointStamped = message("geometry_msgs/PointStamped", _HEADER + "geometry_msgs/Point point")
PoseStamped = message("geometry_msgs/PoseStamped", _HEADER + "geometry_msgs/Pose pose")
PoseArray = message("geometry_msgs/PoseArray", _HEADER + "geometry_msgs/Pose[] poses")
PoseWithCovarianceStamped = message(
    "geometry_msgs/PoseWithCovarianceStamped", _HEADER + "geometry_msgs/PoseWithCovariance pose"
)
QuaternionStamped = message(
    "geometry_msgs/QuaternionStamped", _HEADER + "geometry_msgs/Quaternion quaternion"
)
TransformStamped = message(
    "geometry_msgs/TransformStamped", _HEADER + "string child_frame_id; geometry_msgs/Transform transform"
)
TwistStamped = message("geometry_msgs/TwistStamped", _HEADER + "geometry_msgs/Twist twist")
TwistWithCovarianceStamped = message(
    "geometry_msgs/TwistWithCovarianceStamped", _HEADER + "geometry_msgs/TwistWithCovariance twist"
)
Vector3Stamped = message("geometry_msgs/Vector3Stamped", _HEADER + "geometry_msgs/Vector3 vector")
PolygonStamped = message("geometry_msgs/PolygonStamped", _HEADER + "geometry_msgs/Polygon polygon")
