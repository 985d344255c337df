"""A warm server starts quickly, forks quickly, and takes all with it when it goes."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest

from chatrobot.core.errors import SandboxError
from chatrobot.core.reason import Reason
from chatrobot.sandbox.limits import Layers, SandboxLimits
from chatrobot.sandbox.process import SandboxedProcess
from chatrobot.sandbox.warm_server import WarmServer

INSIDE = Path(__file__).parent / "inside"


@pytest.fixture(scope="module")
def server() -> Iterator[WarmServer]:
    with WarmServer([INSIDE], ["sandbox_entries"], SandboxLimits(cpu_s=5, wall_s=10)) as server:
        server.start()
        yield server


def output_of(server: WarmServer, source: str) -> str:
    with server.launch("sandbox_entries:run_source", source.encode()) as process:
        report = process.wait(10)
        assert report is not None
        assert report.exit_code == 0, process.read_logs()
        return process.read_logs()


def test_a_program_gets_its_payload_and_a_channel(server: WarmServer) -> None:
    with server.launch("sandbox_entries:echo", b"hello") as process:
        assert process.channel.recv(100) == b"heard hello"
        report = process.wait(5)
        assert report is not None
        assert (report.exit_code, report.signal, report.reason) == (0, None, None)


def test_a_large_payload_arrives_whole(server: WarmServer) -> None:
    with server.launch("sandbox_entries:echo", b"x" * 3_000_000) as process:
        arrived = 0
        while part := process.channel.recv(1 << 20):
            arrived += len(part)
        assert arrived == 3_000_006


def test_a_child_that_does_not_find_its_entry_says_so(server: WarmServer) -> None:
    with server.launch("sandbox_entries:nothing") as process:
        report = process.wait(5)
        assert report is not None
        assert report.exit_code not in (0, None)
        assert "nothing" in process.read_logs()


def test_no_server_no_launch() -> None:
    with pytest.raises(SandboxError) as caught:
        WarmServer().launch("sandbox_entries:echo")
    assert caught.value.reason.code == "box_does_not_start"


def test_a_module_that_cannot_be_imported_is_named() -> None:
    with pytest.raises(SandboxError, match="no_such_module"):
        WarmServer(preload=["no_such_module"]).start()


def wait_until(is_so: Callable[[], bool], timeout_s: float = 5.0) -> bool:
    ends_s = time.monotonic() + timeout_s
    while not is_so():
        if time.monotonic() > ends_s:
            return False
        time.sleep(0.002)
    return True


FOREVER = """
import signal, time
for each in range(1, 65):
    try: signal.signal(each, signal.SIG_IGN)
    except (OSError, ValueError): pass
channel.sendall(b'here')
while True: time.sleep(1)
"""


def launch_forever(server: WarmServer) -> SandboxedProcess:
    process = server.launch("sandbox_entries:run_source", FOREVER.encode())
    assert process.channel.recv(4) == b"here"
    return process


def test_a_program_is_scheduled_like_any_other_whoever_started_it() -> None:
    """Motion is woken sooner than others, or runs in real time; a program that it runs must not."""
    scheduled: list[int] = []

    def start_scheduled_otherwise() -> None:  # what is set of a thread goes with it
        os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))
        with WarmServer([INSIDE], ["sandbox_entries"]) as server:
            server.start()
            with launch_forever(server) as process:
                scheduled.append(os.sched_getscheduler(process.pid))

    thread = threading.Thread(target=start_scheduled_otherwise)
    thread.start()
    thread.join()
    assert scheduled == [os.SCHED_OTHER]


def test_all_programs_together_get_less_than_what_governs_the_robot(server: WarmServer) -> None:
    """The kernel shares a processor among sessions first: in one of its own each would get as much as Motion."""
    with launch_forever(server) as first, launch_forever(server) as second:
        niceness = max(5, os.getpriority(os.PRIO_PROCESS, 0))
        for program in (first, second):
            assert os.getpriority(os.PRIO_PROCESS, program.pid) == niceness
            assert os.getpgid(program.pid) == program.pid
        assert os.getsid(first.pid) == os.getsid(second.pid) != os.getsid(0)
        ranked = Path(f"/proc/{first.pid}/autogroup")
        assert not ranked.exists() or ranked.read_text().endswith(f"nice {niceness}\n")


def test_programs_that_compute_without_end_leave_the_processor_to_what_drives(server: WarmServer) -> None:
    """On one processor, beside whatever else the machine does: more to the one that drives than to all of them."""
    here = psutil.Process().cpu_affinity()[:1]
    words = [sys.executable, "-c", "while True: pass"]
    drives = psutil.Process(subprocess.Popen(words, start_new_session=True).pid)
    with contextlib.ExitStack() as programs:
        programs.callback(drives.wait)
        programs.callback(drives.kill)
        all_of_them = []
        for _ in range(3):
            program = server.launch("sandbox_entries:run_source", b"while True: pass")
            all_of_them.append(psutil.Process(programs.enter_context(program).pid))
        for one in (drives, *all_of_them):
            one.cpu_affinity(here)
        began_s = [sum(one.cpu_times()[:2]) for one in (drives, *all_of_them)]
        time.sleep(1.5)
        own_s, *others_s = [
            sum(one.cpu_times()[:2]) - before_s for one, before_s in zip((drives, *all_of_them), began_s)
        ]
    assert own_s > sum(others_s)


def test_kill_is_not_delayed_by_a_program_that_ignores_signals(server: WarmServer) -> None:
    with launch_forever(server) as process:
        began_s = time.monotonic()
        process.kill()
        report = process.wait(5)
        assert report is not None
        assert time.monotonic() - began_s < 0.2
        assert report.signal == signal.SIGKILL
        assert report.reason is not None
        assert report.reason.code == "box_killed"


def test_closing_kills(server: WarmServer) -> None:
    process = launch_forever(server)
    process.close()
    assert wait_until(lambda: not psutil.pid_exists(process.pid))


def test_what_the_host_lets_go_of_is_killed_even_without_a_word(server: WarmServer) -> None:
    process = launch_forever(server)
    process._report.close()
    assert wait_until(lambda: not psutil.pid_exists(process.pid))
    process.close()


def test_a_kernel_without_process_descriptors_kills_too(server: WarmServer) -> None:
    """The warm server then does it, on a word of the host's."""
    with launch_forever(server) as process:
        pidfd, process._pidfd = process._pidfd, None
        assert pidfd is not None
        os.close(pidfd)
        process.kill()
        assert process.wait(5) is not None


def test_interrupt_is_ctrl_c(server: WarmServer) -> None:
    source = """
import time
try:
    channel.sendall(b'here')
    time.sleep(10)
except KeyboardInterrupt:
    print('cleaned up')
"""
    with server.launch("sandbox_entries:run_source", source.encode()) as process:
        assert process.channel.recv(4) == b"here"
        os.kill(process.pid, signal.SIGINT)
        report = process.wait(5)
        assert report is not None
        assert report.exit_code == 0
        assert process.read_logs() == "cleaned up\n"


def test_two_programs_run_at_once_and_end_apart(server: WarmServer) -> None:
    with launch_forever(server) as first, launch_forever(server) as second:
        first.kill()
        assert first.wait(5) is not None
        assert second.wait(0.0) is None


def test_processor_time_is_limited(server: WarmServer) -> None:
    """By a signal first; a second later by one that cannot be ignored."""
    source = "import resource; print(resource.getrlimit(resource.RLIMIT_CPU), flush=True)\nwhile True: pass"
    limits = SandboxLimits(cpu_s=1, wall_s=30)
    with server.launch("sandbox_entries:run_source", source.encode(), limits) as process:
        report = process.wait(25)
        assert report is not None
        assert report.signal == signal.SIGXCPU
        assert report.reason == Reason("box_used_too_much_time", {"limit_s": 1})
        assert process.read_logs() == "(1, 2)\n"


def test_a_flood_is_cut_and_counted(server: WarmServer) -> None:
    limits = SandboxLimits(log_bytes=1000, wall_s=10)
    source = "import os\nfor _ in range(100): os.write(1, b'x' * 1000)"
    with server.launch("sandbox_entries:run_source", source.encode(), limits) as process:
        assert process.wait(5) is not None
        logs = process.read_logs()
        assert logs.startswith("x" * 1000 + "\n[… 99000 bytes more]")
        assert process.read_logs() == ""


def test_ordinary_programs_do_not_notice_the_box(server: WarmServer) -> None:
    source = """
import asyncio, concurrent.futures, datetime, json, logging, math, os, queue, random
import signal, statistics, threading, time, uuid
async def both():
    await asyncio.gather(asyncio.sleep(0.001), asyncio.to_thread(time.sleep, 0.001))
asyncio.run(both())
with concurrent.futures.ThreadPoolExecutor(4) as pool:
    assert sum(pool.map(math.sqrt, [1, 4, 9])) == 6
q = queue.Queue()
threading.Thread(target=q.put, args=(3,)).start()
assert q.get(timeout=1) == 3
event = threading.Event(); assert not event.wait(0.001)
signal.signal(signal.SIGALRM, lambda *_: print('alarm')); signal.setitimer(signal.ITIMER_REAL, 0.001); time.sleep(0.01)
logging.getLogger('x').warning('%s', datetime.datetime.now().year > 2000)
random.random(), uuid.uuid4(), os.urandom(4), os.cpu_count(), os.getpid(), time.strptime('2026', '%Y'), time.localtime()
print(json.dumps({'mean': statistics.mean([1, 2, 3])}), 'é 中')
"""
    logs = output_of(server, source)
    assert sorted(logs.splitlines()) == ["True", "alarm", '{"mean": 2} é 中']


def test_the_clock_on_the_wall_is_the_hosts(server: WarmServer) -> None:
    said = output_of(server, "import time; print(time.strftime('%Z %z', time.localtime(0)))")
    assert said.strip() == time.strftime("%Z %z", time.localtime(0))


def test_numpy_works_where_it_is_installed(server: WarmServer) -> None:
    pytest.importorskip("numpy")
    source = "import numpy as np; print(np.linalg.inv(np.eye(200) * 2)[0, 0], np.random.default_rng(1).random() < 1)"
    assert output_of(server, source) == "0.5 True\n"


def test_a_child_is_at_its_entry_in_milliseconds(server: WarmServer) -> None:
    """In processor time, which other programs do not lengthen; `bench/sandbox.py` measures by the clock."""
    source = "import time; print(time.process_time())"
    assert min(float(output_of(server, source)) for _ in range(10)) < 0.005


def test_nothing_is_left_behind(server: WarmServer) -> None:
    def descriptors() -> int:
        return len(os.listdir("/proc/self/fd"))

    server.launch("sandbox_entries:echo").close()
    before = (descriptors(), threading.active_count())
    for _ in range(5):
        with server.launch("sandbox_entries:echo") as process:
            process.wait(5)
    assert wait_until(lambda: (descriptors(), threading.active_count()) <= before)


@pytest.mark.parametrize(
    "layers", [Layers(), Layers(False, False, False)], ids=["all walls", "no world of its own"]
)
def test_the_servers_death_is_the_end_of_its_children(layers: Layers) -> None:
    with WarmServer([INSIDE], ["sandbox_entries"], layers=layers) as server:
        server.start()
        process = launch_forever(server)
        assert server.process is not None
        server.process.send_signal(signal.SIGKILL)
        assert wait_until(lambda: not psutil.pid_exists(process.pid))
        report = process.wait(5)
        assert report is not None
        assert report.reason == Reason("box_server_lost")
        with pytest.raises(SandboxError):
            server.launch("sandbox_entries:echo")
        process.close()

        server.start()
        launch_forever(server).close()


HOST = """
import sys, time
from pathlib import Path
from chatrobot.sandbox.warm_server import WarmServer
server = WarmServer([Path(sys.argv[1])], ["sandbox_entries"])
server.start()
process = server.launch("sandbox_entries:run_source", sys.argv[2].encode())
process.channel.recv(4)
print(process.pid, flush=True)
time.sleep(60)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_the_hosts_death_is_the_end_of_all(how: signal.Signals) -> None:
    host = subprocess.Popen([sys.executable, "-c", HOST, str(INSIDE), FOREVER], stdout=subprocess.PIPE)
    assert host.stdout is not None
    child = int(host.stdout.readline())
    server = psutil.Process(host.pid).children(recursive=True)
    host.send_signal(how)
    host.wait()
    host.stdout.close()
    assert wait_until(lambda: not psutil.pid_exists(child))
    assert wait_until(lambda: not any(each.is_running() and each.status() != "zombie" for each in server))
