"""ROS 2 message definitions (from rosbags), and messages as their bytes (CDR). Knows no DDS library.

The wire over DDS and recordings stand on it.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

_EXTRA = {
    # ros/ros_tutorials, turtlesim/msg/Pose.msg
    "turtlesim/msg/Pose": (
        "float32 x\nfloat32 y\nfloat32 theta\nfloat32 linear_velocity\nfloat32 angular_velocity\n"
    ),
    # ros2/rmw_dds_common: the identifier is 24 bytes up to Iron, 16 since.
    "rmw_dds_common/msg/Gid": "uint8[24] data\n",
}
_GID_16 = "uint8[16] data\n"

MALFORMED = (SerdeError, ValueError, TypeError, IndexError, struct.error, OverflowError, MemoryError)
"""What reading bytes that are not a message of that type may raise."""


class RosDefinitions:
    """The definitions one process speaks.

    Args:
        gid_bytes: length of a GID in `rmw_dds_common`: 24 on Humble and Iron, 16 since Jazzy.
    """

    def __init__(self, gid_bytes: int = 16) -> None:
        self._store = get_typestore(Stores.ROS2_JAZZY)
        extra = _EXTRA if gid_bytes == 24 else {**_EXTRA, "rmw_dds_common/msg/Gid": _GID_16}
        for name, text in extra.items():
            self._store.fielddefs.pop(name, None)
            self._store.register(get_types_from_msg(text, name))

    def hash_of(self, name: str) -> str:
        """REP-2011's type hash, `RIHS01_…`, of `package/msg/Name`."""
        return str(self._store.hash_rihs01(name))

    def text_of(self, name: str) -> str:
        """The definition as a `.msg` file, and behind it all that it names."""
        return self._store.generate_msgdef(name, ros_version=2)[0]

    def cdr(self, name: str, fields: Mapping[str, Any]) -> bytes:
        """The bytes of a message of these nested fields; fields left out are zero."""
        return bytes(self._store.serialize_cdr(self.message(name, fields), name))

    def message(self, name: str, fields: Mapping[str, Any]) -> Any:
        """A ROS message object of these nested fields."""
        definition = self._store.fielddefs[name][1]
        return self._store.types[name](*[self._value(node, fields.get(field)) for field, node in definition])

    def read(self, name: str, cdr: bytes) -> Any:
        """The ROS message in these bytes; raises what rosbags raises where they are none."""
        return self._store.deserialize_cdr(cdr, name)

    def _value(self, node: Any, given: Any) -> Any:
        kind, detail = node
        if kind == Nodetype.NAME:
            return self.message(detail, given or {})
        if kind == Nodetype.BASE:
            python_type = _python_type(detail[0])
            return python_type() if given is None else python_type(given)
        inner, length = detail
        if inner[0] == Nodetype.BASE and inner[1][0] != "string":
            dtype = np.dtype(_NUMPY_NAMES.get(inner[1][0], inner[1][0]))
            if given is None:
                return np.zeros(length if kind == Nodetype.ARRAY else 0, dtype)
            if isinstance(given, bytes):
                return np.frombuffer(given, dtype)
            return np.asarray(given, dtype)
        return [self._value(inner, item) for item in given or ()]


_NUMPY_NAMES = {"byte": "uint8", "char": "uint8"}


def _python_type(name: str) -> type:
    if name in ("string", "bool"):
        return str if name == "string" else bool
    return float if name.startswith("float") else int
