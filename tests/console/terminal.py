"""A terminal for tests: a program in a pty whose screen is kept by pyte. Waits for text, never for time."""

from __future__ import annotations

import os
import re
import signal
import sys
import tempfile
import time
from pathlib import Path
from types import TracebackType

import pexpect
import pyte

ROOT = Path(__file__).resolve().parents[2]
TIMEOUT_S = 20.0
LEAVING_S = 5.0


class _Screen(pyte.HistoryScreen):
    """Answers what programs ask a terminal."""

    child: pexpect.spawn | None = None

    def write_process_input(self, data: str) -> None:
        if self.child is not None:
            self.child.send(data)


class Terminal:
    """Runs `arguments` (default: the console) on a screen of `columns` by `rows`."""

    def __init__(
        self,
        arguments: list[str],
        *,
        columns: int = 100,
        rows: int = 40,
        environment: dict[str, str] | None = None,
    ) -> None:
        self.screen = _Screen(columns, rows, history=2000, ratio=0.5)
        self._stream = pyte.ByteStream(self.screen)
        source = str(ROOT / "src")
        self._runtime = tempfile.TemporaryDirectory(prefix="chat", ignore_cleanup_errors=True)
        env = {
            **{
                name: value
                for name, value in os.environ.items()
                if name not in ("NO_COLOR", "COLUMNS", "LINES")
            },
            "TERM": "xterm-256color",
            "LANG": "C.UTF-8",
            "LC_ALL": "C.UTF-8",
            "PYTHONPATH": source,
            "XDG_RUNTIME_DIR": self._runtime.name,  # nobody else's `chatrobot stop` reaches us
            **(environment or {}),
        }
        self.child = pexpect.spawn(
            arguments[0], arguments[1:], dimensions=(rows, columns), env=env, timeout=TIMEOUT_S
        )
        self.child.delaybeforesend = None
        self.screen.child = self.child
        self.raw = b""

    def __enter__(self) -> Terminal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number in (signal.SIGHUP, signal.SIGCONT):
            self.child.kill(number)
        until_s = time.monotonic() + LEAVING_S
        while self.child.isalive() and time.monotonic() < until_s:
            self.look(0.05)  # what nobody reads would hold it up
            time.sleep(0.01)
        if self.child.isalive():
            self.child.kill(signal.SIGKILL)
            self.child.wait()
        self.child.close()
        self._runtime.cleanup()

    # --- typing ---

    def type(self, text: str | bytes) -> None:
        self.child.send(text)

    def enter(self, text: str) -> None:
        self.child.send(f"{text}\r")

    def control(self, letter: str) -> None:
        self.child.sendcontrol(letter)

    def resize(self, rows: int, columns: int) -> None:
        self.screen.resize(rows, columns)
        self.child.setwinsize(rows, columns)

    def forget(self) -> None:
        """Begin with an empty line on an empty screen, which the program draws anew."""
        self.control("u")
        until_s = time.monotonic() + TIMEOUT_S
        while self.shown[0] != "›" or any(self.shown[1:-1]):
            assert time.monotonic() < until_s, f"it keeps its screen:\n{self.text}"
            self.control("l")  # again where something was printed after the last
            self.look(0.2)
        self.screen.history.top.clear()

    # --- seeing ---

    @property
    def shown(self) -> list[str]:
        """The lines on the screen now."""
        return [line.rstrip() for line in self.screen.display]

    @property
    def text(self) -> str:
        """All that was ever printed and is still in the scroll-back, and the screen."""
        above = (
            "".join(line[x].data for x in range(self.screen.columns)) for line in self.screen.history.top
        )
        return "\n".join([*(line.rstrip() for line in above), *self.shown])

    def look(self, timeout_s: float = 0.0) -> bool:
        """Take in what has arrived, waiting for something at most so long; False at the program's end."""
        try:
            data = self.child.read_nonblocking(65536, timeout_s)
        except pexpect.TIMEOUT:
            return True
        except pexpect.EOF:
            return False
        self.raw += data
        self._stream.feed(data)
        return True

    def wait_for(self, pattern: str, timeout_s: float = TIMEOUT_S, times: int = 1) -> str:
        """Until `pattern` (a regular expression) is in the text so often; the text."""
        until_s = time.monotonic() + timeout_s
        while len(re.findall(pattern, self.text)) < times:
            alive = self.look(0.1)
            if not alive or time.monotonic() > until_s:
                if len(re.findall(pattern, self.text)) >= times:
                    break
                raise AssertionError(
                    f"no {pattern!r} ({'waited' if alive else 'the program ended'}):\n{self.text}"
                )
        return self.text

    def wait_for_end(self, timeout_s: float = TIMEOUT_S) -> int:
        """Until the program has ended; its exit code."""
        until_s = time.monotonic() + timeout_s
        while self.look(0.1):
            assert time.monotonic() < until_s, f"it does not end:\n{self.text}"
        self.child.wait()
        return int(
            self.child.exitstatus if self.child.exitstatus is not None else -(self.child.signalstatus or 0)
        )


def console(folder: Path, *options: str, columns: int = 100, rows: int = 40,
            environment: dict[str, str] | None = None) -> Terminal:  # fmt: skip
    """`chatrobot` without a command, with its files in `folder`."""
    arguments = [sys.executable, "-m", "chatrobot", "--config-dir", str(folder), *options]
    return Terminal(arguments, columns=columns, rows=rows, environment=environment)
