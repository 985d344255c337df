"""The folder where this user's running robots keep their sockets, and where to look for those of others of theirs.

A shell of `su`, `cron` or `docker exec` and a service often lack XDG_RUNTIME_DIR, which a login has: each has to find
what the other has started.
"""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from chatrobot.core.errors import WireError

SHARED = Path("/tmp")
"""Where a user without a runtime folder has one."""


def runtime_dir() -> Path:
    """The first of `runtime_dirs` that can be had; made if missing, private to the user.

    Raises:
        WireError: somebody else owns the folder.
    """
    path = next(path for path in runtime_dirs() if path.parent == SHARED or os.access(path.parent, os.W_OK))
    path.mkdir(mode=0o700, exist_ok=True)
    if not _is_ours(path):
        raise WireError(f"{path} is not ours: remove it or set XDG_RUNTIME_DIR to a folder of yours")
    if path.lstat().st_mode & 0o077:
        path.chmod(0o700)
    return path


def runtime_dirs() -> tuple[Path, ...]:
    """Return where a program of this user may have put its sockets, the likeliest first; they need not be there."""
    uid = os.getuid()
    bases = (os.environ.get("XDG_RUNTIME_DIR"), f"/run/user/{uid}")
    paths = [Path(base) / "chatrobot" for base in bases if base]
    return tuple(dict.fromkeys([*paths, SHARED / f"chatrobot-{uid}"]))


def _is_ours(path: Path) -> bool:
    info = path.lstat()
    return stat.S_ISDIR(info.st_mode) and info.st_uid == os.getuid()


def _sockets(pattern: str) -> Iterator[Path]:
    """Those in all folders that are ours: what another user put there is nobody's to talk to."""
    for folder in runtime_dirs():
        with contextlib.suppress(OSError):  # it is not there
            yield from folder.glob(pattern) if _is_ours(folder) else ()


def stop_socket_path(pid: int) -> Path:
    """Return where the Motion of that process id listens for `chatrobot stop`."""
    return runtime_dir() / f"motion-{pid}.stop"


def agent_socket_path(pid: int) -> Path:
    """Return where the web console of that process id serves agents."""
    return runtime_dir() / f"agents-{pid}.mcp"


def agent_socket_paths() -> list[Path]:
    """Those of all that run, or died without tidying up: those of our own folder first, and in each the newest."""
    found, folders = [], [str(folder) for folder in runtime_dirs()]
    for path in _sockets("agents-*.mcp"):
        with contextlib.suppress(OSError):  # it is just leaving
            found.append((folders.index(str(path.parent)), -path.stat().st_mtime, path))
    return [path for _, _, path in sorted(found)]


def stop_socket_paths() -> list[Path]:
    """Those of all that run, or died without tidying up."""
    return sorted(_sockets("motion-*.stop"))
