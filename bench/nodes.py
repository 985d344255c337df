"""The three nodes on DDS, measured at a subscriber that is none of them. Run: python -m bench.nodes [REPETITIONS]

Text on `user_input` → first velocity, stop → zero, the latter with both cores busy too, and what all processes together
take while the robot moves. A machine that does other work meanwhile is slower: its load is printed beside.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
from tests.nodes.node_rig import NodeRig, running

from bench import line
from chatrobot.wire.messages import Text

REPETITIONS = 60
LOAD_S = 10.0


def machine() -> str:
    """How busy it is with whatever else."""
    return f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"


@contextlib.contextmanager
def busy_cores() -> Iterator[None]:
    """A process in an endless loop for each core."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(os.cpu_count() or 1)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def latencies(rig: NodeRig, repetitions: int) -> tuple[list[float], list[float]]:
    """Seconds from a one-step command to the first velocity, and from stop to the first zero."""
    starts, stops = [], []
    for _ in range(repetitions):
        said_s = rig.publish("user_input", Text("forward 1 m"))
        starts.append(rig.velocities.wait_for_motion(said_s) - said_s)
        said_s = rig.publish("user_input", Text("stop"))
        stops.append(rig.velocities.wait_for_zero(said_s) - said_s)
        rig.result(said_s, "Stopped.")
        rig.truth.wait_for(lambda odometry: abs(odometry.vx_mps) < 0.005, said_s)
        time.sleep(0.4)  # new motion waits until the robot has been seen standing
    return starts, stops


def ours(rig: NodeRig) -> dict[str, list[psutil.Process]]:
    """The nodes with the processes that they started."""
    found = {}
    for name, node in rig.nodes.items():
        process = psutil.Process(node.process.pid)
        found[name] = [process, *process.children(recursive=True)]
    return found


def load(rig: NodeRig) -> None:
    """CPU and memory of the nodes while the robot moves."""
    said_s = rig.publish("user_input", Text("forward 100 m at 0.3 m/s"))
    rig.velocities.wait_for_motion(said_s)
    groups = ours(rig)
    before = {process.pid: sum(process.cpu_times()[:2]) for group in groups.values() for process in group}
    time.sleep(LOAD_S)
    cpu_sum = pss_sum = 0.0
    for name, group in groups.items():
        cpu = sum(sum(process.cpu_times()[:2]) - before[process.pid] for process in group) / LOAD_S * 100.0
        pss_mb = sum(process.memory_full_info().pss for process in group) / 1e6
        cpu_sum, pss_sum = cpu_sum + cpu, pss_sum + pss_mb
        processes = f"{name} ({len(group)} process{'es' if len(group) > 1 else ''})"
        print(f"{processes:50s} {cpu:7.1f} %  {pss_mb:7.1f} MB", flush=True)
    total = f"{'all nodes while the robot moves':50s} {cpu_sum:7.1f} %  {pss_sum:7.1f} MB"
    print(f"{total}  (target 15 % of a core, 300 MB)  {machine()}", flush=True)
    rig.publish("user_input", Text("stop"))


def main() -> None:
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else REPETITIONS
    with tempfile.TemporaryDirectory() as folder, running(Path(folder)) as rig:
        rig.do("turn left 5 degrees")
        print(f"{'':50s} {'median':>10s} {'p99':>10s}")
        starts, stops = latencies(rig, repetitions)
        line("text on user_input -> first velocity", starts, (0.005, 0.015), machine())
        line("stop on user_input -> zero", stops, (0.003, 0.010), machine())
        load(rig)
        with busy_cores():
            _, stops = latencies(rig, repetitions)
        line("the stop, both cores busy", stops, (0.020, 0.050), machine())


if __name__ == "__main__":
    main()
