"""A class whose robots all move: the period of their velocities, and what it costs: python -m bench.classroom [N …]

Velocities are timed at a subscriber in another process. Promised for 20 robots on two idle cores: 50 Hz, the period
within 10 ms of 20 ms at p99, and under 1.5 GB for all processes together. The second line of each is the same while
every robot is recorded, as `chatrobot web --class` does it: what `sessions` use more is the cost of that. The last
one is about all but two of them, while one pupil has a program rehearsed that never ends, and another a long plan.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from bench import percentile
from chatrobot.compose import Setup
from chatrobot.core.events import Event
from chatrobot.dialogue.pump import Pump
from chatrobot.dialogue.session import Session
from chatrobot.programs.library import KeptProgram
from chatrobot.recording.shelf import make_folder
from chatrobot.sim.robot import TRUTH_TOPIC
from chatrobot.web.class_recordings import ClassRecordings
from chatrobot.web.pupils import PupilsRobot, RobotWires, connect_class
from chatrobot.web.room import Room
from chatrobot.web.server import SWITCH_S
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage

COUNTS = (2, 5, 10, 20)
LASTS_S = 15.0
PERIOD_S = 0.02
ROUND = "repeat 30\n  drive 0.4 m\n  turn left 180 deg\nend"
LONG = "\n".join(f"drive 0.{place % 9 + 1} m\nturn left {place % 90 + 1} deg" for place in range(400))
BUSY = "while True:\n    pass\n"
TICKS = os.sysconf("SC_CLK_TCK")
PROCESSES = {
    "chatrobot.sim": "robots",
    "chatrobot.motion.process": "Motion",
    "chatrobot.guard": "guard",
    "chatrobot.motion.planning_process": "planning",
}


def listen(paths: Sequence[str]) -> None:
    """The subscriber: for each line `first from to` (monotonic seconds) how velocities came from that robot on."""
    heard: list[list[float]] = []
    for path in paths:
        heard.append([])
        LocalWire(path).subscribe("cmd_vel", TwistMessage, partial(_note, heard[-1]))
    print("ready", flush=True)
    for line in sys.stdin:
        first, since_s, until_s = map(float, line.split())
        kept = [[at_s for at_s in times if since_s <= at_s <= until_s] for times in heard[int(first) :]]
        gaps_s = [later - at for times in kept for at, later in itertools.pairwise(times)]
        off_s = [abs(gap_s - PERIOD_S) for gap_s in gaps_s] or [9.9]
        least_hz = min(len(times) for times in kept) / (until_s - since_s)
        print(least_hz, statistics.median(off_s), percentile(off_s, 0.99), max(off_s), flush=True)


def _note(times: list[float], twist: TwistMessage) -> None:
    if any(twist):
        times.append(time.monotonic())


def processes(motion: int) -> dict[str, int]:
    """Return the process ids of all that a class is made of; what is started by them counts with them."""
    found = {"sessions": os.getpid()}
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = file.read_bytes().decode(errors="replace").split("\0")
            parent = int((file.parent / "stat").read_text().rpartition(")")[2].split()[1])
        except OSError:
            continue
        name = next((PROCESSES[word] for word in words if word in PROCESSES), "")
        if name and (parent in (motion, os.getpid())):
            found[name] = int(file.parent.name)
    return found


def busy_s(pid: int) -> float:
    """Return the processor's time that it has used."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def memory_mb(pid: int) -> float:
    """Return its share of the memory, megabytes."""
    lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("Pss:")).split()[1]) / 1024


def _rehearse(sessions: Sequence[Session]) -> None:
    """Two pupils have something rehearsed without end."""
    for session in sessions:
        session.stop("measured")
        assert session.authoring is not None
        session.authoring.library.keep(KeptProgram("busy", BUSY))
    ends_s = time.monotonic() + LASTS_S
    turns = [0] * len(sessions)
    while time.monotonic() < ends_s:
        for place, session in enumerate(sessions):
            if not turns[place] or turns[place] in session.results:
                turns[place] = session.say_plan(LONG) if place else session.say_source("busy", BUSY)
        time.sleep(0.01)


def _ignore(_: Event) -> None:
    """Nothing is recorded."""


@contextlib.contextmanager
def recorded(
    robots: Sequence[PupilsRobot], taps: dict[str, Callable[[Event], None]], folder: Path
) -> Iterator[None]:
    """Record the class meanwhile, and say how much that was."""
    wires = RobotWires(robots, TRUTH_TOPIC)
    recordings = ClassRecordings(make_folder(folder), tuple)
    recordings.open([(robot, Room(robot.name)) for robot in robots], wires)
    taps.update({robot.name: partial(recordings.hear, robot.name) for robot in robots})
    wires.start()
    began_s = time.monotonic()
    time.sleep(1.0)  # the libraries are loaded
    yield
    taps.clear()
    wires.close()
    recordings.close()
    size_kb = sum(file["size_bytes"] for file in recordings.facts()["files"]) / 1e3
    print(f"  {size_kb / len(robots) / (time.monotonic() - began_s):.1f} kB a second and robot")


def print_row(name: str, listener: subprocess.Popen[str], pids: dict[str, int], first: int) -> None:
    """Measure for a while, and print the figures of all robots from that one on."""
    assert listener.stdin is not None
    assert listener.stdout is not None
    before = {process: busy_s(pid) for process, pid in pids.items()}
    since_s = time.monotonic()
    time.sleep(LASTS_S)
    until_s = time.monotonic()
    listener.stdin.write(f"{first} {since_s} {until_s}\n")
    listener.stdin.flush()
    hz, median_s, p99_s, most_s = map(float, listener.stdout.readline().split())
    shares = " ".join(
        f"{process} {100 * (busy_s(pid) - before[process]) / (until_s - since_s):.0f} %"
        for process, pid in pids.items()
    )
    print(
        f"{name}: at least {hz:4.1f} Hz, off 20 ms by {median_s * 1e3:5.2f} ms, p99 {p99_s * 1e3:6.2f} ms,"
        f" most {most_s * 1e3:6.1f} ms; {sum(map(memory_mb, pids.values())):4.0f} MB; {shares}",
        flush=True,
    )


def measure(count: int, folder: str) -> None:
    """Print the figures of a class of so many."""
    names = [str(place) for place in range(count)]
    taps: dict[str, Callable[[Event], None]] = {}
    setup = Setup(world="home", folder=Path(folder), programs=True)
    robots = connect_class(setup, names, lambda name: lambda event: taps.get(name, _ignore)(event))
    sessions = [robot.connection.session for robot in robots]
    pumps = [Pump(session, lambda error: print(error, file=sys.stderr)) for session in sessions]
    for pump in pumps:
        pump.start()
    link = robots[0].connection.link
    pids = processes(link.process.pid)  # type: ignore[attr-defined]
    found = (Path(folder) / "chatrobot").glob("sim-*.wire")
    paths = sorted(map(str, found), key=lambda path: int(path.removesuffix(".wire").rpartition("-")[2]))
    command = [sys.executable, "-m", "bench.classroom", "--listen", *paths]
    pipe = subprocess.PIPE
    listener = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)
    assert listener.stdout is not None
    listener.stdout.readline()
    for session in sessions:
        session.say_plan(ROUND)
    time.sleep(3.0)
    print_row(f"{count:2d} robots", listener, pids, first=0)
    with recorded(robots, taps, Path(folder)):
        print_row(f"{count:2d} robots, recorded", listener, pids, first=0)
    if count > 2:
        threading.Thread(target=_rehearse, args=(sessions[:2],), daemon=True).start()
        print_row(f"{count - 2:2d} robots, while two others rehearse without end", listener, pids, first=2)
    listener.kill()
    listener.wait()
    if ended := [result for session in sessions[2:] for result in session.results.values()]:
        print(f"{len(ended)} did not drive to the end: {ended[0].reply}")
    for pump, robot in zip(pumps, robots):
        robot.connection.session.stop("measured")
        pump.stop()
        robot.connection.close()


def main(arguments: Sequence[str]) -> None:
    if arguments[:1] == ["--listen"]:
        listen(arguments[1:])
        return
    sys.setswitchinterval(SWITCH_S)  # as the server of a class does
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    for count in map(int, arguments or COUNTS):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["XDG_RUNTIME_DIR"] = folder
            measure(count, folder)


if __name__ == "__main__":
    main(sys.argv[1:])
