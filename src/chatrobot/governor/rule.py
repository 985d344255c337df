"""What a rule of the governor is: it sees a request and the situation, and says how much of it may be sent.

Rules only ever take away: a factor from 0 to 1. The governor asks all of them and the smallest factor wins.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason


@dataclass(frozen=True)
class Ruling:
    """What a rule makes of a request: the twist may be sent times `factor` (0..1).

    `urgent` means that a ramp that would come too late is skipped: zero at once. A rule that only wants the robot
    slower, but has no distance to keep, leaves it to the ramp.
    """

    factor: float
    reason: Reason | None = None
    urgent: bool = True


FREE = Ruling(1.0)


@dataclass(frozen=True)
class Sensed:
    """What the robot's sensors say of themselves.

    `ages_s` tells by name (`odom`, `scan`, `imu`) how long ago each was last heard; a name that is missing was
    never heard. `battery_percent` is None where nobody told.
    """

    ages_s: Mapping[str, float] = field(default_factory=dict)
    battery_percent: float | None = None


NOTHING_SENSED = Sensed()


@dataclass(frozen=True)
class Situation:
    """What a rule may know: `pose` in `odom`, None where it is unknown; `begins` where a new motion asks to begin."""

    pose: Pose | None
    sensed: Sensed = NOTHING_SENSED
    begins: bool = False


class Rule(Protocol):
    """One reason to go slower, or not at all."""

    @property
    def name(self) -> str:
        """What a verdict calls it."""
        ...

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        """How much of `asked` (within the profile's limits already) may be sent."""
        ...
