"""sensor_msgs/Image and sensor_msgs/CompressedImage, as far as a model may be shown them."""

from __future__ import annotations

import base64
from typing import Any

from chatrobot.wire.messages import Picture

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


def compressed_to(picture: Picture) -> dict[str, Any]:
    """The fields of sensor_msgs/CompressedImage without its header."""
    return {"format": picture.encoding, "data": picture.data}


def _bytes(data: Any) -> bytes:
    """uint8[] as every library has it: numpy (rosbags), array (rclpy), base64 or a list (rosbridge)."""
    if len(data) > 2 * MOST_BYTES:
        raise ValueError("too large a picture")
    found = base64.b64decode(data, validate=True) if isinstance(data, str) else bytes(data)
    if len(found) > MOST_BYTES:
        raise ValueError("too large a picture")
    return found
