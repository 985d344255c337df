"""A simulated robot and the nodes that drive it.

ros2 launch chatrobot simulated_robot.launch.py robot:=wheeltec_mini_mec world:=home
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    robot, world, namespace = (LaunchConfiguration(name) for name in ("robot", "world", "namespace"))
    nodes = PathJoinSubstitution([FindPackageShare("chatrobot"), "launch", "robot.launch.py"])
    chosen = {"robot": robot, "world": world, "namespace": namespace, "on_robot": "true"}
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "robot", default_value="wheeltec_mini_mec", description="which robot to imitate"
            ),
            DeclareLaunchArgument(
                "world", default_value="home", description="where: empty, home or a world file"
            ),
            DeclareLaunchArgument("namespace", default_value="", description="of the robot"),
            Node(
                package="chatrobot",
                executable="sim",
                namespace=namespace,
                output="screen",
                arguments=["--robot", robot, "--world", world],
            ),
            IncludeLaunchDescription(PythonLaunchDescriptionSource(nodes), launch_arguments=chosen.items()),
        ]
    )
