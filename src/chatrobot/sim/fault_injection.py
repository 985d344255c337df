"""Faults injected into a simulated robot: slipping wheels, late or lost messages, noise, and worse.

`FaultInjection.parse("slip=0.03,latency_s=0.05,noise=on,seed=1")` reads what `--sim` was given.
"""

from __future__ import annotations

import difflib
import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

from chatrobot.core.errors import UsageError

Blocked = Literal["spin", "stall"]
OdomWrong = Literal["right", "reversed", "turn_reversed", "frozen", "nan"]

GYRO_BIAS_RADPS = 0.01
"""Largest gyro bias drawn for a seed, 0.6 deg/s: what is left of an MPU-6050's zero-rate output (up to 20
deg/s, InvenSense PS-MPU-6000A, 6.1) once a driver has averaged it away at start-up and the chip has warmed up
since."""
GYRO_NOISE_RADPS = 0.0009
"""Standard deviation of a gyro sample: 0.05 deg/s rms, total noise of an MPU-6050 (PS-MPU-6000A, 6.1)."""
ENCODER_NOISE = 0.01
"""Dimensionless standard deviation of one wheel increment relative to its size; over a metre it averages out to below a
millimetre. Proportional to the motion as in Thrun, Burgard, Fox, Probabilistic Robotics (2005), 5.4; the size
is our choice."""
LIDAR_NOISE_M = 0.01
"""Standard deviation of a range: 10 mm, from LDROBOT's data sheet of the LD19 (0.3 to 12 m)."""
ODOM_JUMP_M = 0.5
"""How far `odom_jump_after_s` makes odometry jump to the left, all at once."""


@dataclass(frozen=True)
class FaultInjection:
    """The faults of the simulated robot; without any it measures exactly.

    Attributes:
        slip: the wheels report more than happens: true travel, linear and angular, is (1 - slip) of it; dimensionless.
        one_wheel_slip: the same for the wheels on the left side alone, so that the robot veers to the left.
        latency_s: odometry, gyro and scan arrive that late, stamped with the time they were measured at.
        noise: encoders, gyro and lidar are as noisy as real ones.
        gyro_bias_radps: what the gyro adds to the truth; None: drawn by the seed if there is noise, else 0.
        dropout: the share of odometry messages that is lost.
        seed: two runs with the same seed and the same commands are the same run.
        stuck_after_m: once it has travelled that far nothing moves it any more.
        blocked: what the wheels do while the robot cannot move: `spin` (odometry counts on) or `stall`.
        odom_silent_after_s: odometry falls silent for good.
        odom_jump_after_s: odometry jumps once, by `ODOM_JUMP_M`.
        odom_wrong: `reversed` (forward is reported as backward), `turn_reversed` (left as right),
            `frozen` (the first pose for ever, under fresh stamps), `nan`.
        lidar_zeros: a cheap lidar: 0.0 for what is too far and for what is too near alike.
        lidar_fov_deg: how much of the circle has beams, around the lidar's own x axis.
    """

    slip: float = 0.0
    one_wheel_slip: float = 0.0
    latency_s: float = 0.0
    noise: bool = False
    gyro_bias_radps: float | None = None
    dropout: float = 0.0
    seed: int = 0
    stuck_after_m: float = math.inf
    blocked: Blocked = "spin"
    odom_silent_after_s: float = math.inf
    odom_jump_after_s: float = math.inf
    odom_wrong: OdomWrong = "right"
    lidar_zeros: bool = False
    lidar_fov_deg: float = 360.0

    @classmethod
    def parse(cls, text: str) -> FaultInjection:
        """Read `key=value,key=value`; an empty text injects no fault.

        Raises:
            UsageError: an unknown key, a key twice or a value that is not possible; names the allowed ones.
        """
        values: dict[str, object] = {}
        for item in filter(None, (part.strip() for part in text.split(","))):
            key, equals, value = (part.strip() for part in item.partition("="))
            if key not in _READERS:
                raise UsageError(_unknown(key), where="--sim", allowed=f"allowed: {', '.join(_READERS)}")
            if key in values:
                raise UsageError(f"{key} is given twice", where="--sim")
            read, allowed = _READERS[key]
            try:
                values[key] = read(value)
            except ValueError:
                problem = f"{key}={value} is not possible" if equals else f"{key} has no value"
                raise UsageError(problem, where="--sim", allowed=f"{key} takes {allowed}") from None
        return cls(**values)  # type: ignore[arg-type]

    @property
    def bias_radps(self) -> float:
        """Return the gyro's bias in this run."""
        if self.gyro_bias_radps is not None:
            return self.gyro_bias_radps
        if not self.noise:
            return 0.0
        return random.Random(f"gyro bias {self.seed}").uniform(-GYRO_BIAS_RADPS, GYRO_BIAS_RADPS)


NO_FAULTS = FaultInjection()


def _unknown(key: str) -> str:
    close = difflib.get_close_matches(key, _READERS, n=1)
    return f"unknown key {key!r}" + (f", did you mean {close[0]}?" if close else "")


def _number(least: float, most: float) -> Callable[[str], float]:
    def read(text: str) -> float:
        value = float(text)
        if not (math.isfinite(value) and least <= value <= most):
            raise ValueError(text)
        return value

    return read


def _one_of(*allowed: str) -> Callable[[str], str]:
    def read(text: str) -> str:
        if text not in allowed:
            raise ValueError(text)
        return text

    return read


def _switch(text: str) -> bool:
    if text not in ("on", "off"):
        raise ValueError(text)
    return text == "on"


_SHARE = (_number(0.0, 1.0), "a share from 0 to 1")
_TIME = (_number(0.0, 1e6), "seconds, 0 or more")

_READERS: dict[str, tuple[Callable[[str], object], str]] = {
    "slip": (_number(-0.5, 1.0), "a share from -0.5 to 1"),
    "one_wheel_slip": _SHARE,
    "latency_s": (_number(0.0, 10.0), "seconds from 0 to 10"),
    "noise": (_switch, "on or off"),
    "gyro_bias_radps": (_number(-1.0, 1.0), "rad/s from -1 to 1"),
    "dropout": _SHARE,
    "seed": (int, "a whole number"),
    "stuck_after_m": (_number(0.0, 1e6), "metres, 0 or more"),
    "blocked": (_one_of(*get_args(Blocked)), "spin or stall"),
    "odom_silent_after_s": _TIME,
    "odom_jump_after_s": _TIME,
    "odom_wrong": (_one_of(*get_args(OdomWrong)), ", ".join(get_args(OdomWrong))),
    "lidar_zeros": (_switch, "on or off"),
    "lidar_fov_deg": (_number(1.0, 360.0), "degrees from 1 to 360"),
}
