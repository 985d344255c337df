"""The simulated robot on a network: callbacks on the physics thread, and transforms for RViz and Nav2.

Transforms (REP-105): `odom` → `base_link` on `/tf`, and `base_link` → `laser`, which is fixed, once on `/tf_static`,
where who comes later finds it, too.
"""

from __future__ import annotations

import contextlib
import math
import queue
import time
from collections.abc import Callable
from typing import Any

from chatrobot.core.errors import WireError
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import Message, Odometry
from chatrobot.wire.ros_messages import BASE_FRAME, LASER_FRAME, ODOM_FRAME, transform
from chatrobot.wire.stamps import to_wall_s
from chatrobot.wire.wire import M, Wire


class MarshalledWire(Wire):
    """Wraps an end of a wire that delivers on its own threads: this one delivers in `poll` alone, as a `LocalHub` does.

    Args:
        after_publishing: called with each message that has been published.
    """

    def __init__(
        self, wire: Wire, after_publishing: Callable[[str, Message], None] = lambda _topic, _message: None
    ) -> None:
        self._wire = wire
        self._after_publishing = after_publishing
        # Not a SimpleQueue: where a signal comes in the last moment of its timeout, it waits for ever.
        self._waiting: queue.Queue[tuple[Callable[[Any], None], Any, float]] = queue.Queue()
        self._came_s = math.inf

    @property
    def age_s(self) -> float:
        """Return how long ago the message that is being delivered came."""
        return max(0.0, time.monotonic() - self._came_s)

    def publish(self, topic: str, message: Message) -> None:
        """Publish as `Wire` does; a message that cannot be sent is dropped."""
        with contextlib.suppress(WireError):  # a robot lives on while its network is gone
            self._wire.publish(topic, message)
            self._after_publishing(topic, message)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        """Subscribe as `Wire` does; `callback` comes in `poll`."""
        self._wire.subscribe(
            topic, kind, lambda message: self._waiting.put((callback, message, time.monotonic()))
        )

    def poll(self, timeout_s: float) -> None:
        """Wait up to `timeout_s` for a message and deliver all that are there."""
        try:
            callback, message, self._came_s = self._waiting.get(timeout=max(0.0, timeout_s))
            while True:
                callback(message)
                callback, message, self._came_s = self._waiting.get_nowait()
        except queue.Empty:
            return

    def close(self) -> None:
        """Close the wire."""
        self._wire.close()


TF_TOPIC = "/tf"
TF_STATIC_TOPIC = "/tf_static"
TF_TYPE = "tf2_msgs/msg/TFMessage"
_EVERY = 2
"""Of 100 odometry messages a second, every second one: RViz draws no faster."""


class TransformPublisher:
    """Publishes with the odometry where the frames are."""

    def __init__(self, wire: Wire, profile: RobotProfile) -> None:
        self._wire = wire
        self._odom_topic = profile.wiring.odom_topic
        self._lidar = profile.lidar
        self._count = 0

    def after(self, topic: str, message: Message) -> None:
        """Publish what is due; call it after each message the robot has published."""
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
        """Publish the lidar's mounting, once."""
        mount = self._lidar
        if mount is not None:
            fixed = transform(BASE_FRAME, LASER_FRAME, at_s, mount.x_m, mount.y_m, mount.yaw_rad)
            self._wire.publish_fields(TF_STATIC_TOPIC, TF_TYPE, {"transforms": [fixed]}, is_kept=True)
            self._lidar = None
