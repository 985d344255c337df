"""In rehearsal every way to tell or to spend time is on the program's own clock, threads included."""

from __future__ import annotations

from textwrap import dedent

import pytest

from chatrobot.motion.programs.rehearsal import ProgramRehearsal, rehearse_program
from chatrobot.programs.events import Ended, Output
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer

MEC = load_profile("wheeltec_mini_mec")


def run(server: WarmServer, source: str) -> ProgramRehearsal:
    return rehearse_program(server, dedent(source), MEC, horizon_s=3600.0, wall_limit_s=5.0)


def printed(rehearsal: ProgramRehearsal) -> str:
    return "\n".join(line.text for line in rehearsal.log if isinstance(line, Output))


SPENDS = {
    "sleep": "import time; time.sleep(100)",
    "sleep by name": "from time import sleep; sleep(100)",
    "event": "import threading; assert not threading.Event().wait(100)",
    "condition": "import threading\nc = threading.Condition()\nwith c: assert not c.wait(100)",
    "condition wait_for": "import threading as t\nc = t.Condition()\nwith c: assert not c.wait_for(lambda: 0, 100)",
    "lock": "import threading; l = threading.Lock(); l.acquire(); assert not l.acquire(timeout=100)",
    "recursive lock": """
        import threading
        lock = threading.RLock()
        thread = threading.Thread(target=lambda: lock.acquire() and threading.Event().wait(150))
        thread.daemon = True
        thread.start()
        assert not lock.acquire(timeout=100)
        """,
    "semaphore": "import threading; assert not threading.Semaphore(0).acquire(timeout=100)",
    "barrier": """
        import threading
        try: threading.Barrier(2).wait(100)
        except threading.BrokenBarrierError: pass
        """,
    "timer": "import threading; t = threading.Timer(100, print); t.start(); t.join()",
    "join with a timeout": """
        import threading, time
        thread = threading.Thread(target=time.sleep, args=(200,), daemon=True)
        thread.start(); thread.join(timeout=100); assert thread.is_alive()
        """,
    "queue": "import queue\ntry: queue.Queue().get(timeout=100)\nexcept queue.Empty: pass",
    "full queue": "import queue\nq = queue.Queue(1); q.put(1)\ntry: q.put(2, timeout=100)\nexcept queue.Full: pass",
    "simple queue": "import queue\ntry: queue.SimpleQueue().get(timeout=100)\nexcept queue.Empty: pass",
    "select": "import select; select.select([], [], [], 100)",
    "scheduler": "import sched; s = sched.scheduler(); s.enter(100, 1, print); s.run()",
    "asyncio": "import asyncio; asyncio.run(asyncio.sleep(100))",
    "asyncio timeout": """
        import asyncio
        async def main():
            try: await asyncio.wait_for(asyncio.Event().wait(), 100)
            except asyncio.TimeoutError: pass
        asyncio.run(main())
        """,
    "asyncio thread": "import asyncio, time\nasync def m(): await asyncio.to_thread(time.sleep, 100)\nasyncio.run(m())",
    "future": """
        import concurrent.futures, time
        pool = concurrent.futures.ThreadPoolExecutor(2)
        try: pool.submit(time.sleep, 150).result(timeout=100)
        except concurrent.futures.TimeoutError: import os; print("late", flush=True)
        raise SystemExit
        """,
    "a thread at the end": "import threading, time; threading.Thread(target=time.sleep, args=(100,)).start()",
    "time": "import time\nend = time.time() + 100\nwhile time.time() < end: pass",
    "time in nanoseconds": "import time\nend = time.time_ns() + 100 * 10**9\nwhile time.time_ns() < end: pass",
    "monotonic": "from time import monotonic\nend = monotonic() + 100\nwhile monotonic() < end: pass",
    "perf_counter": "from time import perf_counter as now\nend = now() + 100\nwhile now() < end: pass",
    "datetime": """
        from datetime import datetime, timedelta
        end = datetime.now() + timedelta(seconds=100)
        while datetime.now() < end: pass
        """,
    "datetime with a zone": """
        import datetime
        end = datetime.datetime.now(datetime.timezone.utc) + datetime.timedelta(seconds=100)
        while datetime.datetime.now(datetime.timezone.utc) < end: pass
        """,
    "clock_gettime": """
        import time
        end = time.clock_gettime(time.CLOCK_MONOTONIC) + 100
        while time.clock_gettime(time.CLOCK_MONOTONIC) < end: pass
        """,
    "an event that is looked at": """
        import threading
        done = threading.Event()
        threading.Timer(100, done.set).start()
        while not done.is_set(): pass
        """,
    "a thread that is looked at": """
        import threading, time
        thread = threading.Thread(target=time.sleep, args=(100,)); thread.start()
        while thread.is_alive(): pass
        """,
    "a queue that is asked without waiting": """
        import queue, threading
        q = queue.Queue()
        threading.Timer(100, q.put, (1,)).start()
        while True:
            try: q.get_nowait(); break
            except queue.Empty: pass
        """,
    "an empty queue that is looked at": """
        import queue, threading
        q = queue.Queue()
        threading.Timer(100, q.put, (1,)).start()
        while q.empty(): pass
        """,
    "rclpy.ok": """
        import rclpy, threading
        rclpy.init()
        threading.Timer(100, rclpy.shutdown).start()
        while rclpy.ok(): pass
        """,
    "spin_once without a wait": """
        import rclpy
        rclpy.init()
        node = rclpy.create_node("n")
        node.create_timer(100, lambda: rclpy.shutdown())
        while rclpy.ok(): rclpy.spin_once(node, timeout_sec=0)
        """,
}


@pytest.mark.parametrize("way", SPENDS)
def test_a_hundred_seconds_pass_in_a_moment(server: WarmServer, way: str) -> None:
    rehearsal = run(server, SPENDS[way])
    assert isinstance(rehearsal.end, Ended), rehearsal.end
    if way == "future":  # the pool's thread is waited for, as Python does
        assert "late" in printed(rehearsal)
        assert rehearsal.duration_s == pytest.approx(150.0, abs=0.1)
    else:
        assert rehearsal.duration_s == pytest.approx(100.0, abs=0.1)


def test_clocks_agree_and_go_on_together(server: WarmServer) -> None:
    rehearsal = run(
        server,
        """
        import time, datetime
        utc = datetime.timezone.utc
        def clocks():
            return [time.time(), time.monotonic(), time.perf_counter(), datetime.datetime.now().timestamp(),
                    time.mktime(time.localtime()), datetime.datetime.utcnow().replace(tzinfo=utc).timestamp()]
        before = clocks(); time.sleep(1234.0); after = clocks()
        print(max(abs(b - a - 1234.0) for a, b in zip(before, after)) < 1.1)
        print(abs(after[0] - after[3]) < 0.01, datetime.date.today() == datetime.datetime.now().date())
        """,
    )
    assert printed(rehearsal) == "True\nTrue True"


def test_threads_take_turns_in_the_same_order_every_time(server: WarmServer) -> None:
    source = """
        import threading, time
        def work(name, period):
            for n in range(5):
                time.sleep(period)
                print(name, n, f"{time.monotonic():.3f}")
        for name, period in (("a", 0.3), ("b", 0.2), ("c", 0.3)):
            threading.Thread(target=work, args=(name, period)).start()
        """
    first, second = printed(run(server, source)), printed(run(server, source))
    assert first == second
    assert first.splitlines()[0].startswith("b 0")
    assert [line[0] for line in first.splitlines()].count("c") == 5


def test_a_sleeping_loop_is_as_long_as_its_sleeps(server: WarmServer) -> None:
    rehearsal = run(server, "import time\nfor _ in range(1000): time.sleep(0.01)")
    assert rehearsal.duration_s == pytest.approx(10.0, abs=0.01)


def test_what_is_printed_in_a_flood_is_cut_and_says_so(server: WarmServer) -> None:
    rehearsal = run(
        server, "import time\nfor n in range(20000): print('x' * 100)\ntime.sleep(10)\nprint('end')"
    )
    lines = printed(rehearsal).splitlines()
    assert len(lines) < 2000
    assert lines[-1] == "end"
    assert "lines dropped" in lines[-2]


def test_nobody_is_there_to_type(server: WarmServer) -> None:
    rehearsal = run(server, "input('name? ')")
    assert rehearsal.findings[0].reason.values["error"] == "EOFError: EOF when reading a line"
