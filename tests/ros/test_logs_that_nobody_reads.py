"""A terminal that is held up (Ctrl-S), or a pipe that nobody reads, delays nothing but the log itself."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.realtime

TICKS = """
import os, time
from chatrobot.nodes.log import Log
from chatrobot.wire.ros.node import RosNode

log = Log(RosNode("unread").log)
for _ in range(2000):
    log("info", "x" * 100)
began_s, ticks = time.monotonic(), 0
while time.monotonic() - began_s < 2.0:
    time.sleep(0.02)
    ticks += 1
print(ticks, flush=True)
os._exit(0)
"""


def test_a_log_that_nobody_reads_holds_up_no_other_thread() -> None:
    process = subprocess.Popen([sys.executable, "-c", TICKS], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        assert process.wait(30.0) == 0
        assert process.stdout is not None
        assert int(process.stdout.read()) > 20
    finally:
        process.kill()
        process.communicate()
