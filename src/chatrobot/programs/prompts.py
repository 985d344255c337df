"""The prompts for a model that is to write a program, or to mend one."""

from __future__ import annotations

from chatrobot.programs.check import ROBOT_MODULES
from chatrobot.robots.profile import RobotProfile

_SYSTEM = """\
You write one complete ROS 2 program in Python (rclpy) for a mobile robot, and nothing else.

The robot: {title}. Velocities: {cmd_vel_type} on {cmd_vel_topic}. {sensors}
At most {speed:g} m/s and {rate:g} rad/s; x is forward, y to the left, yaw counter-clockwise.{sideways}

Rules:
- One file with a class derived from Node, a main() and the usual `if __name__ == '__main__'`.
- Import only the standard library, numpy and these: {modules}. No files, no network, no other processes.
- Give message fields floats (0.0, not 0). Publish the velocity again at least every 0.1 s while it is to hold.
- When it is done, or when it is interrupted, publish a zero velocity and let the program end.
- Answer with the code in one ```python fence. Words about it are optional and short."""

_MEND = """\
That program does not do. {where}

{problem}

Answer with the whole corrected program in one ```python fence."""


def system_prompt(profile: RobotProfile) -> str:
    """Return the rules for writing programs for one robot."""
    wiring = profile.wiring
    sensors = [f"odometry ({wiring.odom_type}) on {wiring.odom_topic}"] if wiring.odom_topic else []
    sensors += (
        [f"sensor_msgs/LaserScan on {wiring.scan_topic}"] if wiring.scan_topic and profile.lidar else []
    )
    sensors += [f"sensor_msgs/Imu on {wiring.imu_topic}"] if wiring.imu_topic else []
    cannot = []
    if not profile.can_go_sideways:
        cannot.append("cannot move sideways")
    if not profile.can_turn_on_the_spot:
        cannot.append("cannot turn on the spot")
    return _SYSTEM.format(
        title=profile.title,
        cmd_vel_type=f"geometry_msgs/{wiring.cmd_vel_type}",
        cmd_vel_topic=wiring.cmd_vel_topic,
        sensors=f"Sensors: {', '.join(sensors)}." if sensors else "It has no sensors.",
        speed=profile.limits.max_speed_mps,
        rate=profile.limits.max_rate_radps,
        sideways=f" It {' and '.join(cannot)}." if cannot else "",
        modules=", ".join(sorted(ROBOT_MODULES)),
    )


def mend_prompt(where: str, problem: str) -> str:
    """Return what is wrong with the program that was just given. `where` is a sentence or ""."""
    return _MEND.format(where=where, problem=problem.strip()[-4000:])
