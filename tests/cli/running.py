"""The `chatrobot` command with folders of its own, as other programs run it: in this process, which is ten times as
fast, or in one of its own where the process is what counts: its start, its signals, its end, real time."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any
from unittest.mock import patch

import pytest

from chatrobot.cli.entry import main

PATIENCE_S = 60.0


@dataclass(frozen=True)
class Done:
    """What a finished command left."""

    code: int
    out: str
    err: str

    @property
    def events(self) -> list[dict[str, Any]]:
        """Every line of its output as JSON: one that is not makes this fail."""
        return [json.loads(line) for line in self.out.splitlines()]

    def named(self, name: str) -> list[dict[str, Any]]:
        return [event for event in self.events if event["event"] == name]


def environment(folder: Path) -> dict[str, str]:
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("CHATROBOT_", "XDG_"))}
    return {**kept, "XDG_RUNTIME_DIR": str(folder), "XDG_CONFIG_HOME": str(folder / "config")}


def as_bytes(text: str | bytes) -> bytes:
    return text if isinstance(text, bytes) else text.encode()


def done(code: int, out: bytes, err: bytes) -> Done:
    assert b"Traceback" not in err, err.decode()
    return Done(code, out.decode(), err.decode())


def exit_code_of(arguments: Sequence[str]) -> int:
    """Of a whole run of the command."""
    try:
        return main(arguments)
    except SystemExit as end:  # of `--help`
        return int(end.code or 0)


@contextlib.contextmanager
def standard_streams(files: Sequence[IO[bytes]]) -> Iterator[None]:
    """In place of this process's own: their descriptors, which threads read, and Python's streams on top."""
    names = ("stdin", "stdout", "stderr")
    for name in names[1:]:
        getattr(sys, name).flush()
    kept = [os.dup(number) for number in range(3)]
    for number, file in enumerate(files):
        os.dup2(file.fileno(), number)
    ours = [os.fdopen(number, mode, encoding="utf-8", closefd=False) for number, mode in enumerate("rww")]
    try:
        with patch.multiple(sys, **dict(zip(names, ours))):
            yield
    finally:
        for number, (stream, descriptor) in enumerate(zip(ours, kept)):
            stream.close()
            os.dup2(descriptor, number)
            os.close(descriptor)


class Command:
    """Runs `chatrobot` in a folder of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __call__(self, *arguments: str, stdin: str | bytes = "") -> Done:
        """Run it to its end in this process."""
        with contextlib.ExitStack() as files:
            streams = [files.enter_context(tempfile.TemporaryFile()) for _ in range(3)]
            streams[0].write(as_bytes(stdin))
            streams[0].seek(0)
            with patch.dict(os.environ, environment(self.folder), clear=True), standard_streams(streams):
                code = exit_code_of(arguments)
            for stream in streams:
                stream.seek(0)
            _, out, err = (stream.read() for stream in streams)
        return done(code, out, err)

    def apart(self, *arguments: str, stdin: str | bytes = "") -> Done:
        """Run it to its end in a process of its own."""
        run = subprocess.run(
            [sys.executable, "-m", "chatrobot", *arguments],
            input=as_bytes(stdin),
            capture_output=True,
            env=environment(self.folder),
            timeout=PATIENCE_S,
        )
        return done(run.returncode, run.stdout, run.stderr)

    def start(self, *arguments: str) -> Running:
        return Running([sys.executable, "-m", "chatrobot", *arguments], self.folder)


class Running:
    """A command that runs on; its output is read line by line, its input is a pipe."""

    def __init__(self, command: list[str], folder: Path) -> None:
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment(folder),
            text=True,
        )
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self.seen: list[dict[str, Any]] = []
        threading.Thread(target=self._read, daemon=True).start()

    def __enter__(self) -> Running:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.kill()
            self.process.wait(PATIENCE_S)
        for stream in (self.process.stdin, self.process.stderr):
            assert stream is not None
            if stream is self.process.stderr:
                assert "Traceback" not in stream.read()
            with contextlib.suppress(BrokenPipeError):
                stream.close()

    def say(self, text: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def event(self, name: str, wanted: Callable[[dict[str, Any]], bool] = lambda _: True) -> dict[str, Any]:
        """The next JSON event of that name for which `wanted` holds."""
        while (line := self._lines.get(timeout=PATIENCE_S)) is not None:
            event = json.loads(line)
            self.seen.append(event)
            if event["event"] == name and wanted(event):
                return dict(event)
        raise AssertionError(f"it ended without {name}: {self.seen}")

    def end(self) -> int:
        """Its exit code; what it still printed is in `seen`."""
        assert self.process.stdin is not None
        self.process.stdin.close()
        while (line := self._lines.get(timeout=PATIENCE_S)) is not None:
            self.seen.append(json.loads(line))
        return self.process.wait(PATIENCE_S)

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._lines.put(line)
        self._lines.put(None)


@pytest.fixture
def chatrobot(tmp_path: Path) -> Command:
    return Command(tmp_path)
