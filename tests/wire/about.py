"""Messages as they come out of a format that rounds to float32, turns yaw into a quaternion and translates stamps."""

from __future__ import annotations

import math
from typing import Any

import pytest

from chatrobot.wire.messages import Message


class About:
    """Equals a message of the same type whose numbers are nearly the same; stamps are not compared."""

    def __init__(self, message: Message) -> None:
        self._message = message

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self._message):
            return False
        pairs = zip(self._message._asdict().items(), tuple(other))  # type: ignore[call-overload]
        return all(name == "stamp_s" or _near(sent, arrived) for (name, sent), arrived in pairs)

    def __hash__(self) -> int:
        return hash(self._message)

    def __repr__(self) -> str:
        return f"about {self._message}"


def _near(sent: Any, arrived: Any) -> bool:
    if isinstance(sent, list):
        return len(sent) == len(arrived) and all(map(_near, sent, arrived))
    if isinstance(sent, float) and math.isfinite(sent):
        return bool(arrived == pytest.approx(sent, rel=1e-6, abs=1e-9))
    if isinstance(sent, float) and math.isnan(sent):
        return math.isnan(arrived)
    return bool(sent == arrived)
