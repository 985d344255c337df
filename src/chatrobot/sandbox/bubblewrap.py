"""Bubblewrap around the warm server, where the machine allows it what it does not allow us: namespaces."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterable
from pathlib import Path

_SYSTEM = ("/usr", "/lib", "/lib32", "/lib64", "/bin", "/sbin")
_FILES = ("/etc/ld.so.cache", "/etc/localtime")
_NOBODY = "65534"


def find() -> str | None:
    """Where it is installed, if it is."""
    return shutil.which("bwrap")


def command(program: str, folders: Iterable[str]) -> list[str]:
    """What to put before a command, so that it runs without network, and sees Python and `folders` only.

    Whoever starts it keeps the thread alive in which it does: the wrap dies with that.
    """
    words = [program, "--unshare-all", "--die-with-parent", "--uid", _NOBODY, "--gid", _NOBODY]
    for folder in _SYSTEM:
        if os.path.islink(folder):
            words += ["--symlink", os.readlink(folder), folder]
        else:
            words += ["--ro-bind-try", folder, folder]
    for path in (*_FILES, sys.base_prefix, sys.prefix, *folders):
        words += ["--ro-bind-try", str(Path(path).absolute()), str(Path(path).absolute())]
    return [*words, "--proc", "/proc", "--dev", "/dev", "--chdir", "/", "--"]
