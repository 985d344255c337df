"""What is left out where many robots are recorded at once: what one says again and again while nothing changes.

A class records each topic ten times a second while it changes, and once a second while it does not. A velocity that
begins or ends a motion is never left out, nor is an event other than telemetry.
"""

from __future__ import annotations

import math
from typing import Any

from chatrobot.core.event import Event
from chatrobot.core.sensed_events import Telemetry
from chatrobot.recording.topics import Topic
from chatrobot.wire.messages import Message, Odometry, TwistMessage

CHANGING_S, SAME_S = 0.1, 1.0
"""What changes is recorded so often, what stays the same so often."""
_EARLY_S = 0.01
"""Messages 20 ms apart come a little early or late."""
_DIGITS = 3
"""A millimetre, or a thousandth of a radian, is no change."""


class Thinning:
    """Chooses among the messages of one robot; each topic comes from one thread."""

    def __init__(self) -> None:
        self._kept: dict[str, tuple[float, tuple[Any, ...]]] = {}

    def keeps(self, topic: Topic, message: Message | Event, now_s: float) -> bool:
        """Tell whether that message is to be recorded."""
        says = _says(message)
        if says is None:
            return True
        kept_s, said = self._kept.get(topic.name, (-math.inf, ()))
        wait_s = CHANGING_S if says != said else SAME_S
        turns = isinstance(message, TwistMessage) and any(says) != any(said)
        if not turns and now_s - kept_s < wait_s - _EARLY_S:
            return False
        self._kept[topic.name] = (now_s, says)
        return True


def _says(message: Message | Event) -> tuple[Any, ...] | None:
    """What it says, apart from when; None where each is recorded."""
    if isinstance(message, Odometry):
        return _rounded(message[1:])
    if isinstance(message, TwistMessage):
        return _rounded(message)
    if isinstance(message, Telemetry):
        return (*_rounded(message.pose), message.moving)
    return None


def _rounded(values: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(value, _DIGITS) for value in values)
