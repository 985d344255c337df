"""Speeds: what a frame says about how fast, for this robot."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from chatrobot.language.frames import Frame
from chatrobot.language.numbers import is_chinese
from chatrobot.language.unclear import Unclear
from chatrobot.robots.profile import RobotProfile

SLOW, FAST = 0.5, 1.7
"""Factors of the default where somebody says slowly or fast without a number."""


@dataclass(frozen=True)
class Pace:
    """The robot's limits and what counts as usual in this dialogue. None: the profile's default, unsaid.

    `before_mps` and `before_radps` were said of the last motion: `another metre at half that speed`. `unsaid_m` and
    `unsaid_rad` are what a person set for a drive and a turn without an amount.
    """

    profile: RobotProfile
    speed_mps: float | None = None
    rate_radps: float | None = None
    before_mps: float | None = None
    before_radps: float | None = None
    unsaid_m: float | None = None
    unsaid_rad: float | None = None

    @property
    def distance_m(self) -> float:
        """How far a drive goes that says no distance."""
        return self.unsaid_m or self.profile.defaults.distance_m

    @property
    def turn_rad(self) -> float:
        """How far a turn goes that says no angle, rad."""
        return self.unsaid_rad or self.profile.defaults.turn_rad

    def speed(self, frame: Frame) -> float | None:
        """The linear speed a frame asks for, m/s; None where it says nothing."""
        limits, default = self.profile.limits, self.speed_mps or self.profile.defaults.speed_mps
        if "speed" in frame.q:
            return _positive(frame, "speed")
        said = _relative(frame, default, self.before_mps or default, limits.max_speed_mps)
        return said if said is not None else _standing(frame, self.speed_mps, self.profile.defaults.speed_mps)

    def rate(self, frame: Frame) -> float | None:
        """The turn rate a frame asks for, rad/s; None where it says nothing."""
        limits, default = self.profile.limits, self.rate_radps or self.profile.defaults.rate_radps
        if "rate" in frame.q:
            return _positive(frame, "rate")
        said = _relative(frame, default, self.before_radps or default, limits.max_rate_radps)
        return (
            said if said is not None else _standing(frame, self.rate_radps, self.profile.defaults.rate_radps)
        )


_COMPARED = re.compile("slower|faster|quicker|慢|快")


def _standing(frame: Frame, chosen: float | None, usual: float) -> float | None:
    """The speed that was chosen from now on; `at normal speed` is the profile's all the same."""
    return usual if chosen and frame.pace == "default" else chosen


def _positive(frame: Frame, name: str) -> float:
    value = frame.q[name].number
    if not math.isfinite(value) or value <= 0.0:
        raise Unclear("bad_number", frame.q[name].text)
    return value


def _relative(frame: Frame, default: float, before: float, maximum: float) -> float | None:
    if "percent" in frame.q:
        share = _positive(frame, "percent")
        if frame.pace not in ("slow", "fast") or not _COMPARED.search(frame.text):
            return share * maximum
        if frame.pace == "slow" and share >= 1.0:
            raise Unclear("bad_number", frame.q["percent"].text)
        return before * (1.0 - share if frame.pace == "slow" else 1.0 + share)  # 20 % slower
    fold = frame.q.get("fold")
    if fold is not None and is_chinese(fold.text) and not re.search("速|快|平|默|正|车|原|半", fold.text):
        raise Unclear("unclear_motion", frame.text)  # twice what?
    of_before = before if "same_amount" in frame.flags else default  # 同样的距离，速度翻倍
    for name, usual in (("fold", of_before), ("faster", before)):
        if name in frame.q:
            return _positive(frame, name) * usual
    factors = {
        "slow": SLOW * default,
        "fast": min(FAST * default, maximum),
        "max": maximum,
        "half_max": maximum / 2,
        "half": before / 2,  # 太快了，用一半的速度退回来
    }
    return factors.get(frame.pace)
