"""The only velocity that a transport sends: one that the governor has passed.

`GovernedTwist` cannot be made without the mint, and only the `governor` package uses the mint (a test reads the
imports). It carries the stop epoch it was made in, so that a velocity made before a stop is worthless after it.
"""

from __future__ import annotations

from chatrobot.core.errors import SafetyError
from chatrobot.core.geometry import Twist


class Mint:
    """The right to make a `GovernedTwist`. For the governor alone."""

    def twist(self, twist: Twist, epoch: int) -> GovernedTwist:
        """Mint a velocity that the governor has passed in that stop epoch."""
        return GovernedTwist(twist, epoch, self)


class GovernedTwist:
    """A velocity that has passed the governor, and the stop epoch it was passed in."""

    __slots__ = ("epoch", "twist")

    def __init__(self, twist: Twist, epoch: int, mint: Mint) -> None:
        if type(mint) is not Mint:
            raise SafetyError("only the governor mints velocities")
        self.twist = twist
        self.epoch = epoch


class StopEpoch:
    """Counts the stops. A stop is one step of this counter, made without a lock from any thread.

    Two stops at the same instant may share a value; either way it has changed, and that is all that is asked.
    """

    __slots__ = ("value",)

    def __init__(self) -> None:
        self.value = 0

    def stop(self) -> None:
        """Void what was minted before."""
        self.value += 1
