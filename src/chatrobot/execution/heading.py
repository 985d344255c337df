"""Heading: by the gyro, and by the wheels where the gyro is silent or not yet calibrated.

Odometry and gyro come in no certain order, so each gyro sample waits for odometry that is at least as new as itself:
only then is it known whether the robot was at rest while the sample was taken.
"""

from __future__ import annotations

import math
import statistics
from collections import deque
from itertools import pairwise
from typing import NamedTuple

from chatrobot.wire.messages import Imu

BIAS_SAMPLES = 300
"""Gyro samples the bias is averaged over (3 s at 100 Hz); more would follow a warming gyro too slowly."""
WINDOW_S = 0.1
WINDOW_SAMPLES = 5
"""The bias is learned from a piece of rest at least so long, and with so many samples."""
FIRST_SAMPLES = 3
"""A robot that sets out at once gets a first guess from so few."""
STILL_RADPS = 0.01
"""A gyro whose samples spread more than this (standard deviation) is on a robot that is being shaken: ten times the
noise of a cheap gyro."""
ROLLED_RAD = 2e-4
"""Wheels that turned by this much in a piece of rest were not at rest, however slowly they went."""
SUDDEN_RADPS = 0.01
"""No bias changes so much between two motions. A rate this far off is a turn by hand, unless it lasts."""
LASTING_S = 3.0
PUSHED_RADPS = 0.06
"""Above this a robot at rest is being turned by hand, and that is motion, however long it lasts."""

GYRO_GAP_S = 0.15
"""Where the gyro was silent for longer than this the wheels tell how much the robot turned meanwhile."""
_SAMPLES_WAITING = 1000
_WHEELS_KEPT = 200


class _Sample(NamedTuple):
    """A rate, how long it lasted, and what the wheels turned meanwhile."""

    rate_radps: float
    duration_s: float
    wheel_turn_rad: float


class Heading:
    """Sums up turns. Feed it gyro samples as they come, and with each odometry what the wheels have turned in all.

    Args:
        turn_scale: what is really turned for each radian that wheels and gyro tell.
    """

    def __init__(self, turn_scale: float = 1.0) -> None:
        self._turn_scale = turn_scale
        self._waiting: deque[Imu] = deque(maxlen=_SAMPLES_WAITING)
        self._wheels: deque[tuple[float, float]] = deque(maxlen=_WHEELS_KEPT)
        self._settled_s = math.inf
        self._settled_rad = 0.0
        self._wheels_at_settled_rad = 0.0
        self._rest: list[_Sample] = []
        self._rate_radps = 0.0
        self.bias_radps = 0.0
        self._bias_samples = 0

    @property
    def has_gyro(self) -> bool:
        """Return True where there is a gyro, and its bias is known."""
        return self._bias_samples > 0

    def on_imu(self, message: Imu) -> None:
        """Take a gyro sample, from any thread."""
        if math.isfinite(message.wz_radps):
            self._waiting.append(message)

    def at(self, stamp_s: float, wheels_rad: float, rested_since_s: float) -> float:
        """Return the turn in all, rad, at `stamp_s`, when the wheels have turned `wheels_rad` in all.

        Args:
            rested_since_s: since when the robot has been at rest; infinite where it moves.
        """
        if self._settled_s == math.inf:
            self._settled_s, self._wheels_at_settled_rad = stamp_s, wheels_rad
        self._wheels.append((stamp_s, wheels_rad))
        while self._waiting and self._waiting[0].stamp_s <= stamp_s:
            self._take(self._waiting.popleft(), rested_since_s)
        # What the gyro has not told yet of the time up to now, the wheels have.
        return self._settled_rad + self._turn_scale * (wheels_rad - self._wheels_at_settled_rad)

    def rate_radps(self, stamp_s: float, wheels_radps: float) -> float:
        """Return how fast it turns at `stamp_s`, where the wheels say `wheels_radps`."""
        if self.has_gyro and stamp_s - self._settled_s < GYRO_GAP_S:
            return self._rate_radps
        return wheels_radps * self._turn_scale

    def _take(self, message: Imu, rested_since_s: float) -> None:
        duration_s = message.stamp_s - self._settled_s
        if duration_s <= 0.0:
            return  # overtaken on its way: its time has been counted
        wheels_rad = self._wheels_at(message.stamp_s)
        sample = _Sample(message.wz_radps, duration_s, wheels_rad - self._wheels_at_settled_rad)
        is_rest = self._settled_s >= rested_since_s and duration_s <= GYRO_GAP_S
        self._settled_s, self._wheels_at_settled_rad = message.stamp_s, wheels_rad
        if is_rest and not (self.has_gyro and abs(sample.rate_radps - self.bias_radps) > PUSHED_RADPS):
            self._rest.append(sample)
            self._rate_radps = 0.0
            self._learn()
        else:
            self._turn_meanwhile()
            self._integrate(sample)

    def _learn(self) -> None:
        """Take a piece of rest as bias, once it is long enough to tell it from a turn by hand."""
        lasted_s = sum(sample.duration_s for sample in self._rest)
        if lasted_s < WINDOW_S or len(self._rest) < WINDOW_SAMPLES:
            return
        if not self._is_quiet():
            self._turn_meanwhile()
            return
        rate_radps = statistics.fmean(sample.rate_radps for sample in self._rest)
        if self.has_gyro and abs(rate_radps - self.bias_radps) > SUDDEN_RADPS:
            if lasted_s < LASTING_S:
                return
            self._bias_samples = 0
        self._average()
        self._rest.clear()

    def _is_quiet(self) -> bool:
        """Return True where neither the gyro's samples nor the wheels show that anything moved meanwhile."""
        rolled_rad = abs(sum(sample.wheel_turn_rad for sample in self._rest))
        rates_radps = [sample.rate_radps for sample in self._rest]
        middle_radps = statistics.fmean(rates_radps)
        spread_radps = math.sqrt(statistics.fmean((rate - middle_radps) ** 2 for rate in rates_radps))
        return rolled_rad <= ROLLED_RAD and spread_radps <= STILL_RADPS

    def _average(self) -> None:
        for sample in self._rest:
            self._bias_samples = min(self._bias_samples + 1, BIAS_SAMPLES)
            self.bias_radps += (sample.rate_radps - self.bias_radps) / self._bias_samples

    def _turn_meanwhile(self) -> None:
        """Count as turned what looked like rest, and was too short or too lively for it."""
        if not self.has_gyro and len(self._rest) >= FIRST_SAMPLES and self._is_quiet():
            self._average()
        for sample in self._rest:
            self._integrate(sample)
        self._rest.clear()

    def _integrate(self, sample: _Sample) -> None:
        turn_rad = sample.wheel_turn_rad
        if self.has_gyro and sample.duration_s <= GYRO_GAP_S:
            turn_rad = (sample.rate_radps - self.bias_radps) * sample.duration_s
        self._rate_radps = self._turn_scale * turn_rad / sample.duration_s
        self._settled_rad += self._turn_scale * turn_rad

    def _wheels_at(self, stamp_s: float) -> float:
        """Return what the wheels had turned by `stamp_s`, between two odometry messages."""
        for (after_s, after_rad), (before_s, before_rad) in pairwise(reversed(self._wheels)):
            if before_s <= stamp_s:
                share = (stamp_s - before_s) / (after_s - before_s)
                return before_rad + share * (after_rad - before_rad)
        return self._wheels[0][1]
