"""Waits that a signal keeps interrupting: CPython's `SimpleQueue.get` may then miss its timeout and wait for ever."""

from __future__ import annotations

import subprocess
import sys

SIGNALLED = """
import signal, time
{imports}

def dawdle(_number, _frame):
    ends_s = time.monotonic() + 0.004
    while time.monotonic() < ends_s:
        pass

signal.signal(signal.SIGALRM, dawdle)
signal.setitimer(signal.ITIMER_REAL, 0.013, 0.0131)
waiting = {waiting}
for _ in range(200):
    assert waiting.{wait} is None
signal.setitimer(signal.ITIMER_REAL, 0.0)
"""


def see_every_wait_end(imports: str, waiting: str, wait: str) -> None:
    """`waiting` makes an object whose `wait` of 2 ms gives None; two hundred of them, in a process of their own."""
    code = SIGNALLED.format(imports=imports, waiting=waiting, wait=wait)
    subprocess.run([sys.executable, "-c", code], check=True, timeout=20.0)
