"""The simulated robot's transforms for RViz and Nav2 (REP-105): `odom` → `base_link` on `/tf`, and `base_link` →
`laser`, which is fixed, once on `/tf_static`, where who comes later finds it, too."""

from __future__ import annotations

from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import Message, Odometry
from chatrobot.wire.ros_messages import BASE_FRAME, LASER_FRAME, ODOM_FRAME, transform
from chatrobot.wire.stamps import to_wall_s
from chatrobot.wire.wire import Wire

TF_TOPIC = "/tf"
TF_STATIC_TOPIC = "/tf_static"
TF_TYPE = "tf2_msgs/msg/TFMessage"
_EVERY = 2
"""Of 100 odometry messages a second, every second one: RViz draws no faster."""


class TransformPublisher:
    """Says with the odometry where the frames are."""

    def __init__(self, wire: Wire, profile: RobotProfile) -> None:
        self._wire = wire
        self._odom_topic = profile.wiring.odom_topic
        self._lidar = profile.lidar
        self._count = 0

    def after(self, topic: str, message: Message) -> None:
        """To be called after each message the robot has published."""
        if topic != self._odom_topic or not isinstance(message, Odometry):
            return
        self._count += 1
        if self._count % _EVERY:
            return
        at_s = to_wall_s(message.stamp_s)
        self._publish_fixed(at_s)
        moving = transform(ODOM_FRAME, BASE_FRAME, at_s, message.x_m, message.y_m, message.yaw_rad)
        self._wire.publish_fields(TF_TOPIC, TF_TYPE, {"transforms": [moving]})

    def _publish_fixed(self, at_s: float) -> None:
        """Once."""
        mount = self._lidar
        if mount is not None:
            fixed = transform(BASE_FRAME, LASER_FRAME, at_s, mount.x_m, mount.y_m, mount.yaw_rad)
            self._wire.publish_fields(TF_STATIC_TOPIC, TF_TYPE, {"transforms": [fixed]}, is_kept=True)
            self._lidar = None
