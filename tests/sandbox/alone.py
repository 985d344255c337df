"""Runs attacks behind a single wall, to see what that wall stops by itself. Run: python alone.py WALL < attacks

Reads one attack a line (JSON: source and world), runs it in a forked child behind the wall, and prints its output
and exit code as a line of JSON. Only attacks that are harmless without a wall belong here.
"""

from __future__ import annotations

import encodings.idna  # noqa: F401 - behind a wall nothing more can be imported
import json
import mmap  # noqa: F401
import multiprocessing.shared_memory  # noqa: F401
import os
import resource
import socket  # noqa: F401
import subprocess  # noqa: F401
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "inside"))

import sandbox_entries

from chatrobot.sandbox import walls
from chatrobot.sandbox.seccomp import Filter
from chatrobot.sandbox.syscalls import this_machine

MEMORY_BYTES = 512 << 20


def build(wall: str) -> None:
    machine = this_machine()
    assert machine is not None
    if wall == "filter":
        Filter(machine).install(os.getpid())
    elif wall == "Landlock":
        walls.restrict_with_landlock(machine)
    elif wall == "limits":
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
        resource.setrlimit(resource.RLIMIT_NOFILE, (64, 64))
    elif wall == "namespaces":
        walls.drop_root()
        walls.enter_namespaces(machine)
        pid = os.fork()
        if pid:
            os._exit(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) & 0xFF)
        walls.empty_the_root(machine)


def run(wall: str, attack: dict[str, object]) -> tuple[int, str]:
    reading, writing = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.dup2(writing, 1)
        os.dup2(writing, 2)
        os.close(reading)
        code = 1
        try:
            build(wall)
            names = {"__name__": "__main__", "world": attack["world"], "call": sandbox_entries.call}
            exec(str(attack["source"]), names)
            code = 0
        except BaseException as error:  # noqa: BLE001 - an attack may raise anything
            os.write(1, repr(error).encode())
        finally:
            sys.stdout.flush()
            os._exit(code)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8", errors="replace") as said:
        text = said.read()
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), text


if __name__ == "__main__":
    for line in sys.stdin:
        print(json.dumps(run(sys.argv[1], json.loads(line))), flush=True)
