"""The topics of the nodes (std_msgs/String and std_msgs/Bool alone, so that nothing has to be built to listen)."""

from __future__ import annotations

import json
from typing import NamedTuple

from chatrobot.link.envelope import PROTOCOL, protocol_of

USER_INPUT = "user_input"
"""What a person says: text. Motion listens, too, for stop words."""

CHATGPT_NODE = "chatgpt_node"
"""Envelopes (JSON) from `base` to `control`; text of others as the tutorial has it."""

EVENTS = "chatrobot/events"
"""What happens, one JSON event a message; quiet while nothing happens."""

TELEMETRY = "chatrobot/telemetry"
"""Where the robot is and how it moves, ten times a second: the JSON event `telemetry`."""

REPLY = "chatrobot/reply"
"""Sentences for people."""

STOP = "chatrobot/stop"
"""std_msgs/Bool: true stops."""

CONTROL = "chatrobot/control"
"""Every Motion says ten times a second that it is there: {"id", "node", "host", "pid", "hears": [leases]}."""

OPERATOR = "chatrobot/operator"
"""`input` says many times a second that it is there, and what it said last (`nodes/operator.py`)."""


class MotionBeat(NamedTuple):
    """What a Motion says of itself. `hears`: the leases of the sources it has heard. `open_loop`: the limits it drives
    within where it drives open loop, else None. `protocol`: of its link."""

    id: str
    name: str
    hears: frozenset[str]
    open_loop: dict[str, float] | None = None
    protocol: int = PROTOCOL


def read_beat(text: str) -> MotionBeat | None:
    """None where it is something else."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(data, dict) or not {"id", "node", "host", "pid"} <= data.keys():
        return None
    name = f"{data['node']} (process {data['pid']} on {data['host']})"
    hears = data.get("hears")
    leases = frozenset(map(str, hears)) if isinstance(hears, list) else frozenset[str]()
    return MotionBeat(str(data["id"]), name[:120], leases, _numbers(data.get("open_loop")), protocol_of(data))


def _numbers(values: object) -> dict[str, float] | None:
    """The numbers by their names, where it is that."""
    if not isinstance(values, dict):
        return None
    return {str(name): float(value) for name, value in values.items() if isinstance(value, (int, float))}
