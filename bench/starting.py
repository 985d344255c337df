"""How soon a session is ready, from a fresh process. Run: python -m bench.starting [RUNS]

From the start of `chatrobot do` to the first velocity at a subscriber in another process, and from the start of
`chatrobot` at a terminal to its prompt; in real time, with the robot's, Motion's and the guard's processes. Each run is
paired with a bare `python -c pass`, so that the ratio holds on another machine. Promised: 1 s at the median on two
idle cores.
"""

from __future__ import annotations

import contextlib
import os
import pty
import select
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

from bench import percentile
from chatrobot.core.errors import WireError
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage

RUNS = 20
MEDIAN_S = 1.0
PATIENCE_S = 60.0
LOOK_S = 0.002
COMMAND = (sys.executable, "-m", "chatrobot", "--world", "home")


def environment(folder: Path) -> dict[str, str]:
    return {
        **os.environ,
        "XDG_RUNTIME_DIR": str(folder), "XDG_CONFIG_HOME": str(folder), "TERM": "xterm-256color", "LANG": "C.UTF-8",
    }  # fmt: skip


def bare(_: Path) -> float:
    """Python itself."""
    began_s = time.monotonic()
    subprocess.run([sys.executable, "-c", "pass"], check=True)
    return time.monotonic() - began_s


def first_velocity(folder: Path) -> float:
    """Seconds from the start of `chatrobot do` until its first velocity is heard here."""
    began_s = time.monotonic()
    said = [*COMMAND, "do", "forward 0.1 m"]
    with subprocess.Popen(
        said, env=environment(folder), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE
    ) as process:
        wire = _wire_in(folder / "chatrobot", began_s + PATIENCE_S)
        heard = threading.Event()
        heard_s: list[float] = []

        def hear(twist: TwistMessage) -> None:
            if any(twist) and not heard_s:
                heard_s.append(time.monotonic())
                heard.set()

        wire.subscribe("cmd_vel", TwistMessage, hear)
        if not heard.wait(PATIENCE_S):
            raise RuntimeError("no velocity was heard")
        process.communicate()
        wire.close()
    return heard_s[0] - began_s


def _wire_in(folder: Path, until_s: float) -> LocalWire:
    """The simulated robot's wire, as soon as it is there."""
    while time.monotonic() < until_s:
        for path in folder.glob("sim-*.wire"):
            with contextlib.suppress(WireError):
                return LocalWire(path)
        time.sleep(LOOK_S)
    raise RuntimeError("no simulated robot has come up")


def prompt(folder: Path) -> float:
    """Seconds from the start of `chatrobot` at a terminal until it can be typed to."""
    ours, theirs = pty.openpty()
    began_s = time.monotonic()
    process = subprocess.Popen(
        COMMAND, env=environment(folder), stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True
    )
    os.close(theirs)
    try:
        return _seen(ours, "\N{SINGLE RIGHT-POINTING ANGLE QUOTATION MARK}".encode(), began_s) - began_s
    finally:
        os.write(ours, b"\x04")
        drain = threading.Thread(target=_drain, args=(ours,), daemon=True)
        drain.start()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(10.0)
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        os.close(ours)


def _seen(terminal: int, mark: bytes, began_s: float) -> float:
    """When that has been written to the terminal."""
    written = b""
    while time.monotonic() < began_s + PATIENCE_S:
        if select.select([terminal], [], [], 0.1)[0]:
            written += os.read(terminal, 65_536)
            if b"\x1b[6n" in written:  # it asks where its cursor is
                os.write(terminal, b"\x1b[1;1R")
                written = written.replace(b"\x1b[6n", b"")
            if mark in written:
                return time.monotonic()
    raise RuntimeError(f"no prompt: {written!r}")


def _drain(terminal: int) -> None:
    with contextlib.suppress(OSError):
        while os.read(terminal, 65_536):
            pass


def measured(what: Callable[[Path], float], runs: int) -> tuple[list[float], list[float]]:
    """Seconds of each run, and how often as long as a bare python beside it."""
    took_s, ratios = [], []
    for _ in range(runs):
        with tempfile.TemporaryDirectory() as folder:
            took_s.append(what(Path(folder)))
            ratios.append(took_s[-1] / bare(Path(folder)))
    return took_s, ratios


def main() -> int:
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else RUNS
    print(f"{'':34s} {'median':>9s} {'p99':>9s} {'x python':>9s}   (load {os.getloadavg()[0]:.1f})")
    is_kept = True
    for name, what in (("first velocity of `do`", first_velocity), ("prompt of the console", prompt)):
        took_s, ratios = measured(what, runs)
        median_s = statistics.median(took_s)
        is_kept = is_kept and median_s <= MEDIAN_S
        print(
            f"{name:34s} {median_s * 1e3:6.0f} ms {percentile(took_s, 0.99) * 1e3:6.0f} ms"
            f" {statistics.median(ratios):8.1f}x"
        )
    return 0 if is_kept else 1


if __name__ == "__main__":
    sys.exit(main())
