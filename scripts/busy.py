"""Drives the three nodes on DDS beside busy processes, kills and freezes each, and prints the figures. Run: make busy

Each motion is a line of the tutorial's form: one second. The robot is the simulated one in a process of its own.

python -m scripts.busy --motions 200 --busy 8
"""

from __future__ import annotations

import argparse
import itertools
import os
import sys
import tempfile
from pathlib import Path

from tests.nodes.busy import BUSY, TUTORIAL_LINES, Driven, busy_processes, drive_line, freeze, kill
from tests.nodes.node_rig import running

PROMISE_S = 0.25
MOTIONS, TIMES = 200, 4
FROZEN = ("base", "input", "control", "robot's end")
KILLED = ("input", "base", "control", "guard", "robot's end")


def motions(count: int, busy: int) -> list[Driven]:
    """Lines one after the other, with a freeze of each process in between."""
    driven: list[Driven] = []
    with tempfile.TemporaryDirectory() as folder, running(Path(folder)) as rig, busy_processes(busy):
        for line in itertools.islice(itertools.cycle(TUTORIAL_LINES), count):
            driven.append(drive_line(rig, line))
            if driven[-1].problems or driven[-1].is_halted:
                print(driven[-1], flush=True)
    return driven


def blows(times: int, busy: int) -> dict[str, list[float]]:
    """Seconds to zero of each kill and freeze; a kill takes a fresh set of processes."""
    took_s: dict[str, list[float]] = {}
    for _, killed in itertools.product(range(times), KILLED):
        with tempfile.TemporaryDirectory() as folder, running(Path(folder)) as rig, busy_processes(busy):
            for whom in FROZEN if killed == KILLED[0] else ():
                took_s.setdefault(f"SIGSTOP of {whom}", []).append(freeze(rig, whom))
            took_s.setdefault(f"kill -9 of {killed}", []).append(kill(rig, killed))
    return took_s


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--motions", type=int, default=MOTIONS)
    parser.add_argument("--times", type=int, default=TIMES, help="blows of each kind")
    parser.add_argument("--busy", type=int, default=BUSY, help="processes that never wait")
    options = parser.parse_args(arguments)
    driven = motions(options.motions, options.busy)
    load, failed = os.getloadavg()[0], sum(bool(one.problems) or one.is_halted for one in driven)
    late_s = [one.late_s for one in driven if one.late_s]
    print(f"{len(driven)} motions beside {options.busy} busy processes (load {load:.0f}): {failed} failed,")
    print(f"  {len(late_s)} slowed by a late heartbeat, at most {max(late_s, default=0.0):.2f} s late")
    took_s = blows(options.times, options.busy)
    for name, times in took_s.items():
        print(f"{name:26s} worst of {len(times)}: {max(times) * 1e3:4.0f} ms")
    worst_s = max(itertools.chain(*took_s.values()), default=0.0)
    return 0 if failed == 0 and worst_s <= PROMISE_S else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
