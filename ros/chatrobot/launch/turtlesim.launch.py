"""turtlesim and the nodes that drive its turtle; one unit of its window is a metre.

ros2 launch chatrobot turtlesim.launch.py
"""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    nodes = PathJoinSubstitution([FindPackageShare("chatrobot"), "launch", "robot.launch.py"])
    return LaunchDescription(
        [
            Node(  # from Iron on it goes sideways only when told so
                package="turtlesim",
                executable="turtlesim_node",
                parameters=[{"holonomic": True}],
                output="screen",
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(nodes),
                launch_arguments={"robot": "turtlesim", "on_robot": "true"}.items(),
            ),
        ]
    )
