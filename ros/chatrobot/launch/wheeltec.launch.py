"""A Wheeltec base with its vendor's own bring-up, and the nodes that drive it; on the robot.

ros2 launch chatrobot wheeltec.launch.py robot:=wheeltec_mini_mec
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

VENDOR = "turn_on_wheeltec_robot"


def generate_launch_description():
    bring_up = PathJoinSubstitution(
        [
            FindPackageShare(LaunchConfiguration("vendor_package")),
            "launch",
            LaunchConfiguration("vendor_file"),
        ]
    )
    nodes = PathJoinSubstitution([FindPackageShare("chatrobot"), "launch", "robot.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "robot", default_value="wheeltec_mini_mec", description="which Wheeltec it is"
            ),
            DeclareLaunchArgument(
                "vendor_package", default_value=VENDOR, description="of the vendor's image"
            ),
            DeclareLaunchArgument(
                "vendor_file", default_value=f"{VENDOR}.launch.py", description="brings up base and lidar"
            ),
            IncludeLaunchDescription(PythonLaunchDescriptionSource(bring_up)),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(nodes),
                launch_arguments={"robot": LaunchConfiguration("robot"), "on_robot": "true"}.items(),
            ),
        ]
    )
