"""All connections of a rosbridge server break at once while a robot behind it drives: seconds to the zero after.

The robot holds its last command; the server is in this process and stamps what reaches it.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from tests.wire.fake_rosbridge import FakeRosbridge
from websockets.sync.server import ServerConnection

PATIENCE_S = 30.0
UNDER_WAY_S = 0.5
WATCH_S = 0.6


class StampingRosbridge(FakeRosbridge):
    """Notes when which velocity came."""

    def __init__(self) -> None:
        self.velocities: list[tuple[float, bool]] = []
        super().__init__()

    def _do(self, client: ServerConnection, request: dict[str, Any]) -> None:
        if request["op"] == "publish" and request["topic"].endswith("cmd_vel"):
            message = request["msg"]
            speeds = [*message["linear"].values(), *message["angular"].values()]
            self.velocities.append((time.monotonic(), any(speeds)))
        super()._do(client, request)

    def wait_for_motion(self) -> None:
        ends_s = time.monotonic() + PATIENCE_S
        while not any(moves for _, moves in self.velocities):
            assert time.monotonic() < ends_s, "nothing drives"
            time.sleep(0.01)


def cut() -> float:
    """Once, with processes of its own."""
    server = StampingRosbridge()
    on = f"rosbridge:{server.url}"
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "XDG_RUNTIME_DIR": folder, "PYTHONUNBUFFERED": "1"}
        config = ("--config-dir", str(Path(folder) / "config"))
        processes = [_start(environment, "sim", "--on", on, "--world", "empty")]
        try:
            assert processes[0].stdout is not None
            while "it ends with Ctrl-C" not in processes[0].stdout.readline():
                assert processes[0].poll() is None, "the robot did not start"
            processes.append(_start(environment, "--json", "--on", on, "--yes", *config))
            assert processes[1].stdin is not None
            processes[1].stdin.write("forward 100 m at 0.3 m/s\n")
            processes[1].stdin.flush()
            server.wait_for_motion()
            time.sleep(UNDER_WAY_S)
            cut_s = time.monotonic()
            server.cut()
            time.sleep(WATCH_S)
            after = [(at_s, moves) for at_s, moves in server.velocities if at_s > cut_s]
            last_s = max((at_s for at_s, moves in after if moves), default=cut_s)
            return (
                min((at_s for at_s, moves in after if at_s >= last_s and not moves), default=float("inf"))
                - cut_s
            )
        finally:
            for process in reversed(processes):
                process.terminate()
                process.wait(PATIENCE_S)
            server.stop()


def _start(environment: dict[str, str], *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "chatrobot", *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=environment,
        start_new_session=True,
        text=True,
    )
