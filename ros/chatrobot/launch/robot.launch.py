"""The nodes base and control for a robot that is there already.

    ros2 launch chatrobot robot.launch.py robot:=turtlebot3_burger namespace:=robot1

Then, in a terminal of its own because it reads what you type: ros2 run chatrobot input
"""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

PARAMS = os.path.join(get_package_share_directory("chatrobot"), "params", "params.yaml")
TEXTS = {
    "robot": "the robot's profile, by name or .toml file",
    "world": "what is known of the surroundings: empty, home or a world file",
}
NUMBERS = {
    "max_distance_m": "metres that one text or program may drive; -1: no limit",
    "max_time_s": "seconds that one text or program may drive; -1: no limit",
}
SWITCHES = {
    "open_loop": "drive a robot without odometry: slowly, 10 s a text at most, nothing measured",
    "use_sim_time": "follow the time of a simulation (/clock)",
    "allow_release": "an emergency stop may be released over ROS",
    "accept_others": "drive though another ChatRobot is on the same robot",
    "on_robot": "this machine is the robot's own: no network lies between control and base",
    "generate_code": "have requests for programs answered by a program",
}
OF_ONE = {
    "base": {"generate_code"},
    "control": {"allow_release", "accept_others", "on_robot", "max_distance_m", "max_time_s"},
}
NO_ODOMETRY = "no_odometry"


def nodes(context):
    """What stands on the launch line goes before the file; what does not is left to it."""

    def given(name):
        return LaunchConfiguration(name).perform(context)

    values = {name: given(name) for name in TEXTS if given(name)}
    values.update({name: float(given(name)) for name in NUMBERS if given(name)})
    values.update({name: given(name).lower() == "true" for name in SWITCHES if given(name)})
    if values.get("open_loop") and given("params_file") == PARAMS:
        values.setdefault("robot", NO_ODOMETRY)  # in place of the robot that our own file names
    made = []
    for executable, own in OF_ONE.items():
        others = set().union(*OF_ONE.values()) - own
        parameters = {name: value for name, value in values.items() if name not in others}
        made.append(
            Node(
                package="chatrobot",
                executable=executable,
                namespace=given("namespace"),
                output="screen",
                parameters=[given("params_file"), parameters] if parameters else [given("params_file")],
            )
        )
    return made


def generate_launch_description():
    arguments = [
        DeclareLaunchArgument("namespace", default_value="", description="of the robot"),
        DeclareLaunchArgument("params_file", default_value=PARAMS, description="every parameter, in YAML"),
    ]
    for name, text in {**TEXTS, **NUMBERS, **SWITCHES}.items():
        arguments.append(
            DeclareLaunchArgument(name, default_value="", description=f"{text}; where empty, the file's")
        )
    return LaunchDescription([*arguments, OpaqueFunction(function=nodes)])
