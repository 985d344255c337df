"""The heading comes from a gyro whose bias is learned at rest alone; the order in which messages come is no matter."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.execution.estimator import PoseEstimator
from chatrobot.robots.load import load_profile
from chatrobot.wire.messages import Imu, Odometry

DT_S = 0.01
BIAS_RADPS = 0.008
LIMITS = load_profile("wheeltec_mini_mec").limits


class Turntable:
    """A robot that turns on the spot as told; its wheels and its gyro say so, in messages that a test delivers."""

    def __init__(self, bias_radps: float = BIAS_RADPS, noise_radps: float = 0.0009) -> None:
        self.estimator = PoseEstimator(LIMITS)
        self.now_s = 0.0
        self.true_rad = self.wheel_rad = 0.0
        self._bias_radps = bias_radps
        self._noise = random.Random(1)
        self._noise_radps = noise_radps

    def measure(self, rate_radps: float, wheels_radps: float | None = None) -> tuple[Imu, Odometry]:
        """Let a hundredth of a second pass; what is measured then."""
        wheels_radps = rate_radps if wheels_radps is None else wheels_radps
        self.now_s += DT_S
        self.true_rad += rate_radps * DT_S
        self.wheel_rad += wheels_radps * DT_S
        gyro_radps = rate_radps + self._bias_radps + self._noise.gauss(0.0, self._noise_radps)
        yaw_rad = math.remainder(self.wheel_rad, math.tau)
        return Imu(self.now_s, gyro_radps), Odometry(self.now_s, 0.0, 0.0, yaw_rad, 0.0, 0.0, wheels_radps)

    def tell(self, *, stands: bool) -> None:
        self.estimator.rest.note_command(is_zero=stands, now_s=self.now_s)

    def live(self, rate_radps: float, duration_s: float, wheels_radps: float | None = None) -> None:
        for _ in range(round(duration_s / DT_S)):
            imu, odometry = self.measure(rate_radps, wheels_radps)
            self.estimator.on_imu(imu)
            self.estimator.on_odometry(odometry)

    def drive(self, rate_radps: float, duration_s: float) -> None:
        """As a motion of ours does it: told to move, and told to stand."""
        self.tell(stands=False)
        self.live(rate_radps, duration_s)
        self.tell(stands=True)

    @property
    def off_rad(self) -> float:
        assert self.estimator.estimate is not None
        return self.estimator.estimate.pose.yaw_rad - self.true_rad


def test_a_turn_is_as_long_as_it_is_although_the_gyro_has_a_bias_and_the_wheels_slip() -> None:
    table = Turntable()
    table.live(0.0, 1.0)
    table.tell(stands=False)
    table.live(0.6, 10.0, wheels_radps=0.65)
    assert table.off_rad == pytest.approx(0.0, abs=math.radians(0.3))


@pytest.mark.parametrize("creep_radps", [-0.0094, 0.005, 0.015])
def test_what_we_told_to_creep_is_not_learned_as_bias(creep_radps: float) -> None:
    table = Turntable(bias_radps=0.0, noise_radps=0.0)
    table.live(0.0, 0.5)
    table.tell(stands=False)
    table.live(creep_radps, 10.0)
    table.live(0.6, 3.0)
    assert table.off_rad == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("creep_radps", [-0.0094, 0.007, 0.015])
def test_what_others_told_to_creep_is_not_learned_as_bias(creep_radps: float) -> None:
    """Their zero is none that we know of: the wheels give it away."""
    table = Turntable(bias_radps=0.0, noise_radps=0.0)
    table.live(0.0, 0.5)
    table.live(creep_radps, 10.0)
    assert table.off_rad == pytest.approx(0.0, abs=2e-3)
    table.drive(0.6, 3.0)
    assert table.off_rad == pytest.approx(0.0, abs=2e-3)


def test_while_a_body_still_rocks_nothing_is_learned() -> None:
    table = Turntable(bias_radps=0.0, noise_radps=0.0)
    table.live(0.0, 0.5)
    table.drive(0.6, 1.0)
    table.live(0.05, 0.12, wheels_radps=0.0)  # it swings on its springs, the wheels stand
    table.live(-0.05, 0.12, wheels_radps=0.0)
    table.live(0.0, 1.0)
    table.drive(0.6, 10.0)
    assert table.off_rad == pytest.approx(0.0, abs=math.radians(0.1))


@pytest.mark.parametrize("rate_radps", [0.03, 0.5])
def test_a_robot_that_is_turned_by_hand_knows_it_although_its_wheels_stand(rate_radps: float) -> None:
    table = Turntable()
    table.live(0.0, 1.0)
    table.live(rate_radps, 1.0, wheels_radps=0.0)
    table.live(0.0, 1.0)
    assert table.off_rad == pytest.approx(0.0, abs=math.radians(0.2))


def test_a_bias_that_changed_for_good_is_learned_anew() -> None:
    table = Turntable(bias_radps=0.0)
    table.live(0.0, 1.0)
    table._bias_radps = 0.03
    table.live(0.0, 5.0)
    table.drive(0.6, 10.0)
    assert table.off_rad == pytest.approx(0.0, abs=math.radians(0.5))


def test_a_gyro_that_falls_silent_in_a_turn_is_replaced_by_the_wheels() -> None:
    table = Turntable()
    table.live(0.0, 1.0)
    table.tell(stands=False)
    table.live(0.6, 1.0)
    for _ in range(100):
        table.estimator.on_odometry(table.measure(0.6)[1])
    table.live(0.6, 1.0)
    assert table.off_rad == pytest.approx(0.0, abs=math.radians(0.2))


def in_bursts(length: int) -> Callable[[list[tuple[Imu, Odometry]]], list[Imu | Odometry]]:
    """Gyro first, odometry after it, so many of each at a time: a busy machine hands them over like that."""

    def order(measured: list[tuple[Imu, Odometry]]) -> list[Imu | Odometry]:
        messages: list[Imu | Odometry] = []
        for i in range(0, len(measured), length):
            piece = measured[i : i + length]
            messages += [imu for imu, _ in piece]
            messages += [odometry for _, odometry in piece]
        return messages

    return order


@given(st.integers(1, 40), st.integers(0, 60), st.floats(-1.5, 1.5))
def test_an_older_odometry_message_says_nothing_of_newer_gyro_samples(
    burst: int, before: int, rate_radps: float
) -> None:
    table = Turntable(noise_radps=0.0)
    table.live(0.0, 1.0)
    table.tell(stands=False)
    rates = [0.0] * before + [rate_radps] * 100 + [0.0] * 60
    for message in in_bursts(burst)([table.measure(rate) for rate in rates]):
        if isinstance(message, Imu):
            table.estimator.on_imu(message)
        else:
            table.estimator.on_odometry(message)
    assert table.off_rad == pytest.approx(0.0, abs=1e-6)


def test_a_sample_that_was_overtaken_counts_once() -> None:
    table = Turntable(noise_radps=0.0)
    table.live(0.0, 1.0)
    table.tell(stands=False)
    measured = [table.measure(0.6) for _ in range(101)]
    for (late, odometry), (early, next_odometry) in zip(measured[::2], measured[1::2], strict=False):
        for imu in (early, late):
            table.estimator.on_imu(imu)
        table.estimator.on_odometry(odometry)
        table.estimator.on_odometry(next_odometry)
    assert table.off_rad == pytest.approx(0.0, abs=0.6 * 2 * DT_S)


def test_a_robot_without_a_gyro_turns_as_its_wheels_say() -> None:
    table = Turntable()
    for _ in range(300):
        table.estimator.on_odometry(table.measure(0.6)[1])
    assert table.off_rad == pytest.approx(0.0, abs=1e-9)
