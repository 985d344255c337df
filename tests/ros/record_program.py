"""Runs one program under real rclpy and notes what it publishes on the robot's topic, and how it ends.

python record_program.py PROGRAM.py RESULT.json LIMIT_S
"""

from __future__ import annotations

import json
import os
import runpy
import sys
import threading
import time
from pathlib import Path
from typing import Any

from rclpy.publisher import Publisher

stream: list[tuple[float, float, float]] = []
"""(monotonic seconds, m/s, rad/s)."""
publish = Publisher.publish


def note(self: Any, message: Any) -> None:
    publish(self, message)
    twist = getattr(message, "twist", message)
    if self.topic_name == "/cmd_vel" and hasattr(twist, "linear"):
        stream.append((time.monotonic(), float(twist.linear.x), float(twist.angular.z)))


def write(how: str, kind: str = "", text: str = "") -> None:
    told = {"how": how, "kind": kind, "text": text, "stream": stream, "lasted_s": time.monotonic() - began_s}
    Path(sys.argv[2]).write_text(json.dumps(told), encoding="utf-8")
    os._exit(0)


def main() -> None:
    threading.Timer(float(sys.argv[3]), write, ("horizon",)).start()
    try:
        runpy.run_path(sys.argv[1], run_name="__main__")
    except SystemExit:
        write("exit")
    except BaseException as error:  # noqa: BLE001 - whatever it raises is what we want to know
        kind = type(error)
        builtin = kind.__module__ == "builtins"
        write(
            "raised", kind.__qualname__ if builtin else f"{kind.__module__}.{kind.__qualname__}", str(error)
        )
    for thread in threading.enumerate():
        if (
            thread is not threading.current_thread()
            and not thread.daemon
            and not isinstance(thread, threading.Timer)
        ):
            thread.join()
    write("returned")


Publisher.publish = note
began_s = time.monotonic()
main()
