"""The folder where this user's running robots keep their sockets."""

from __future__ import annotations

import contextlib
import os
import stat
from pathlib import Path

from chatrobot.core.errors import WireError


def runtime_dir() -> Path:
    """`$XDG_RUNTIME_DIR/chatrobot`, or `/tmp/chatrobot-<uid>`; made if missing, private to the user.

    Raises:
        WireError: somebody else owns the folder, or it is open to others.
    """
    base = os.environ.get("XDG_RUNTIME_DIR")
    path = (
        Path(base) / "chatrobot"
        if base and os.access(base, os.W_OK)
        else Path(f"/tmp/chatrobot-{os.getuid()}")
    )
    path.mkdir(mode=0o700, exist_ok=True)
    info = path.lstat()
    if not stat.S_ISDIR(info.st_mode) or info.st_uid != os.getuid():
        raise WireError(f"{path} is not ours: remove it or set XDG_RUNTIME_DIR to a folder of yours")
    if info.st_mode & 0o077:
        path.chmod(0o700)
    return path


def stop_socket_path(pid: int) -> Path:
    """Return where the Motion of that process id listens for `chatrobot stop`."""
    return runtime_dir() / f"motion-{pid}.stop"


def agent_socket_path(pid: int) -> Path:
    """Return where the web console of that process id serves agents."""
    return runtime_dir() / f"agents-{pid}.mcp"


def agent_socket_paths() -> list[Path]:
    """Those of all that run, or died without tidying up; the newest first."""
    found = []
    for path in runtime_dir().glob("agents-*.mcp"):
        with contextlib.suppress(OSError):  # it is just leaving
            found.append((path.stat().st_mtime, path))
    return [path for _, path in sorted(found, reverse=True)]


def stop_socket_paths() -> list[Path]:
    """Those of all that run, or died without tidying up."""
    return sorted(runtime_dir().glob("motion-*.stop"))
