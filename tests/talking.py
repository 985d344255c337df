"""What tests share that talk to other processes: messages as they come, and a process whose output is read."""

from __future__ import annotations

import queue
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

PATIENCE_S = 30.0


class Heard:
    """Messages of one topic with the time they came. `patience_s`: how long one that is wanted is waited for."""

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
        """The first wanted message since then."""
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
        return [entry for entry in tuple(self.all) if entry[0] >= since_s]


class TalkingProcess:
    """A process in a session of its own; its standard input is a pipe, its output is read."""

    patience_s = PATIENCE_S
    """How long a line that is wanted is waited for."""

    def __init__(self, arguments: Sequence[str], environment: Mapping[str, str]) -> None:
        self.process = subprocess.Popen(
            arguments,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=dict(environment),
            start_new_session=True,
            text=True,
        )
        self.lines: list[str] = []
        self._queue: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def wait_for_line(self, part: str, timeout_s: float | None = None) -> str:
        ends_s = time.monotonic() + (self.patience_s if timeout_s is None else timeout_s)
        while True:
            try:
                line = self._queue.get(timeout=max(0.0, ends_s - time.monotonic()))
            except queue.Empty:
                line = None
            assert line is not None, f"{part!r} was not said: {self.lines}"
            if part in line:
                return line

    def wait_for_output_end(self, timeout_s: float) -> None:
        """Until nobody is left who may write there."""
        self._reader.join(timeout_s)
        assert not self._reader.is_alive(), "somebody holds the pipe"

    def say(self, line: str) -> float:
        assert self.process.stdin is not None
        now_s = time.monotonic()
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()
        return now_s

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.lines.append(line.rstrip())
            self._queue.put(line)
        self._queue.put(None)
