"""The planar messages as ROS 2 messages and back, apart from how any backend writes them down.

Towards ROS a message becomes nested dictionaries with the fields that matter; what is left out is zero. From ROS
it is read by attribute, whatever library made the object. Frames are REP-105's: `odom`, `base_link`, and `laser`
for the lidar. Stamps pass through as they are: the backend knows the clocks.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

from chatrobot.core.wiring import CMD_VEL_INPUT_TOPIC, JOYSTICK_TOPIC, Wiring
from chatrobot.wire.messages import (
    Flag,
    Imu,
    LaserScan,
    Message,
    Number,
    Odometry,
    Picture,
    Text,
    TwistMessage,
)
from chatrobot.wire.stamps import to_wall_s

MOST_BYTES = 33_554_432
"""A larger picture is passed over (4K in colour has 25 MB)."""
CHANNELS = {"rgb8": 3, "bgr8": 3, "mono8": 1}
_SAME_AS = {"8UC3": "bgr8", "8UC1": "mono8"}
"""OpenCV's names, in its order of colours (sensor_msgs/image_encodings.hpp)."""
_MAGIC = {"jpeg": b"\xff\xd8\xff", "png": b"\x89PNG\r\n\x1a\n"}


def file_format(data: bytes) -> str:
    """`jpeg`, `png` or nothing, as the first bytes of the file say: drivers fill in `format` as they like."""
    return next((name for name, magic in _MAGIC.items() if data.startswith(magic)), "")


def image_from(message: Any, stamp_s: float) -> Picture | None:
    """Of sensor_msgs/Image; None for an encoding that is no picture in 8 bits (a depth image, say).

    Raises:
        ValueError: the numbers and the bytes contradict each other, or there are too many.
    """
    encoding = _SAME_AS.get(message.encoding, message.encoding)
    channels = CHANNELS.get(encoding)
    if channels is None:
        return None
    width_px, height_px, row_bytes = int(message.width), int(message.height), int(message.step)
    data = _bytes(message.data)
    if width_px < 1 or height_px < 1 or row_bytes < width_px * channels or len(data) < row_bytes * height_px:
        raise ValueError("a picture without all of its rows")
    return Picture(stamp_s, encoding, width_px, height_px, row_bytes, data)


def compressed_from(message: Any, stamp_s: float) -> Picture | None:
    """Of sensor_msgs/CompressedImage; None for what is neither JPEG nor PNG (a compressed depth image, say).

    Raises:
        ValueError: there are too many bytes.
    """
    data = _bytes(message.data)
    encoding = file_format(data)
    return Picture(stamp_s, encoding, 0, 0, 0, data) if encoding else None


def image_to(picture: Picture) -> dict[str, Any]:
    """The fields of sensor_msgs/Image without its header."""
    return {
        "height": picture.height_px,
        "width": picture.width_px,
        "encoding": picture.encoding,
        "step": picture.row_bytes,
        "data": picture.data,
    }


def _bytes(data: Any) -> bytes:
    """uint8[] as every library has it: numpy (rosbags), array (rclpy), base64 or a list (rosbridge)."""
    if len(data) > 2 * MOST_BYTES:
        raise ValueError("too large a picture")
    found = base64.b64decode(data, validate=True) if isinstance(data, str) else bytes(data)
    if len(found) > MOST_BYTES:
        raise ValueError("too large a picture")
    return found


ODOM_FRAME, BASE_FRAME, LASER_FRAME, CAMERA_FRAME = "odom", "base_link", "laser", "camera_optical_frame"

T = TypeVar("T")
_STAMPED = (Odometry, Imu, LaserScan, Picture)
_READ_DEPTH = 200


class RosForm(NamedTuple):
    """A planar message's form in ROS.

    `type_name` is `package/msg/Name`. `to_ros` gives nested dictionaries; `from_ros` reads an object's attributes
    and gives None where nothing was measured; it raises AttributeError, TypeError or ValueError for an object of
    another shape.
    """

    type_name: str
    to_ros: Callable[[Any], dict[str, Any]]
    from_ros: Callable[[Any], Message | None]


def ros_form(topic: str, kind: type[Any], wiring: Wiring) -> RosForm:
    """Return what `kind` is on `topic` of a robot wired like this."""
    if kind is TwistMessage and wiring.cmd_vel_type == "TwistStamped":
        return (
            _TWIST_STAMPED
            if topic in (wiring.cmd_vel_topic, CMD_VEL_INPUT_TOPIC, JOYSTICK_TOPIC)
            else _PLAIN[kind]
        )
    if kind is Odometry and topic == wiring.odom_topic and wiring.odom_type == "turtlesim/Pose":
        return _TURTLE_POSE
    if kind is Number and topic == wiring.battery_topic:
        return _BATTERY
    if kind is Picture and topic == wiring.camera_topic and wiring.camera_type == "CompressedImage":
        return _COMPRESSED
    return _PLAIN[kind]


def is_sensor(topic: str, kind: type[Any], wiring: Wiring) -> bool:
    """Tell whether robots may publish this with ROS's sensor QoS (best effort)."""
    return kind in _STAMPED or topic in (*wiring.sensor_topics.values(), wiring.camera_topic)


def read_depth(kind: type[Any]) -> int:
    """Return how many messages a reader keeps: of a burst all, so that nothing is lost; of pictures the newest."""
    return 1 if kind is Picture else _READ_DEPTH


class Listener:
    """One topic as one kind of message, for all callbacks of an end."""

    def __init__(self, form: RosForm) -> None:
        self.form = form
        self.callbacks: tuple[Callable[[Any], None], ...] = ()

    def hear(self, ros_message: Any, local_s: Callable[[float], float]) -> None:
        """Call back with the planar message; a wire never dies of a bad one.

        Args:
            local_s: translates a stamp of the sender's clock to ours.
        """
        try:
            message = self.form.from_ros(ros_message)
        except (AttributeError, TypeError, ValueError, OverflowError):
            return
        timed = None if message is None else stamped(message)
        if timed is not None:
            message = timed._replace(stamp_s=local_s(timed.stamp_s))
        if message is not None:
            for callback in self.callbacks:
                callback(message)


def with_wall_stamp(message: Message) -> Message:
    """Return the message with its stamp as ROS headers carry it."""
    timed = stamped(message)
    return message if timed is None else timed._replace(stamp_s=to_wall_s(timed.stamp_s))


def stamped(message: Message) -> Odometry | Imu | LaserScan | Picture | None:
    """The message itself if it carries a stamp."""
    return message if isinstance(message, _STAMPED) else None


def transform(
    parent: str, child: str, stamp_s: float, x_m: float, y_m: float, yaw_rad: float
) -> dict[str, Any]:
    """geometry_msgs/TransformStamped: where `child` is in `parent`."""
    return {
        "header": _header(stamp_s, parent),
        "child_frame_id": child,
        "transform": {"translation": {"x": x_m, "y": y_m}, "rotation": _quaternion(yaw_rad)},
    }


def _header(stamp_s: float, frame: str) -> dict[str, Any]:
    sec = math.floor(stamp_s)
    return {"stamp": {"sec": sec, "nanosec": int((stamp_s - sec) * 1e9)}, "frame_id": frame}


def _stamp_s(message: Any) -> float:
    stamp = message.header.stamp
    return float(stamp.sec) + float(stamp.nanosec) * 1e-9


def _quaternion(yaw_rad: float) -> dict[str, float]:
    return {"x": 0.0, "y": 0.0, "z": math.sin(yaw_rad / 2.0), "w": math.cos(yaw_rad / 2.0)}


def _yaw_rad(q: Any) -> float:
    """The heading of a quaternion, whatever its roll and pitch (an unset one, all zeros, looks along x)."""
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


def _twist_to(message: TwistMessage | Odometry) -> dict[str, Any]:
    return {"linear": {"x": message.vx_mps, "y": message.vy_mps}, "angular": {"z": message.wz_radps}}


def _twist_from(twist: Any) -> TwistMessage:
    return TwistMessage(float(twist.linear.x), float(twist.linear.y), float(twist.angular.z))


def _twist_stamped_to(message: TwistMessage) -> dict[str, Any]:
    # A zero stamp is "the newest" to every base: one that compares clocks must not refuse a stop.
    return {"header": _header(0.0, BASE_FRAME), "twist": _twist_to(message)}


def _odometry_to(message: Odometry) -> dict[str, Any]:
    pose = {"position": {"x": message.x_m, "y": message.y_m}, "orientation": _quaternion(message.yaw_rad)}
    return {
        "header": _header(message.stamp_s, ODOM_FRAME),
        "child_frame_id": BASE_FRAME,
        "pose": {"pose": pose},
        "twist": {"twist": _twist_to(message)},
    }


def _odometry_from(message: Any) -> Odometry:
    position, yaw_rad = message.pose.pose.position, _yaw_rad(message.pose.pose.orientation)
    twist = _twist_from(message.twist.twist)
    return Odometry(_stamp_s(message), float(position.x), float(position.y), yaw_rad, *twist)


def _turtle_pose_to(message: Odometry) -> dict[str, Any]:
    return {
        "x": message.x_m,
        "y": message.y_m,
        "theta": message.yaw_rad,
        "linear_velocity": message.vx_mps,
        "angular_velocity": message.wz_radps,
    }


def _turtle_pose_from(message: Any) -> Odometry:
    speed_mps, rate_radps = float(message.linear_velocity), float(message.angular_velocity)
    return Odometry(0.0, float(message.x), float(message.y), float(message.theta), speed_mps, 0.0, rate_radps)


def _imu_to(message: Imu) -> dict[str, Any]:
    return {"header": _header(message.stamp_s, BASE_FRAME), "angular_velocity": {"z": message.wz_radps}}


def _scan_to(message: LaserScan) -> dict[str, Any]:
    last = max(0, len(message.ranges_m) - 1)
    return {
        "header": _header(message.stamp_s, LASER_FRAME),
        "angle_min": message.angle_min_rad,
        "angle_max": message.angle_min_rad + last * message.angle_increment_rad,
        "angle_increment": message.angle_increment_rad,
        "range_min": message.range_min_m,
        "range_max": message.range_max_m,
        "ranges": message.ranges_m,
    }


def _scan_from(message: Any) -> LaserScan:
    ranges = message.ranges
    ranges_m: list[float] = ranges.tolist() if hasattr(ranges, "tolist") else [_range_m(r) for r in ranges]
    return LaserScan(
        _stamp_s(message),
        float(message.angle_min),
        float(message.angle_increment),
        float(message.range_min),
        float(message.range_max),
        ranges_m,
    )


def _range_m(value: Any) -> float:
    """JSON has neither infinity nor NaN: rosbridge says null for both, and we cannot know which it was."""
    return math.nan if value is None else float(value)


def _data_to(message: Flag | Number) -> dict[str, Any]:
    return {"data": message.data}


def _text_to(message: Text) -> dict[str, Any]:
    """JSON may hold half a character ("\\ud800"), which no ROS string can: what cannot be sent must not end us."""
    return {"data": message.data.encode(errors="replace").decode()}


def _of(kind: type[T], value: Any) -> T:
    if not isinstance(value, kind):
        raise TypeError(f"not a {kind.__name__}")
    return value


def _battery_from(message: Any) -> Number | None:
    """`percentage` is 0 to 1, NaN or null where unmeasured; drivers that mean per cent say more than 1."""
    share = math.nan if message.percentage is None else float(message.percentage)
    if not math.isfinite(share) or share < 0.0:
        return None
    return Number(share if share > 1.0 else share * 100.0)


_TWIST_STAMPED = RosForm(
    "geometry_msgs/msg/TwistStamped", _twist_stamped_to, lambda message: _twist_from(message.twist)
)
_TURTLE_POSE = RosForm("turtlesim/msg/Pose", _turtle_pose_to, _turtle_pose_from)
_BATTERY = RosForm(
    "sensor_msgs/msg/BatteryState",
    lambda message: {"percentage": message.data / 100.0, "present": True},
    _battery_from,
)
_COMPRESSED = RosForm(
    "sensor_msgs/msg/CompressedImage",
    lambda picture: {
        "header": _header(picture.stamp_s, CAMERA_FRAME),
        "format": picture.encoding,
        "data": picture.data,
    },
    lambda message: compressed_from(message, _stamp_s(message)),
)
_PLAIN: dict[type[Message], RosForm] = {
    TwistMessage: RosForm("geometry_msgs/msg/Twist", _twist_to, _twist_from),
    Odometry: RosForm("nav_msgs/msg/Odometry", _odometry_to, _odometry_from),
    Imu: RosForm(
        "sensor_msgs/msg/Imu",
        _imu_to,
        lambda message: Imu(_stamp_s(message), float(message.angular_velocity.z)),
    ),
    LaserScan: RosForm("sensor_msgs/msg/LaserScan", _scan_to, _scan_from),
    Picture: RosForm(
        "sensor_msgs/msg/Image",
        lambda picture: {"header": _header(picture.stamp_s, CAMERA_FRAME), **image_to(picture)},
        lambda message: image_from(message, _stamp_s(message)),
    ),
    Flag: RosForm("std_msgs/msg/Bool", _data_to, lambda message: Flag(_of(bool, message.data))),
    Number: RosForm("std_msgs/msg/Float64", _data_to, lambda message: Number(float(message.data))),
    Text: RosForm("std_msgs/msg/String", _text_to, lambda message: Text(_of(str, message.data))),
}
