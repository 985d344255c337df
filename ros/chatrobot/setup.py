"""Executables, launch files and parameters alone: the Python package is installed apart, with pip (docs/ros.md)."""

from glob import glob

from setuptools import setup

SHARE = "share/chatrobot"

setup(
    # Not `chatrobot`: pip's package of that name must not seem to be this one.
    name="chatrobot-ros",
    version="0.1.0",
    packages=[],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/chatrobot"]),
        (SHARE, ["package.xml"]),
        (f"{SHARE}/launch", glob("launch/*.launch.py")),
        (f"{SHARE}/params", glob("params/*.yaml")),
    ],
    entry_points={
        "console_scripts": [
            "input = chatrobot.cli.ros_run:input_node",
            "base = chatrobot.cli.ros_run:base_node",
            "control = chatrobot.cli.ros_run:control_node",
            "sim = chatrobot.cli.ros_run:simulated_robot",
        ]
    },
)
