"""ROS 2 message definitions (from rosbags) as Cyclone types, and their bytes (CDR, written by rosbags).

Cyclone's own Python serialiser is three to six times slower; here its types only say what a topic carries, and the
bytes pass through untouched.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from cyclonedds.core import Policy
from cyclonedds.idl import make_idl_struct
from cyclonedds.idl import types as idl
from cyclonedds.idl.annotations import final
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
_SCALARS: dict[str, Any] = {
    "bool": bool,
    "byte": idl.uint8,
    "char": idl.uint8,
    "string": str,
    **{name: getattr(idl, name) for name in ("int8", "int16", "int32", "int64", "float32", "float64")},
    **{name: getattr(idl, name) for name in ("uint8", "uint16", "uint32", "uint64")},
}


MALFORMED = (SerdeError, ValueError, TypeError, IndexError, struct.error, OverflowError, MemoryError)
"""What reading bytes that are not a message of that type may raise."""


class CdrSample:
    """A message's bytes, header included: Cyclone reads and writes them here."""

    cdr: bytes
    sample_info: Any

    def serialize(self, buffer: Any = None, endianness: Any = None, use_version_2: Any = None) -> bytes:  # noqa: ARG002
        """Hand the bytes to Cyclone as they are."""
        return self.cdr

    @classmethod
    def deserialize(cls, data: bytes, has_header: bool = True, use_version_2: Any = None) -> CdrSample:  # noqa: ARG003
        """Take the bytes from Cyclone as they are."""
        sample = object.__new__(cls)
        sample.cdr = data
        return sample


class RosTypes:
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
        self._topic_types: dict[str, Any] = {}

    def topic_type(self, name: str) -> Any:
        """The Cyclone type of a topic that carries `name` (`package/msg/Name`); its samples are `CdrSample`."""
        if name not in self._topic_types:
            made = self._make(name)
            made.serialize = CdrSample.serialize
            made.deserialize = classmethod(CdrSample.deserialize.__func__)  # type: ignore[attr-defined]
            made.deserialize_key = made.deserialize
            self._topic_types[name] = made
        return self._topic_types[name]

    def hash_of(self, name: str) -> str:
        """REP-2011's type hash, `RIHS01_…`."""
        return str(self._store.hash_rihs01(name))

    def typehash(self, name: str) -> Policy.Userdata:
        """The hash as an endpoint tells it: without it every ROS process that meets us warns."""
        return Policy.Userdata(f"typehash={self.hash_of(name)};".encode())

    def sample(self, name: str, fields: Mapping[str, Any]) -> Any:
        """A sample of `topic_type(name)`; fields left out are zero."""
        made = object.__new__(self.topic_type(name))
        made.cdr = bytes(self._store.serialize_cdr(self.message(name, fields), name))
        return made

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

    def _make(self, name: str) -> Any:
        package, _, short = name.split("/")
        fields = {field: self._idl(node) for field, node in self._store.fielddefs[name][1]}
        # Final: ROS neither sends nor takes the headers that appendable types have.
        return final(make_idl_struct(f"{short}_", f"{package}::msg::dds_::{short}_", fields))

    def _idl(self, node: Any) -> Any:
        kind, detail = node
        if kind == Nodetype.BASE:
            return _SCALARS[detail[0]]
        if kind == Nodetype.NAME:
            return self._make(detail)
        inner, length = detail
        if kind == Nodetype.ARRAY:
            return idl.array[self._idl(inner), length]  # type: ignore[misc]
        return idl.sequence[self._idl(inner)]  # type: ignore[misc]


_NUMPY_NAMES = {"byte": "uint8", "char": "uint8"}


def _python_type(name: str) -> type:
    if name in ("string", "bool"):
        return str if name == "string" else bool
    return float if name.startswith("float") else int
