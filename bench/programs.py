"""How quick programs are rehearsed, and how soon they drive. Run: python -m bench.programs

All through the warm server and the sandbox, in the furnished home. Wall times; a busy machine shows in them, so the
processor time of both processes stands beside.
"""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from chatrobot.motion.programs.rehearsal import rehearse_program
from chatrobot.programs.events import TwistAsked
from chatrobot.programs.pipe import ProgramSettings, robot_topics
from chatrobot.programs.sandboxed import SandboxedProgram, warm_server
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer
from chatrobot.sim.load import load_world

PROGRAMS = Path(__file__).parents[1] / "tests" / "programs" / "programs"
REPETITIONS = 25
REHEARSED = {
    "rehearsal: the tutorial's square, 21 s": "tutorial_square",
    "rehearsal: the tutorial's turn, 6 s at 10 Hz": "tutorial_rotate",
    "rehearsal: busy waiting, 2 s": "busy_wait_on_time",
    "rehearsal: busy waiting, 60 s": "busy_wait_on_time",
    "rehearsal: odometry, 1 m": "odometry_one_metre",
    "rehearsal: lidar, until a wall": "stop_before_the_wall",
}


def median_ms(work: Callable[[], float]) -> tuple[float, float, float]:
    """Wall median and worst, and the median of this process's own time."""
    walls, own = [], []
    for _ in range(REPETITIONS):
        began_s = time.process_time()
        walls.append(work() * 1e3)
        own.append((time.process_time() - began_s) * 1e3)
    return statistics.median(walls), max(walls), statistics.median(own)


def first_velocity_s(server: WarmServer, source: str) -> float:
    """From the launch of a live program to the first velocity it asks for, as its host hears it."""
    topics = robot_topics(load_profile("wheeltec_mini_mec").wiring)
    program = SandboxedProgram(server, ProgramSettings(source, mode="live", topics=topics))
    began_s = time.monotonic()
    program.start()
    while not any(isinstance(event, TwistAsked) for event in program.poll(1.0)):
        pass
    took_s = time.monotonic() - began_s
    program.close()
    return took_s


def main() -> None:
    profile, world = load_profile("wheeltec_mini_mec"), load_world("home")
    world.clearance_m(np.zeros((1, 2)))
    print(f"{'load ' + str(os.getloadavg()[0]):46s} {'median':>10s} {'max':>10s} {'own time':>10s}")
    began_s = time.monotonic()
    with warm_server() as server:
        server.start()
        print(f"{'warm server, once':46s} {(time.monotonic() - began_s) * 1e3:7.1f} ms", flush=True)
        sources = {
            name: (PROGRAMS / f"{file}.py").read_text(encoding="utf-8") for name, file in REHEARSED.items()
        }
        sources["rehearsal: busy waiting, 60 s"] = sources["rehearsal: busy waiting, 2 s"].replace(
            "2.0", "59.0"
        )
        square = sources["rehearsal: the tutorial's square, 21 s"]
        rows: dict[str, Callable[[], float]] = {
            "launch to first velocity": lambda: first_velocity_s(server, square)
        }
        for name, source in sources.items():
            rows[name] = lambda source=source: rehearse_program(server, source, profile, world).wall_s  # type: ignore[misc]
        for name, work in rows.items():
            wall, worst, own = median_ms(work)
            print(f"{name:46s} {wall:7.1f} ms {worst:7.1f} ms {own:7.1f} ms", flush=True)


if __name__ == "__main__":
    main()
