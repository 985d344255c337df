"""What a program is started with."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Literal

from chatrobot.core.wiring import Wiring

LATEST_S = 1e6
"""No program lives longer: eleven days."""

Mode = Literal["virtual", "live"]


@dataclass(frozen=True)
class ProgramSettings:
    """All that goes into the sandbox besides the code that is there anyway.

    `topics` maps what the robot has (cmd_vel, odom, scan, imu, battery, bumper) to resolved ROS names (`/cmd_vel`).
    `remaps` maps names as ROS's remapping does (`/turtle1/cmd_vel` to `/cmd_vel`); `args` are its command-line
    arguments, which go before them where they remap.
    `start_ns` is the wall clock at the program's start on virtual time, `horizon_s` where virtual time ends.
    """

    source: str
    name: str = "program"
    mode: Mode = "virtual"
    topics: Mapping[str, str] = field(default_factory=dict)
    odom_type: str = "Odometry"
    remaps: Mapping[str, str] = field(default_factory=dict)
    args: tuple[str, ...] = ()
    start_ns: int = 1_800_000_000_000_000_000
    horizon_s: float = math.inf

    def to_bytes(self) -> bytes:
        """Return them as the sandbox gets them."""
        return json.dumps(asdict(self)).encode()

    @classmethod
    def from_bytes(cls, data: bytes) -> ProgramSettings:
        """Read what `to_bytes` made."""
        values = json.loads(data)
        return cls(**{**values, "args": tuple(values["args"])})


def robot_topics(wiring: Wiring) -> dict[str, str]:
    """Return the topics of one robot by what they are, resolved."""
    topics = {"cmd_vel": wiring.cmd_vel_topic, **wiring.sensor_topics}
    return {name: f"/{topic.lstrip('/')}" for name, topic in topics.items()}
