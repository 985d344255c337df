"""Odometry is heard on the wire's thread, and where a scan was made is asked on the control thread."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator

import pytest

from chatrobot.execution.estimator import HISTORY, PoseEstimator
from chatrobot.robots.load import load_profile
from chatrobot.wire.messages import Odometry


@pytest.fixture
def threads_that_take_short_turns() -> Iterator[None]:
    before_s = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before_s)


@pytest.mark.usefixtures("threads_that_take_short_turns")
def test_a_pose_may_be_asked_while_odometry_comes() -> None:
    estimator = PoseEstimator(load_profile("wheeltec_mini_mec").limits)
    samples = 5000

    def hear() -> None:
        for i in range(samples):
            estimator.on_odometry(Odometry(0.02 * i, 0.002 * i, 0.0, 0.0, 0.1, 0.0, 0.0))

    thread = threading.Thread(target=hear)
    thread.start()
    while thread.is_alive():
        estimator.pose_at(-1.0)  # looks at all that is kept
    thread.join()
    oldest, latest = estimator.pose_at(-1.0), estimator.pose_at(1e9)
    assert oldest is not None
    assert latest is not None
    assert latest.x_m - oldest.x_m == pytest.approx(0.002 * (HISTORY - 1))
