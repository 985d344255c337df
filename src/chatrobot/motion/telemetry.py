"""Publishes telemetry ten times a second, whether anything moves or not."""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.events import Event, Telemetry
from chatrobot.execution.lookahead import nearest_m
from chatrobot.execution.sensors import Sensors
from chatrobot.motion.plan_executor import PlanExecutor

TELEMETRY_S = 0.1


class TelemetryPublisher:
    """Publishes how far the motion is, and where and how fast the robot goes, as it measures it itself."""

    def __init__(self, sensors: Sensors, executor: PlanExecutor, emit: Callable[[Event], None]) -> None:
        self._sensors = sensors
        self._executor = executor
        self._emit = emit
        self._next_s = 0.0

    def tick(self, now_s: float) -> None:
        """Tell it if it is time, and the robot has said where it is."""
        if now_s < self._next_s:
            return
        self._next_s = now_s + TELEMETRY_S
        estimate, scan = self._sensors.estimate, self._sensors.scan
        if estimate is None:
            return
        progress = self._executor.progress(now_s)
        if progress is not None:
            self._emit(progress)
        self._emit(
            Telemetry(
                progress.turn if progress is not None else 0,
                estimate.pose,
                estimate.twist,
                estimate.path_m,
                self._sensors.battery_percent,
                nearest_m(scan) if scan is not None else None,
                progress is not None,
                self._sensors.estimator.epoch,
            )
        )
