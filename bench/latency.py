"""From a typed line to the wire, measured at a subscriber in another process. Run: python -m bench.latency

Prints medians and 99th percentiles over many repetitions, and each as a ratio to one hop over the same wire (a
publisher and a subscriber in two processes with nothing between), so that figures of different machines compare.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.processes import RunningRobot

from bench import line
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage

REPETITIONS = 60


def in_hops(values_s: list[float], hop_s: float) -> str:
    """Return their median in hops over the same wire."""
    return f"{statistics.median(values_s) / hop_s:.1f} x"


def one_hop(folder: Path) -> list[float]:
    """A velocity from a process through the hub (a second process) and back."""
    path = folder / "hop.wire"
    serve = "import sys\nfrom chatrobot.wire.local import LocalHub\nhub = LocalHub(sys.argv[1])\nprint(flush=True)\n"
    hub = subprocess.Popen(
        [sys.executable, "-c", serve + "while True: hub.poll(1.0)", str(path)], stdout=subprocess.PIPE
    )
    assert hub.stdout is not None
    hub.stdout.readline()
    wire, heard = LocalWire(path), []
    wire.subscribe("cmd_vel", TwistMessage, lambda _: heard.append(time.monotonic()))
    took = []
    for _ in range(300):
        count, began_s = len(heard), time.monotonic()
        wire.publish("cmd_vel", TwistMessage(0.1, 0.0, 0.0))
        while len(heard) == count:
            time.sleep(0.0005)
        took.append(heard[-1] - began_s)
    wire.close()
    hub.kill()
    hub.wait()
    return took


def motion_and_stop(robot: RunningRobot) -> tuple[list[float], list[float]]:
    """Text to the first velocity, and stop to the first zero."""
    starts, stops = [], []
    for turn in range(1, 2 * REPETITIONS, 2):
        said_s = robot.say("forward 1 m")
        starts.append(robot.velocities.wait_for_motion(said_s) - said_s)
        said_s = robot.say("stop")
        stops.append(robot.velocities.wait_for_zero(said_s) - said_s)
        ended = {robot.wait_for_event("result")["turn"] for _ in range(2)}
        assert ended == {turn, turn + 1}
        time.sleep(0.3)  # the robot rolls out: new motion waits until it has been seen standing
        robot.velocities.all.clear()
    return starts, stops


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        hop = one_hop(folder)
        hop_s = statistics.median(hop)
        print(f"{'':62s} {'median':>11s} {'p99':>10s} {'x hop':>9s}")
        line("one hop over the same wire", hop, note=in_hops(hop, hop_s))
        robot = RunningRobot(folder / "robot")
        try:
            starts, stops = motion_and_stop(robot)
        finally:
            robot.close()
        line("one-step sentence -> first velocity at a subscriber", starts, note=in_hops(starts, hop_s))
        line("typed stop -> zero at a subscriber", stops, note=in_hops(stops, hop_s))


if __name__ == "__main__":
    main()
