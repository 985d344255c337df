"""A program that runs in the sandbox, as the host sees it, and its output, which is never in anybody's way."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import socket
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from chatrobot.core.reason import Reason
from chatrobot.sandbox.libc import pidfd_send_signal
from chatrobot.sandbox.limits import SandboxLimits, receive_message

_CHUNK_BYTES = 1 << 16
_FLOOD_PAUSE_S = 0.01
"""Once the limit is reached, 64 KB each 10 ms: whoever floods waits, and nobody else."""

_SILENCED = dict.fromkeys(
    [code for code in range(0xA0) if (code < 0x20 or code >= 0x7F) and chr(code) not in "\n\t"]
    # What turns the direction of writing around, so that a line reads otherwise than it is.
    + [*range(0x202A, 0x202F), *range(0x2066, 0x206A)]
)


class LogDrain:
    """Reads a pipe on a thread of its own until its writer is gone.

    Args:
        descriptor: reading end; closed here.
        limit_bytes: most that is kept until somebody takes it.
    """

    def __init__(self, descriptor: int, limit_bytes: int) -> None:
        self._descriptor = descriptor
        self._limit_bytes = limit_bytes
        self._lock = threading.Lock()
        self._kept = bytearray()
        self._dropped_bytes = 0
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin to read."""
        self._thread = threading.Thread(target=self._drain, name="sandbox log", daemon=True)
        self._thread.start()

    def take(self) -> str:
        """Return what is new. Bytes that are no UTF-8 are replaced; a character that came in half waits for its rest.

        Control characters are left out: this is shown on terminals, which obey them.
        """
        with self._lock:
            whole = _whole_characters(self._kept)
            text = self._kept[:whole].decode("utf-8", "replace")
            del self._kept[:whole]
            dropped, self._dropped_bytes = self._dropped_bytes, 0
        return text.translate(_SILENCED) + (f"\n[… {dropped} bytes more]\n" if dropped else "")

    def finish(self, timeout_s: float) -> None:
        """Wait for the last words of a writer that is gone."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def close(self) -> None:
        """Let go of the pipe; the thread ends when the writer is gone, at once if it never began."""
        if self._thread is None:
            os.close(self._descriptor)

    def _drain(self) -> None:
        while chunk := os.read(self._descriptor, _CHUNK_BYTES):
            with self._lock:
                room = max(0, self._limit_bytes - len(self._kept))
                self._kept += chunk[:room]
                self._dropped_bytes += len(chunk) - min(room, len(chunk))
                is_flood = room < len(chunk)
            if is_flood:
                time.sleep(_FLOOD_PAUSE_S)
        os.close(self._descriptor)


def _whole_characters(data: bytearray) -> int:
    """Return how many bytes there are before a character that is not whole yet."""
    for back in range(1, min(4, len(data)) + 1):
        byte = data[-back]
        if byte >= 0xC0:
            needed = 2 if byte < 0xE0 else 3 if byte < 0xF0 else 4
            return len(data) - back if needed > back else len(data)
        if byte < 0x80:
            break
    return len(data)


LAST_WORDS_S = 0.2
"""The pipe is read to its end in far less."""


@dataclass(frozen=True)
class ExitReport:
    """The end of a program.

    Args:
        exit_code: what it exited with (1 after an exception); None if a signal ended it.
        signal: the signal that ended it, or None.
        reason: why it was ended, or None if it ended by itself.
        findings: what it tried that the sandbox does not allow; hints for a person, no proof.
    """

    exit_code: int | None
    signal: int | None
    reason: Reason | None
    findings: tuple[Reason, ...] = ()


class SandboxedProcess:
    """A running program. Close it, or leave its `with`, and it is gone.

    Args:
        channel: the host's end of the STREAM socket pair whose other end the program got.
        log: reading end of the pipe that is its output.
        report: the line on which the warm server tells of its end.
        limits: those it was launched with.
    """

    def __init__(
        self, channel: socket.socket, log_fd: int, report: socket.socket, limits: SandboxLimits
    ) -> None:
        self.channel = channel
        self.pid = 0
        self._report = report
        self._limits = limits
        self._logs = LogDrain(log_fd, limits.log_bytes)
        self._pidfd: int | None = None
        self._was_killed = False
        self._ended: ExitReport | None = None

    def wait_until_started(self, timeout_s: float) -> str:
        """Block until the fork is made. Returns the problem, or "" if there is none."""
        self._report.settimeout(timeout_s)
        try:
            said, _, descriptors = receive_message(self._report)
        except (EOFError, OSError) as error:
            return str(error) or "the warm server is gone"
        if said["event"] != "started":
            return str(said["problem"])
        self._pidfd = descriptors[0] if descriptors else None
        self.pid = said["pid"] if self._pidfd is None else _pid_of(self._pidfd)
        self._logs.start()
        return ""

    def read_logs(self) -> str:
        """Return what it printed since the last call. Of a flood, what was kept and how much was not."""
        return self._logs.take()

    def kill(self) -> None:
        """End it now. Nothing that a program does delays this; it never blocks."""
        self._was_killed = True
        with contextlib.suppress(OSError):
            if self._pidfd is not None:
                pidfd_send_signal(self._pidfd, signal.SIGKILL)
            else:
                self._report.send(b"kill", socket.MSG_NOSIGNAL | socket.MSG_DONTWAIT)

    def wait(self, timeout_s: float | None = None) -> ExitReport | None:
        """Block until it has ended, or the time is over: then None."""
        ends_s = None if timeout_s is None else time.monotonic() + timeout_s
        while self._ended is None:
            left_s = None if ends_s is None else max(0.0, ends_s - time.monotonic())
            if not _is_readable(self._report, left_s):
                return None
            self._ended = self._hear_the_end()
            self._logs.finish(LAST_WORDS_S)
        return self._ended

    def close(self) -> None:
        """Kill it if it still runs, and let go of everything."""
        if self._ended is None:
            self.kill()
        self.channel.close()
        self._report.close()
        self._logs.close()
        if self._pidfd is not None:
            os.close(self._pidfd)
            self._pidfd = None

    def __enter__(self) -> SandboxedProcess:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _hear_the_end(self) -> ExitReport:
        try:
            said, _, _ = receive_message(self._report)
        except (EOFError, OSError):
            # The kernel kills the children of a warm server that dies.
            return ExitReport(None, signal.SIGKILL, Reason("box_server_lost"))
        return ExitReport(
            exit_code=said["exit_code"],
            signal=said["signal"],
            reason=self._why(said),
            findings=tuple(_finding(kind) for kind in said["tried"]),
        )

    def _why(self, said: Mapping[str, Any]) -> Reason | None:
        ended_by, limits = said["signal"], self._limits
        if said["was_too_long"] and limits.wall_s is not None:
            return Reason("box_lasted_too_long", {"limit_s": limits.wall_s})
        if ended_by == signal.SIGXCPU or (ended_by == signal.SIGKILL and said["cpu_s"] >= limits.cpu_s):
            return Reason("box_used_too_much_time", {"limit_s": limits.cpu_s})
        if self._was_killed and ended_by == signal.SIGKILL:
            return Reason("box_killed")
        if ended_by == signal.SIGSYS:
            return Reason("box_forbidden")
        if "memory" in said["tried"] and said["exit_code"] != 0:
            return Reason("box_used_too_much_memory", {"limit_mb": limits.memory_bytes >> 20})
        if ended_by is not None:
            return Reason("box_crashed", {"signal": signal.Signals(ended_by).name})
        return None


def _finding(kind: str) -> Reason:
    return {
        "files": Reason("box_tried_files"),
        "network": Reason("box_tried_network"),
        "processes": Reason("box_tried_processes"),
        "signals": Reason("box_tried_signals"),
        "native": Reason("box_tried_native"),
        "memory": Reason("box_tried_memory"),
        "threads": Reason("box_tried_threads"),
    }[kind]


def _is_readable(line: socket.socket, timeout_s: float | None) -> bool:
    waiting = select.poll()
    waiting.register(line, select.POLLIN)
    return bool(waiting.poll(None if timeout_s is None else timeout_s * 1000))


def _pid_of(pidfd: int) -> int:
    """The number of the process in our own world, whatever it is called in its own."""
    with open(f"/proc/self/fdinfo/{pidfd}", encoding="ascii") as lines:
        return next(int(line.split()[1]) for line in lines if line.startswith("Pid:"))
