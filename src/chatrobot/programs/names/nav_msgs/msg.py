"""nav_msgs.msg"""

from chatrobot.programs.inside.messages import message
from chatrobot.programs.names.geometry_msgs import msg as _geometry_msgs  # noqa: F401

_HEADER = "std_msgs/Header header; "

Odometry = message(
    "nav_msgs/Odometry",
    _HEADER
    + "string child_frame_id; geometry_msgs/PoseWithCovariance pose; geometry_msgs/TwistWithCovariance twist",
)
Path = message("nav_msgs/Path", _HEADER + "geometry_msgs/PoseStamped[] poses")
MapMetaData = message(
    "nav_msgs/MapMetaData",
    "builtin_interfaces/Time map_load_time; float32 resolution; uint32 width; uint32 height; geometry_msgs/Pose origin",
)
OccupancyGrid = message("nav_msgs/OccupancyGrid", _HEADER + "nav_msgs/MapMetaData info; int8[] data")
GridCells = message(
    "nav_msgs/GridCells", _HEADER + "float32 cell_width; float32 cell_height; geometry_msgs/Point[] cells"
)
