"""What is said to rosbridge (its protocol, version 2), and what it says, in JSON or in CBOR.

CBOR (RFC 8949) with typed arrays (RFC 8746) keeps infinity and NaN apart. It is read without the decoder's hooks, whose
signature differs between the library's versions 5 and 6.
"""

from __future__ import annotations

import json
import struct
from types import SimpleNamespace
from typing import Any, Literal

from cbor2 import CBORDecodeError, CBORTag, loads

from chatrobot.wire.ros_messages import RosForm

_VELOCITIES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_PICTURES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
PICTURE_MS = 200
_IN_CBOR = ("sensor_msgs/msg/LaserScan", *_PICTURES)
"""Not odometry and gyros: rosbridge_server 2.1.0 fails to write arrays of fixed length (covariances) as CBOR."""
TYPED_ARRAYS = {
    64: "B", 68: "B", 72: "b",
    65: ">H", 66: ">I", 67: ">Q", 69: "<H", 70: "<I", 71: "<Q",
    73: ">h", 74: ">i", 75: ">q", 77: "<h", 78: "<i", 79: "<q",
    80: ">e", 81: ">f", 82: ">d", 84: "<e", 85: "<f", 86: "<d",
}  # fmt: skip
"""The format of one element, by tag."""


def request_id(operation: Literal["advertise", "subscribe"], topic: str, form: RosForm) -> str:
    """Return what the bridge calls this request by when it refuses it."""
    return f"{operation}:{topic}:{form.type_name}"


def advertise_request(full_name: str, topic: str, form: RosForm) -> dict[str, Any]:
    """Make the request to publish on our `topic`, which is `full_name` there."""
    # The bridge repeats its last second of messages to who comes late: of velocities only the very last.
    depth = {"queue_size": 1} if form.type_name in _VELOCITIES else {}
    about = {"topic": full_name, "type": form.type_name}
    return {"op": "advertise", "id": request_id("advertise", topic, form), **about, **depth}


def subscribe_request(full_name: str, topic: str, form: RosForm) -> dict[str, Any]:
    """Make the request to hear our `topic`, which is `full_name` there."""
    # Of pictures the newest, now and then: they share the line with odometry.
    gently = {"throttle_rate": PICTURE_MS, "queue_length": 1} if form.type_name in _PICTURES else {}
    encoded = {"compression": "cbor"} if form.type_name in _IN_CBOR else {}
    about = {"topic": full_name, "type": form.type_name, "throttle_rate": 0}
    return {"op": "subscribe", "id": request_id("subscribe", topic, form), **about, **gently, **encoded}


def read(packet: str | bytes) -> Any:
    """Read JSON, or CBOR where it comes as bytes: maps become objects with attributes, typed arrays tuples.

    Raises:
        ValueError: it is neither.
    """
    if isinstance(packet, str):
        return json.loads(packet, object_hook=lambda fields: SimpleNamespace(**fields))
    try:
        return _read(loads(packet))
    except (CBORDecodeError, struct.error) as error:
        raise ValueError(f"not CBOR: {error}") from error


def _read(value: Any) -> Any:
    if isinstance(value, dict):
        return SimpleNamespace(**{str(name): _read(field) for name, field in value.items()})
    if isinstance(value, list):
        return [_read(item) for item in value]
    if isinstance(value, CBORTag) and value.tag in TYPED_ARRAYS:
        return tuple(number for (number,) in struct.iter_unpack(TYPED_ARRAYS[value.tag], value.value))
    return value
