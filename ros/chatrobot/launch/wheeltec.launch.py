"""A Wheeltec base with its vendor's own bring-up, and the nodes that drive it; on the robot.

ros2 launch chatrobot wheeltec.launch.py robot:=wheeltec_mini_mec

All arguments of robot.launch.py can be given, too.
"""

import os

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

VENDOR = "turn_on_wheeltec_robot"
HOW_TO_GET_IT = """\
It is the vendor's and comes with the robot: on the robot's image source its workspace, as in
  source ~/wheeltec_ros2/install/setup.bash
or build it from the sources that Wheeltec hands out with the robot. If it goes by another name there:
  ros2 launch chatrobot wheeltec.launch.py vendor_package:=NAME vendor_file:=FILE.launch.py
If the robot is brought up already, start the nodes alone:
  ros2 launch chatrobot robot.launch.py robot:={robot} on_robot:=true"""


def bring_up(context):
    """The vendor's launch file; what is missing is said with the way to get it."""
    package, file, robot = (
        LaunchConfiguration(name).perform(context) for name in ("vendor_package", "vendor_file", "robot")
    )
    try:
        path = os.path.join(get_package_share_directory(package), "launch", file)
    except PackageNotFoundError:
        missing = f"the package {package} is not here"
    else:
        if os.path.exists(path):
            return [IncludeLaunchDescription(PythonLaunchDescriptionSource(path))]
        missing = f"the package {package} has no launch file {file}"
    raise RuntimeError(f"{missing}. {HOW_TO_GET_IT.format(robot=robot)}")


def generate_launch_description():
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
            OpaqueFunction(function=bring_up),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(nodes),
                launch_arguments={"robot": LaunchConfiguration("robot"), "on_robot": "true"}.items(),
            ),
        ]
    )
