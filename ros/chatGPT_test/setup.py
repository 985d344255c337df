"""The tutorial's names for the nodes of ChatRobot."""

from setuptools import setup

setup(
    name="chatGPT_test",
    version="0.1.0",
    packages=[],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/chatGPT_test"]),
        ("share/chatGPT_test", ["package.xml"]),
    ],
    entry_points={
        "console_scripts": [
            "chatGPT_input = chatrobot.cli.ros_run:input_node",
            "chatGPT_base = chatrobot.cli.ros_run:base_node",
            "chatGPT_control = chatrobot.cli.ros_run:control_node",
        ]
    },
)
