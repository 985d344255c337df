"""What ROS 2 is here, by its environment variables. Pure, and needs no rclpy.

Unlike on DDS we choose no range of our own: in Jazzy a node in LOCALHOST range and one in SUBNET range, ROS's
default, may not meet even on one machine, and then the robot's own driver would not hear us (decision 8).
"""

from __future__ import annotations

from collections.abc import Mapping

_WITHOUT_RANGES = ("foxy", "galactic", "humble")
"""These know ROS_LOCALHOST_ONLY alone."""
HOW_TO_GET_IT = (
    "source /opt/ros/jazzy/setup.bash in this terminal, with a Python that sees it (a virtual environment made with"
    " --system-site-packages); without ROS take --on dds or --on rosbridge"
)


def reaches_this_machine_alone(environ: Mapping[str, str]) -> bool:
    """Whether nobody on another machine can meet ROS nodes started with these variables."""
    if environ.get("ROS_LOCALHOST_ONLY", "").strip() == "1":
        return True
    if environ.get("ROS_DISTRO", "").lower() in _WITHOUT_RANGES or environ.get("ROS_STATIC_PEERS", "").strip(
        "; "
    ):
        return False
    return environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").strip() in ("LOCALHOST", "OFF")
