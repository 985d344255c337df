"""Stop, typed as a person would, to the zero at a foreign subscriber on DDS. Run: python -m bench.stopping

During a plan; during a flood of texts on `user_input`; while the process that understands is busy, and while it is
frozen. "stop" and 停 take turns. Promised: 20 ms at the median, 50 ms at p99.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from tests.nodes.node_rig import NodeRig, running

from bench import line

REPETITIONS = 50
WORDS = ("stop", "停")
FLOOD_HZ = 200
PROMISED_S = (0.020, 0.050)

_FLOOD = """
import sys, time
from chatrobot.core.wiring import Wiring
from chatrobot.wire.discovery import Discovery
from chatrobot.wire.dds.wire import DdsWire
from chatrobot.wire.messages import Text
wire = DdsWire(Wiring(), "flood", discovery=Discovery(domain_id=int(sys.argv[1])))
wire.advertise("user_input", Text)
wire.wait_for_listener("user_input", Text, 20.0, 2)
while True:
    wire.publish("user_input", Text(sys.argv[2]))
    time.sleep(1.0 / float(sys.argv[3]))
"""
LONG = "go forward one metre, then turn left ninety degrees, then " * 20 + "stop for two seconds"
"""Hard to understand, and no stop: 20 times a second keep the understanding process busy."""


@contextlib.contextmanager
def flooded(rig: NodeRig, text: str, rate_hz: float) -> Iterator[None]:
    """Somebody else publishes that text at that rate."""
    flood = subprocess.Popen(
        [sys.executable, "-c", _FLOOD, str(rig.domain), text, str(rate_hz)], env=rig.environment
    )
    time.sleep(1.5)
    try:
        yield
    finally:
        flood.kill()
        flood.wait()


def once(rig: NodeRig, word: str, freeze: bool) -> float:
    """Seconds from the typed word to the first zero."""
    said_s = rig.nodes["input"].say("forward 1 m")
    rig.velocities.wait_for(lambda twist: twist.vx_mps > 0.15, said_s)
    base = rig.nodes["base"].process.pid
    if freeze:
        os.kill(base, signal.SIGSTOP)
    said_s = rig.nodes["input"].say(word)
    took_s = rig.velocities.wait_for_zero(said_s) - said_s
    if freeze:
        time.sleep(0.05)
        os.kill(base, signal.SIGCONT)
    rig.truth.wait_for(lambda odometry: abs(odometry.vx_mps) < 0.005, said_s)
    time.sleep(0.6)  # new motion waits until the robot has been seen standing
    return took_s


def flooded_once(rig: NodeRig, word: str) -> float:
    """While a flood pours in, the plan comes from outside the queue of texts: as plan text of a foreigner."""
    from chatrobot.wire.messages import Text

    said_s = rig.publish("chatgpt_node", Text("drive forward 1 m"))
    rig.velocities.wait_for(lambda twist: twist.vx_mps > 0.15, said_s)
    said_s = rig.nodes["input"].say(word)
    took_s = rig.velocities.wait_for_zero(said_s) - said_s
    rig.truth.wait_for(lambda odometry: abs(odometry.vx_mps) < 0.005, said_s)
    time.sleep(0.4)
    return took_s


def main() -> None:
    print(f"{'typed stop or 停 -> zero at a foreign subscriber':62s} {'median':>11s} {'p99':>10s}")
    words = [WORDS[i % 2] for i in range(REPETITIONS)]
    with tempfile.TemporaryDirectory() as folder, running(Path(folder)) as rig:
        rig.do("turn left 5 degrees")
        kept = [line("during a plan", [once(rig, word, freeze=False) for word in words], PROMISED_S)]
        kept.append(
            line(
                "the understanding process frozen (SIGSTOP)",
                [once(rig, word, freeze=True) for word in words],
                PROMISED_S,
            )
        )
    for name, text, rate_hz in (
        (f"a flood of {FLOOD_HZ} questions a second on user_input", "where are you?", FLOOD_HZ),
        ("the understanding process busy with long texts", LONG, 20.0),
    ):
        with tempfile.TemporaryDirectory() as folder, running(Path(folder)) as rig:
            rig.do("turn left 5 degrees")
            with flooded(rig, text, rate_hz):
                kept.append(line(name, [flooded_once(rig, word) for word in words], PROMISED_S))
    print("promises kept" if all(kept) else "BROKEN: is this machine busy with something else?")


if __name__ == "__main__":
    main()
