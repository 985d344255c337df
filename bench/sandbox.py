"""The sandbox around programs: how long its warm server starts, a launch takes, and a kill. Run: python -m
bench.sandbox"""

from __future__ import annotations

import time
from pathlib import Path

import tests

from bench import line
from chatrobot.sandbox.warm_server import WarmServer

REPETITIONS = 100
INSIDE = Path(tests.__file__).parent / "sandbox" / "inside"
WAIT = b"import time; channel.sendall(b'here'); time.sleep(60)"


def main() -> None:
    started, launched, killed = [], [], []
    for _ in range(5):
        began_s = time.monotonic()
        with WarmServer([INSIDE], ["sandbox_entries"]) as server:
            server.start()
            started.append(time.monotonic() - began_s)
    with WarmServer([INSIDE], ["sandbox_entries"]) as server:
        server.start()
        for _ in range(REPETITIONS):
            began_s = time.monotonic()
            with server.launch("sandbox_entries:run_source", WAIT) as process:
                process.channel.recv(4)
                launched.append(time.monotonic() - began_s)
                began_s = time.monotonic()
                process.kill()
                process.wait()
                killed.append(time.monotonic() - began_s)
    print(f"{'':62s} {'median':>11s} {'p99':>10s}")
    line("start of the warm server", started)
    line("launch → first byte from the program", launched)
    line("kill → reported gone", killed)


if __name__ == "__main__":
    main()
