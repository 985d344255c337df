"""What ROS 2 is here, by its environment variables. Pure, and needs no rclpy."""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
_LOCALHOST_ONLY = "ROS_LOCALHOST_ONLY"
_PEERS = "ROS_STATIC_PEERS"
_WITHOUT_RANGES = ("foxy", "galactic", "humble")
"""These know ROS_LOCALHOST_ONLY alone, which would part us from nodes of this machine that do not set it."""
HOW_TO_GET_IT = (
    "source /opt/ros/jazzy/setup.bash in this terminal, with a Python that sees it (a virtual environment made with"
    " --system-site-packages); without ROS take --on dds or --on rosbridge"
)


def prefer_this_machine(environ: MutableMapping[str, str]) -> None:
    """Where nobody says how far we reach, it is this machine: a classroom must not drive each other's robots."""
    if environ.get("ROS_DISTRO", "").lower() in _WITHOUT_RANGES:
        return
    if not environ.get(RANGE, "").strip() and environ.get(_LOCALHOST_ONLY, "").strip() != "0":
        environ[RANGE] = "LOCALHOST"


def reaches_this_machine_alone(environ: Mapping[str, str]) -> bool:
    """Whether nobody on another machine can meet us, once `prefer_this_machine` was asked."""
    if environ.get(_LOCALHOST_ONLY, "").strip() == "1":
        return True
    if environ.get("ROS_DISTRO", "").lower() in _WITHOUT_RANGES or environ.get(_PEERS, "").strip(";, "):
        return False
    asked = environ.get(RANGE, "").strip().upper()
    return asked in ("LOCALHOST", "OFF") or (not asked and environ.get(_LOCALHOST_ONLY, "").strip() != "0")
