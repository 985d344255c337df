"""What recordings cost the process that keeps them. Run: python -m bench.recording [SECONDS]

A second process publishes what a moving robot with a lidar does: velocity, odometry and true pose at 50 Hz, 360 beams
at 10 Hz. Counted is the processor time of this process, which only listens and records, after its libraries are
loaded; telemetry events come at 10 Hz. Promised: less than 3 % of a core.

Then a class: what comes from twenty moving robots is recorded, and twenty threads beat at 25 Hz as their sessions do.
Shown is by how much a beat comes late, without recordings and from the first moment of recording on.
"""

from __future__ import annotations

import multiprocessing
import sys
import tempfile
import threading
import time
from pathlib import Path

from bench import line
from chatrobot.core.clock import LOCAL_BEAT_HZ
from chatrobot.core.events import Telemetry
from chatrobot.core.geometry import Pose, Twist
from chatrobot.recording.recorder import LOOK_OF_MANY_S, Recorder, WritingThread
from chatrobot.recording.redactor import Redactor
from chatrobot.recording.topics import CMD_VEL, GROUND_TRUTH, ODOM
from chatrobot.recording.writer import ros_definitions
from chatrobot.robots.profile import Wiring
from chatrobot.wire.local import LocalHub, LocalWire
from chatrobot.wire.messages import LaserScan, Odometry, TwistMessage

SECONDS = 20.0
PUPILS = 20
PROMISED_SHARE = 0.03
WIRING = Wiring(scan_topic="scan")
TRUTH = "truth"
TELEMETRY = Telemetry(0, Pose(1.0, 2.0, 0.3), Twist(0.3, 0.0, 0.0), 12.5, 80.0, 1.2, True)


def robot(path: str) -> None:
    """Publish at 50 Hz until it is ended."""
    hub = LocalHub(path)
    ranges_m = [2.0 + 0.001 * (beam * 7919 % 997) for beam in range(360)]
    next_s = time.monotonic()
    for tick in range(10**9):
        now_s = time.monotonic()
        pose = (1.0 + 0.006 * tick % 3.0, 0.001 * tick % 1.0, 0.01 * tick % 3.0, 0.3, 0.0, 0.5)
        hub.publish("cmd_vel", TwistMessage(0.3, 0.0, 0.5))
        for topic in ("odom", TRUTH):
            hub.publish(topic, Odometry(now_s, *pose))
        if tick % 5 == 0:
            hub.publish(
                "scan",
                LaserScan(now_s, 0.0, 0.0174533, 0.1, 12.0, [r + 1e-4 * (tick % 89) for r in ranges_m]),
            )
        next_s += 0.02
        hub.poll(max(0.0, next_s - time.monotonic()))


def beat(late_s: list[float], is_over: threading.Event) -> None:
    """Note by how much each beat comes late."""
    due_s = time.monotonic()
    while not is_over.wait(max(0.0, due_s - time.monotonic())):
        late_s.append(time.monotonic() - due_s)
        due_s = max(due_s + 1.0 / LOCAL_BEAT_HZ, time.monotonic())


def feed(recorders: list[Recorder], seconds: float) -> None:
    """Give each of them what a moving robot of a class does."""
    next_s = began_s = time.monotonic()
    for tick in range(int(seconds / 0.02)):
        x_m, speed_mps = 0.006 * tick, 0.3 - 0.001 * (tick % 3)
        for recorder in recorders:
            for topic in (ODOM, GROUND_TRUTH):
                recorder.take(topic, Odometry(began_s + 0.02 * tick, x_m, 0.0, 0.0, speed_mps, 0.0, 0.0))
            recorder.take(CMD_VEL, TwistMessage(speed_mps, 0.0, 0.0))
            if tick % 5 == 0:
                recorder.hear(TELEMETRY)
        next_s += 0.02
        time.sleep(max(0.0, next_s - time.monotonic()))


def record_class(seconds: float) -> None:
    """Print by how much beats come late."""
    is_over, late_s = threading.Event(), list[float]()
    for _ in range(PUPILS):
        threading.Thread(target=beat, args=(late_s, is_over)).start()
    feed([], seconds)
    line("a beat is late, nothing recorded", late_s, note=f"most {max(late_s) * 1e3:.1f} ms")
    ros_definitions()  # loaded before a class begins
    with tempfile.TemporaryDirectory() as folder:
        thread = WritingThread(LOOK_OF_MANY_S)
        recorders = [
            Recorder(Path(folder) / f"{place}.mcap", Redactor(tuple, {}), among=thread)
            for place in range(PUPILS)
        ]
        late_s.clear()
        spent_s = time.process_time()
        for recorder in recorders:
            recorder.start(dict)
        feed(recorders, seconds)
        share = (time.process_time() - spent_s) / seconds
        note = f"most {max(late_s) * 1e3:.1f} ms, {share:.1%} of a core with what feeds them"
        line(f"a beat is late, {PUPILS} robots recorded", late_s, note=note)
        is_over.set()
        for recorder in recorders:
            recorder.close()


def main() -> int:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else SECONDS
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "wire"
        publishing = multiprocessing.get_context("spawn").Process(target=robot, args=(str(path),))
        publishing.start()
        while not path.exists():
            time.sleep(0.01)
        recorder = Recorder(Path(folder) / "a.mcap", Redactor(lambda: ("a-key-in-use",), {}))
        recorder.listen(LocalWire(path), WIRING, TRUTH)
        recorder.start(dict)
        while recorder.size_bytes == 0:
            time.sleep(0.1)
        count, size_bytes, began_s = recorder.message_count, recorder.size_bytes, time.monotonic()
        spent_s = time.process_time()
        while (passed_s := time.monotonic() - began_s) < seconds:
            recorder.hear(TELEMETRY)
            time.sleep(0.1)
        spent_s = time.process_time() - spent_s
        count, size_bytes = recorder.message_count - count, recorder.size_bytes - size_bytes
        recorder.close()
        publishing.terminate()
        publishing.join()
    share = spent_s / passed_s
    per_s = f"{count / passed_s:.0f} messages, {size_bytes / passed_s / 1e3:.0f} kB a second"
    print(f"{per_s}: {share:.1%} of a core")
    record_class(seconds)
    return 0 if share < PROMISED_SHARE else 1


if __name__ == "__main__":
    raise SystemExit(main())
