"""A Ctrl-C that is sent twice, as `ros2 launch` does it, is one; a later one quits at once."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import pytest

WATCHING = """
import signal, sys, time
from chatrobot.cli.signals import SignalWatch

with SignalWatch(lambda why: print(why, flush=True), repeats_s={repeats_s}) as watch:
    print("watches", flush=True)
    while not watch.is_leaving:
        time.sleep(0.01)
    time.sleep(0.6)
print("left", flush=True)
time.sleep(0.3)
"""


def watching(repeats_s: float) -> subprocess.Popen[str]:
    code = WATCHING.format(repeats_s=repeats_s)
    process = subprocess.Popen(
        [sys.executable, "-c", code], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "watches\n"
    return process


@pytest.mark.parametrize("pauses_s", [(0.0,), (0.3,), (0.3, 0.45)])
def test_what_comes_again_so_soon_is_the_same_one(pauses_s: tuple[float, ...]) -> None:
    """The last of them comes after the watch."""
    process = watching(repeats_s=2.0)
    process.send_signal(signal.SIGINT)
    for pause_s in pauses_s:
        time.sleep(pause_s)
        process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20.0)
    assert (out, err, process.returncode) == ("Ctrl-C\nleft\n", "", 0)


def test_a_later_one_quits_at_once() -> None:
    process = watching(repeats_s=0.1)
    process.send_signal(signal.SIGINT)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=20.0)
    assert (out, process.returncode) == ("Ctrl-C\n", 130)


def test_at_the_console_the_second_one_quits_at_once() -> None:
    process = watching(repeats_s=0.0)
    process.send_signal(signal.SIGINT)
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=20.0)
    assert (out, process.returncode) == ("Ctrl-C\n", 130)
