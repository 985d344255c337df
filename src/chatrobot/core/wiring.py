"""How a robot is wired: plain data, for who reads profiles and who carries messages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

CMD_VEL_INPUT_TOPIC = "chatrobot/cmd_vel"
"""Where other programs may send velocities for us to govern; of the same type as the robot's own."""

JOYSTICK_TOPIC = "chatrobot/joystick"
"""The same for a person with a joystick who looks at the robot: it goes before every plan."""


ODOM_TOPIC = "odom"
"""Where a robot tells its odometry, if its profile says nothing else."""


@dataclass(frozen=True)
class Wiring:
    """Topics, types and habits of the base. Nothing here bounds a motion.

    Topics are ROS names, None where the robot has no such sensor ("" for odometry). Their types: imu sensor_msgs/Imu,
    scan sensor_msgs/LaserScan, bumper std_msgs/Bool, battery sensor_msgs/BatteryState; odometry and camera as
    `odom_type` and `camera_type` (of sensor_msgs) say. `base_timeout_s` is how long the base holds its last
    command; None means for ever. `namespace` is put before relative topics where the wire's address names none;
    it needs a wire that has namespaces (DDS, ROS, rosbridge).
    """

    cmd_vel_topic: str = "cmd_vel"
    cmd_vel_type: Literal["Twist", "TwistStamped"] = "Twist"
    odom_topic: str = ODOM_TOPIC
    odom_type: Literal["Odometry", "turtlesim/Pose"] = "Odometry"
    imu_topic: str | None = None
    scan_topic: str | None = None
    bumper_topic: str | None = None
    battery_topic: str | None = None
    camera_topic: str | None = None
    camera_type: Literal["Image", "CompressedImage"] = "Image"
    base_timeout_s: float | None = None
    namespace: str = ""

    @property
    def sensor_topics(self) -> dict[str, str]:
        """The topics of the base's own sensors by their names, as far as it has them; a camera is none of them."""
        topics = {
            "odom": self.odom_topic,
            "imu": self.imu_topic,
            "scan": self.scan_topic,
            "bumper": self.bumper_topic,
            "battery": self.battery_topic,
        }
        return {sensor: topic for sensor, topic in topics.items() if topic}
