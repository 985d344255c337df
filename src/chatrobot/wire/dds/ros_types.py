"""ROS 2 message definitions as Cyclone types; their bytes (CDR) are written by rosbags.

Cyclone's own Python serialiser is three to six times slower; here its types only say what a topic carries, and the
bytes pass through untouched.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cyclonedds.core import Policy
from cyclonedds.idl import make_idl_struct
from cyclonedds.idl import types as idl
from cyclonedds.idl.annotations import final
from rosbags.interfaces import Nodetype

from chatrobot.wire.dds.definitions import RosDefinitions

_SCALARS: dict[str, Any] = {
    "bool": bool,
    "byte": idl.uint8,
    "char": idl.uint8,
    "string": str,
    **{name: getattr(idl, name) for name in ("int8", "int16", "int32", "int64", "float32", "float64")},
    **{name: getattr(idl, name) for name in ("uint8", "uint16", "uint32", "uint64")},
}


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


class RosTypes(RosDefinitions):
    """The definitions one process speaks, as Cyclone's types; arguments as of `RosDefinitions`."""

    def __init__(self, gid_bytes: int = 16) -> None:
        super().__init__(gid_bytes)
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

    def typehash(self, name: str) -> Policy.Userdata:
        """The hash as an endpoint tells it: without it every ROS process that meets us warns."""
        return Policy.Userdata(f"typehash={self.hash_of(name)};".encode())

    def sample(self, name: str, fields: Mapping[str, Any]) -> Any:
        """A sample of `topic_type(name)`; fields left out are zero."""
        made = object.__new__(self.topic_type(name))
        made.cdr = self.cdr(name, fields)
        return made

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
