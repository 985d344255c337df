"""A whole running ChatRobot (console, Motion, guard, robot: four processes) and an ear on its wire.

Used by the tests of death and silence and by `bench/`. Stamps are of the machine's monotonic clock, taken in this
process, which is none of the four.
"""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import psutil

from chatrobot.core.errors import WireError
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage

PATIENCE_S = 30.0


class Ear:
    """Hears every velocity on a wire, with its time."""

    def __init__(self, wire_path: Path) -> None:
        self._wire = LocalWire(wire_path)
        self._heard = threading.Condition()
        self.velocities: list[tuple[float, TwistMessage]] = []
        self._wire.subscribe("cmd_vel", TwistMessage, self._hear)

    def _hear(self, message: TwistMessage) -> None:
        now_s = time.monotonic()
        with self._heard:
            self.velocities.append((now_s, message))
            self._heard.notify_all()

    def wait_for(self, wanted: Callable[[TwistMessage], bool], since_s: float = 0.0) -> float:
        """When the first wanted velocity after `since_s` came."""
        deadline_s = time.monotonic() + PATIENCE_S
        with self._heard:
            while True:
                for at_s, message in reversed(self.velocities):
                    if at_s < since_s:
                        break
                    if wanted(message):
                        return min(t for t, m in self.velocities if t >= since_s and wanted(m))
                left_s = deadline_s - time.monotonic()
                if left_s <= 0.0:
                    raise AssertionError("no such velocity was heard")
                self._heard.wait(left_s)

    def wait_for_motion(self, since_s: float = 0.0) -> float:
        return self.wait_for(lambda message: any(message), since_s)

    def seconds_to_zero(self, since_s: float, watch_s: float = 0.4) -> float:
        """Seconds from `since_s` to the zero after which nothing moved any more for `watch_s`."""
        self.wait_for(lambda message: not any(message), since_s)
        with self._heard:
            self._heard.wait_for(lambda: False, timeout=watch_s)
            moving = [t for t, message in self.velocities if t >= since_s and any(message)]
            last_motion_s = moving[-1] if moving else since_s
            zeros = [t for t, message in self.velocities if t >= last_motion_s and not any(message)]
        if not zeros:
            return float("inf")
        return zeros[0] - since_s

    def close(self) -> None:
        self._wire.close()


class RunningRobot:
    """`chatrobot --json` as another program would run it."""

    def __init__(self, folder: Path, arguments: Sequence[str] = ("--json", "--world", "empty")) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._lines: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
        environment = {**os.environ, "XDG_RUNTIME_DIR": str(folder), "PYTHONUNBUFFERED": "1"}
        self.console = subprocess.Popen(
            [sys.executable, "-m", "chatrobot", *arguments, "--config-dir", str(folder / "config")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment,
            start_new_session=True,
            text=True,
        )
        threading.Thread(target=self._read, daemon=True).start()
        self.wire_path = self._wait_for_file("sim-*.wire")
        self.ear = self._listen(self.wire_path)
        self.motion_pid = int(self._wait_for_file("motion-*.stop").stem.removeprefix("motion-"))

    def say(self, text: str) -> float:
        """Say it; the moment at which it was said."""
        assert self.console.stdin is not None
        now_s = time.monotonic()
        self.console.stdin.write(text + "\n")
        self.console.stdin.flush()
        return now_s

    def wait_for_event(self, name: str, **fields: object) -> dict[str, Any]:
        """The next event of that name with those fields."""
        while True:
            event = self._lines.get(timeout=PATIENCE_S)
            if event.get("event") == name and all(event.get(key) == value for key, value in fields.items()):
                return event

    def close(self) -> None:
        """End what this started and nothing else."""
        self.ear.close()
        for pid in (self.console.pid, self.motion_pid, *self._guards()):
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)
                os.kill(pid, signal.SIGKILL)
        self.console.wait(PATIENCE_S)

    def _guards(self) -> Iterator[int]:
        """Guards that this robot's wire still has; one may be frozen, and would then stay for ever."""
        for process in psutil.process_iter(["pid", "cmdline"]):
            said = process.info["cmdline"] or []
            if "chatrobot.guard" in said and any(str(self.folder) in word for word in said):
                yield process.info["pid"]

    def _read(self) -> None:
        assert self.console.stdout is not None
        with contextlib.suppress(OSError):  # a test may close this end
            for line in self.console.stdout:
                with contextlib.suppress(ValueError):
                    self._lines.put(json.loads(line))

    @staticmethod
    def _listen(wire_path: Path) -> Ear:
        """The file may be there a moment before anybody listens at it."""
        deadline_s = time.monotonic() + PATIENCE_S
        while True:
            try:
                return Ear(wire_path)
            except WireError:
                if time.monotonic() > deadline_s:
                    raise
                time.sleep(0.01)

    def _wait_for_file(self, pattern: str) -> Path:
        deadline_s = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline_s:
            for path in (self.folder / "chatrobot").glob(pattern):
                return path
            if self.console.poll() is not None:
                raise AssertionError(f"chatrobot ended with {self.console.returncode}")
            time.sleep(0.01)
        raise AssertionError(f"{pattern} did not appear")
