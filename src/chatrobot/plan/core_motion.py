"""The old home of `RampedTwist`, from which packages written for release 0.1 import it."""

from chatrobot.plan.trajectory import RampedTwist

__all__ = ["RampedTwist"]
