"""Start-up times from cold, as whole processes. Run: python -m bench.startup

Each command is paired, run by run, with a bare `python -c pass`, so that the ratio holds on another machine.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time

RUNS = 15
COMMANDS = {
    "chatrobot --help": ["--help"],
    'chatrobot do "forward 1 m" --fast': ["do", "forward 1 m", "--fast"],
    "chatrobot stop": ["stop"],
}


def seconds(command: list[str], folder: str) -> float:
    """Wall time of one run."""
    environment = {**os.environ, "XDG_RUNTIME_DIR": folder, "XDG_CONFIG_HOME": folder}
    began_s = time.monotonic()
    subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, check=False)
    return time.monotonic() - began_s


def main() -> None:
    print(f"{'':40s} {'median':>10s} {'max':>10s} {'x python':>9s}")
    with tempfile.TemporaryDirectory() as folder:
        for name, arguments in COMMANDS.items():
            ours, bare = [], []
            for _ in range(RUNS):
                ours.append(seconds([sys.executable, "-m", "chatrobot", *arguments], folder))
                bare.append(seconds([sys.executable, "-c", "pass"], folder))
            ratio = statistics.median(a / b for a, b in zip(ours, bare))
            print(
                f"{name:40s} {statistics.median(ours) * 1e3:7.0f} ms {max(ours) * 1e3:7.0f} ms {ratio:8.1f}x"
            )


if __name__ == "__main__":
    main()
