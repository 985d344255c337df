"""Messages in CBOR (RFC 8949) with typed arrays (RFC 8746): how rosbridge keeps infinity and NaN apart.

Without the decoder's hooks, whose signature differs between the library's versions 5 and 6.
"""

from __future__ import annotations

import struct
from types import SimpleNamespace
from typing import Any

from cbor2 import CBORDecodeError, CBORTag, loads

TYPED_ARRAYS = {
    64: "B", 68: "B", 72: "b",
    65: ">H", 66: ">I", 67: ">Q", 69: "<H", 70: "<I", 71: "<Q",
    73: ">h", 74: ">i", 75: ">q", 77: "<h", 78: "<i", 79: "<q",
    80: ">e", 81: ">f", 82: ">d", 84: "<e", 85: "<f", 86: "<d",
}  # fmt: skip
"""The format of one element, by tag."""


def read_cbor(packet: bytes) -> Any:
    """The value in `packet`: maps become objects with attributes, typed arrays tuples of numbers.

    Raises:
        ValueError: that is no such value.
    """
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
