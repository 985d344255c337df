"""Programs in processes of their own: what they print and publish, and when (monotonic seconds, taken here)."""

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
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from chatrobot.core.errors import WireError
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage

PATIENCE_S = 30.0
T = TypeVar("T")


def wait_until(holds: Callable[[], bool], timeout_s: float = PATIENCE_S) -> None:
    """Wait until something is so."""
    ends_s = time.monotonic() + timeout_s
    while not holds():
        assert time.monotonic() < ends_s, "it did not come to that"
        time.sleep(0.01)


class Heard:
    """A callback that keeps all messages with their times: `wire.subscribe("cmd_vel", TwistMessage, Heard())`."""

    def __init__(self, patience_s: float = PATIENCE_S) -> None:
        self._patience_s = patience_s
        self._changed = threading.Condition()
        self.all: list[tuple[float, Any]] = []

    def __call__(self, message: Any) -> None:
        now_s = time.monotonic()
        with self._changed:
            self.all.append((now_s, message))
            self._changed.notify_all()

    def wait_for(
        self, wanted: Callable[[Any], bool], since_s: float = 0.0, timeout_s: float | None = None
    ) -> tuple[float, Any]:
        """Return the first wanted message since then, and its time."""
        ends_s = time.monotonic() + (self._patience_s if timeout_s is None else timeout_s)
        with self._changed:
            seen = 0
            while True:
                for at_s, message in self.all[seen:]:
                    if at_s >= since_s and wanted(message):
                        return at_s, message
                seen = len(self.all)
                if not self._changed.wait(max(0.0, ends_s - time.monotonic())):
                    raise AssertionError(f"it did not come; last heard: {self.all[-3:]}")

    def since(self, since_s: float) -> list[tuple[float, Any]]:
        """Return all that came since then."""
        return [entry for entry in tuple(self.all) if entry[0] >= since_s]

    def wait_for_motion(self, since_s: float = 0.0) -> float:
        """Return when the first velocity came that is not zero."""
        return self.wait_for(any, since_s)[0]

    def wait_for_zero(self, since_s: float = 0.0) -> float:
        """Return when the first zero velocity came."""
        return self.wait_for(lambda twist: not any(twist), since_s)[0]

    def seconds_to_zero(self, since_s: float, watch_s: float = 0.5) -> float:
        """Return the seconds to the zero after which nothing moves for `watch_s`."""
        zero_s = self.wait_for_zero(since_s)
        while True:
            try:
                moved_s, _ = self.wait_for(any, zero_s, watch_s)
            except AssertionError:
                return zero_s - since_s
            zero_s = self.wait_for_zero(moved_s)


class TalkingProcess:
    """A program in a session of its own: write to its standard input, wait for what it prints."""

    patience_s = PATIENCE_S

    def __init__(
        self, arguments: Sequence[str], environment: Mapping[str, str], stderr: int | None = subprocess.STDOUT
    ) -> None:
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(
            arguments,
            stdin=pipe,
            stdout=pipe,
            stderr=stderr,
            env=environment,
            start_new_session=True,
            text=True,
        )
        self.lines: list[str] = []
        self._queue: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def say(self, line: str) -> float:
        """Write a line; return when."""
        assert self.process.stdin is not None
        now_s = time.monotonic()
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()
        return now_s

    def wait_for_line(self, part: str, timeout_s: float | None = None) -> str:
        """Return the next line that holds `part`."""
        return self._next(lambda line: line if part in line else None, part, timeout_s)

    def wait_for_event(self, name: str, **fields: object) -> dict[str, Any]:
        """Return the next event of that name with those fields, of a program that runs with `--json`."""
        wanted = {"event": name, **fields}

        def read(line: str) -> dict[str, Any] | None:
            with contextlib.suppress(ValueError):
                event: dict[str, Any] = json.loads(line)
                return event if wanted.items() <= event.items() else None
            return None

        return self._next(read, wanted)

    def wait_for_output_end(self, timeout_s: float) -> None:
        """Wait until nobody is left who may write there."""
        self._reader.join(timeout_s)
        assert not self._reader.is_alive(), "somebody holds the pipe"

    def _next(self, read: Callable[[str], T | None], wanted: object, timeout_s: float | None = None) -> T:
        ends_s = time.monotonic() + (self.patience_s if timeout_s is None else timeout_s)
        while True:
            try:
                line = self._queue.get(timeout=max(0.0, ends_s - time.monotonic()))
            except queue.Empty:
                line = None
            assert line is not None, f"{wanted!r} was not printed, but: {self.lines[-20:]}"
            found = read(line)
            if found is not None:
                return found

    def _read(self) -> None:
        assert self.process.stdout is not None
        with contextlib.suppress(OSError):  # a test may close this end
            for line in self.process.stdout:
                self.lines.append(line.rstrip())
                self._queue.put(self.lines[-1])
        self._queue.put(None)


class RunningRobot(TalkingProcess):
    """`chatrobot --json` in real time: console, Motion, guard and simulated robot, each a process."""

    def __init__(
        self,
        folder: Path,
        arguments: Sequence[str] = ("--json", "--world", "empty"),
        program: Sequence[str] = ("-m", "chatrobot"),
    ) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, *program, *arguments, "--config-dir", str(folder / "config")]
        environment = {**os.environ, "XDG_RUNTIME_DIR": str(folder), "PYTHONUNBUFFERED": "1"}
        super().__init__(command, environment, stderr=None)
        self.velocities = Heard()
        self._folder = folder / "chatrobot"
        self.wire_path = self._poll(lambda: next(self._folder.glob("sim-*.wire"), None))
        self.wire = self._poll(self._connect)
        self.wire.subscribe("cmd_vel", TwistMessage, self.velocities)
        marker = self._poll(lambda: next(self._folder.glob("motion-*.stop"), None))
        self.motion_pid = int(marker.stem.removeprefix("motion-"))

    def guard_pids(self) -> list[int]:
        """Return the processes of the guards on this robot's wire."""
        found = []
        for file in Path("/proc").glob("[0-9]*/cmdline"):
            with contextlib.suppress(OSError):  # it has ended
                words = file.read_text(encoding="utf-8", errors="replace")
                if "chatrobot.guard" in words and str(self.wire_path) in words:
                    found.append(int(file.parent.name))
        return found

    def close(self) -> None:
        """End what this started, frozen or not, and nothing else."""
        self.wire.close()
        for pid in (self.process.pid, self.motion_pid, *self.guard_pids()):
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)
                os.kill(pid, signal.SIGKILL)
        self.process.wait(PATIENCE_S)

    def _connect(self) -> LocalWire | None:
        with contextlib.suppress(WireError):  # the file may be there a moment before anybody listens at it
            return LocalWire(self.wire_path)
        return None

    def _poll(self, attempt: Callable[[], T | None]) -> T:
        ends_s = time.monotonic() + PATIENCE_S
        while time.monotonic() < ends_s and self.process.poll() is None:
            found = attempt()
            if found is not None:
                return found
            time.sleep(0.01)
        raise AssertionError(f"chatrobot did not start (exit code {self.process.poll()}): {self.lines[-20:]}")
