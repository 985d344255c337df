"""What stands outside of the sandbox and must not notice anything."""

from __future__ import annotations

import contextlib
import os
import resource
import secrets
import socket
import subprocess
import time
from pathlib import Path
from typing import Any

CLOCK_SET_S = 0.1
"""Keeping the time moves the clock by far less in the seconds that a witness stands."""


class Witness:
    """Files, sockets and a process that an attack could reach if it got out.

    Args:
        folder: an empty folder, which anybody may write.
    """

    def __init__(self, folder: Path) -> None:
        self.word = "secret-" + secrets.token_hex(8)
        self._folder = folder
        for each in (folder, *folder.parents[:-1]):
            with contextlib.suppress(PermissionError):
                each.chmod(0o777 if each == folder else each.stat().st_mode | 0o055)
        (folder / "secret").write_text(self.word)
        (folder / "writable").write_text("as it was")
        (folder / "writable").chmod(0o666)
        self._tcp = _listening(socket.AF_INET, socket.SOCK_STREAM, ("127.0.0.1", 0))
        self._udp = _listening(socket.AF_INET, socket.SOCK_DGRAM, ("127.0.0.1", 0))
        self._unix = _listening(socket.AF_UNIX, socket.SOCK_STREAM, str(folder / "unix"))
        self._datagram = _listening(socket.AF_UNIX, socket.SOCK_DGRAM, str(folder / "datagram"))
        self._abstract = _listening(socket.AF_UNIX, socket.SOCK_STREAM, "\0chatrobot-" + secrets.token_hex(4))
        self._victim = subprocess.Popen(["sleep", "600"])
        self.world: dict[str, Any] = {
            "folder": str(folder),
            "secret": str(folder / "secret"),
            "writable": str(folder / "writable"),
            "tcp": self._tcp.getsockname()[1],
            "udp": self._udp.getsockname()[1],
            "unix": str(folder / "unix"),
            "unix_datagram": str(folder / "datagram"),
            "abstract": self._abstract.getsockname().decode(),
            "victim": self._victim.pid,
            "host": os.getpid(),
            "shm": "chatrobot-" + secrets.token_hex(4),
        }
        self._clock_ahead_s = _clock_ahead_s()
        self._before = self._look()

    def effects(self) -> list[str]:
        """What has changed outside since the beginning. Empty is good."""
        now = self._look()
        return [
            f"{name}: {self._before[name]} became {now[name]}"
            for name in now
            if now[name] != self._before[name]
        ]

    def restore(self) -> None:
        """As at the beginning, after an attack that had effects."""
        writable = self._folder / "writable"
        for each in self._folder.iterdir():
            if each.name not in ("secret", "writable", "unix", "datagram"):
                each.unlink() if not each.is_dir() else each.rmdir()
        writable.unlink(missing_ok=True)
        writable.write_text("as it was")
        writable.chmod(0o666)
        self._victim.kill()
        self._victim.wait()
        self._victim = subprocess.Popen(["sleep", "600"])
        self.world["victim"] = self._victim.pid
        self._before = self._look()

    def close(self) -> None:
        self._victim.kill()
        self._victim.wait()
        for each in (self._tcp, self._udp, self._unix, self._datagram, self._abstract):
            each.close()

    def _look(self) -> dict[str, Any]:
        sockets = (self._tcp, self._udp, self._unix, self._datagram, self._abstract)
        writable = self._folder / "writable"
        there = writable.exists()
        return {
            "names in the folder": sorted(each.name for each in self._folder.iterdir()),
            "the writable file": writable.read_text() if there else None,
            "its rights and times": (writable.stat().st_mode, writable.stat().st_mtime) if there else None,
            "what arrived": [_arrived(each) for each in sockets],
            "the victim": self._look_at_the_victim(),
            "shared memory": Path("/dev/shm", self.world["shm"]).exists(),
            "System V": Path("/proc/sysvipc/shm").read_text() if Path("/proc/sysvipc/shm").exists() else "",
            "name of the machine": socket.gethostname(),
            "the clock was set": abs(_clock_ahead_s() - self._clock_ahead_s) > CLOCK_SET_S,
        }

    def _look_at_the_victim(self) -> tuple[int, ...] | str:
        if self._victim.poll() is not None:
            return "dead"
        pid = self._victim.pid
        return os.getpriority(os.PRIO_PROCESS, pid), *resource.prlimit(pid, resource.RLIMIT_NOFILE)


def _clock_ahead_s() -> float:
    """How far the wall clock is ahead of the monotonic one."""
    return time.time() - time.monotonic()


def _listening(family: int, kind: int, address: Any) -> socket.socket:
    made = socket.socket(family, kind)
    made.bind(address)
    if kind == socket.SOCK_STREAM:
        made.listen()
    made.setblocking(False)
    return made


def _arrived(listening: socket.socket) -> bool:
    try:
        if listening.type == socket.SOCK_STREAM:
            listening.accept()[0].close()
        else:
            listening.recv(100)
    except BlockingIOError:
        return False
    return True
