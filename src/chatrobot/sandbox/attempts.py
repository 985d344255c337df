"""What a program tried that the sandbox does not allow, noted for the person who is asked about it.

Noted by Python's audit events inside the sandbox, so it is a hint about honest mistakes, never a wall: the walls are
the kernel's, and a program may scribble over these notes.
"""

from __future__ import annotations

import mmap
import os
import socket
import sys
from typing import Any

KINDS = ("files", "network", "processes", "signals", "native", "memory", "threads")

_FILE_EVENTS = {
    *("os.chmod", "os.chown", "os.link", "os.listdir", "os.mkdir", "os.remove", "os.rename", "os.rmdir"),
    *("os.scandir", "os.symlink", "os.truncate", "os.utime", "os.chdir", "os.setxattr", "os.mkfifo"),
}
_PROCESS_EVENTS = {"os.fork", "os.forkpty", "os.exec", "os.posix_spawn", "os.spawn", "os.system"}
_NETWORK_EVENTS = {"socket.connect", "socket.bind", "socket.sendto", "socket.sendmsg", "socket.getaddrinfo"}
_NATIVE_EVENTS = {"ctypes.dlopen", "ctypes.dlsym", "ctypes.dlsym/handle", "ctypes.call_function"}


def new_page() -> mmap.mmap:
    """A page that the process sees which makes it, and every process forked from it."""
    return mmap.mmap(-1, mmap.PAGESIZE)


def note(page: mmap.mmap, kind: str) -> None:
    """Note one attempt on the page."""
    page[KINDS.index(kind)] = 1


def noted(page: mmap.mmap) -> tuple[str, ...]:
    """Read the kinds that have been noted."""
    return tuple(kind for place, kind in enumerate(KINDS) if page[place])


def watch(page: mmap.mmap) -> None:
    """Note on the page, from now on, what this process tries."""
    own_pid = os.getpid()

    def hook(event: str, arguments: tuple[Any, ...], page: mmap.mmap = page) -> None:
        kind = _kind(event, arguments, own_pid)
        if kind is not None:
            page[KINDS.index(kind)] = 1

    sys.addaudithook(hook)


def _kind(event: str, arguments: tuple[Any, ...], own_pid: int) -> str | None:
    if event == "open":
        # Tracebacks look for source, the library's and that of "<unknown>"; that is nobody's mistake.
        is_source = str(arguments[0]).endswith(".py") or str(arguments[0]).startswith("<")
        return None if is_source or isinstance(arguments[0], int) else "files"
    if event in _FILE_EVENTS or event.startswith(("shutil.", "tempfile.")):
        return "files"
    if event in _NETWORK_EVENTS:
        return "network"
    if event == "socket.__new__":
        return None if arguments[1] in (socket.AF_UNIX, -1) else "network"
    if event in _PROCESS_EVENTS or event.startswith("subprocess."):
        return "processes"
    if event in ("os.kill", "os.killpg"):
        return None if arguments[0] == own_pid else "signals"
    return "native" if event in _NATIVE_EVENTS else None
