"""Walls around the warm server and its children: namespaces (or bubblewrap, which may make them) and Landlock."""

from __future__ import annotations

import os
import shutil
import struct
import sys
from collections.abc import Iterable
from pathlib import Path

from chatrobot.sandbox.libc import PR_SET_DUMPABLE, PR_SET_NO_NEW_PRIVS, mount, prctl, system_call
from chatrobot.sandbox.syscalls import Machine

_NEW_MOUNTS, _NEW_CGROUPS, _NEW_NAMES, _NEW_IPC = 0x20000, 0x2000000, 0x4000000, 0x8000000
_NEW_USERS, _NEW_PIDS, _NEW_NETWORK = 0x10000000, 0x20000000, 0x40000000
_ALL = _NEW_MOUNTS | _NEW_CGROUPS | _NEW_NAMES | _NEW_IPC | _NEW_USERS | _NEW_PIDS | _NEW_NETWORK

_READ_ONLY, _NO_SUID, _NO_DEVICES, _NO_EXEC, _REMOUNT, _BIND, _RECURSIVE, _PRIVATE = (
    0x1, 0x2, 0x4, 0x8, 0x20, 0x1000, 0x4000, 0x40000,
)  # fmt: skip
_DETACH = 2
_NOBODY = 65534
FIRST_OWN_USER = 0x60000000
"""Users above own nothing anywhere: each warm server that root starts becomes one of them."""


def enter_namespaces(machine: Machine) -> None:
    """Into new namespaces; the next process that is forked is the first of the new world.

    The caller has one thread, and is the user it wants to be.

    Raises:
        OSError: this machine does not let us.
    """
    user, group = os.geteuid(), os.getegid()
    # The kernel gives the files below /proc/self to root where a process changed its user.
    prctl(PR_SET_DUMPABLE, 1)
    system_call(machine.numbers["unshare"], _ALL)
    Path("/proc/self/setgroups").write_text("deny")
    Path("/proc/self/uid_map").write_text(f"{_NOBODY} {user} 1")
    Path("/proc/self/gid_map").write_text(f"{_NOBODY} {group} 1")


def empty_the_root(machine: Machine) -> None:
    """Exchange all files for one empty folder that nobody can write. What has to be imported is imported before.

    Raises:
        OSError: this machine does not let us.
    """
    mount("none", "/", "", _RECURSIVE | _PRIVATE)
    flags = _NO_SUID | _NO_DEVICES | _NO_EXEC
    mount("none", "/tmp", "tmpfs", flags, "size=4k,nr_inodes=2,mode=555")
    os.chdir("/tmp")
    system_call(machine.numbers["pivot_root"], b".", b".")
    system_call(machine.numbers["umount2"], b".", _DETACH)
    mount("none", "/", "", flags | _REMOUNT | _BIND | _READ_ONLY)
    os.chdir("/")


def drop_root() -> bool:
    """Become a user that owns nothing and that nobody else is, if this process is root.

    Returns:
        False where it stays root: it has no other users to become (root of a container of its own).
    """
    if os.geteuid() != 0:
        return True
    for user in (FIRST_OWN_USER + os.getpid(), _NOBODY):
        try:
            os.setgroups([])
            os.setresgid(user, user, user)
            os.setresuid(user, user, user)
        except OSError:
            continue
        return True
    return False


def has_own_user() -> bool:
    """Tell whether this process is one of those users that nobody else is."""
    return os.geteuid() >= FIRST_OWN_USER


_VERSION = 1
"""The flag that asks for the version of the interface instead of making a rule set."""
_RIGHTS_OF_VERSION = {1: 13, 2: 14, 3: 15, 4: 15, 5: 16}
"""How many rights over files (bits from 0) each version knows; later ones have no more."""
_TCP_BIND_AND_CONNECT = 0b11
_SIGNALS_AND_ABSTRACT_SOCKETS = 0b11


def landlock_version(machine: Machine) -> int:
    """The version of Landlock here.

    Raises:
        OSError: this kernel has none, or it is switched off.
    """
    return system_call(machine.numbers["landlock_create_ruleset"], None, 0, _VERSION)


def restrict_with_landlock(machine: Machine) -> int:
    """Deny every right over files, and over TCP and signals where this kernel's Landlock knows them.

    Returns:
        The version that is in force.

    Raises:
        OSError: it cannot be had here.
    """
    found = landlock_version(machine)
    files = (1 << _RIGHTS_OF_VERSION[min(found, max(_RIGHTS_OF_VERSION))]) - 1
    attributes = struct.pack("=Q", files)
    if found >= 4:
        attributes += struct.pack("=Q", _TCP_BIND_AND_CONNECT)
    if found >= 6:
        attributes += struct.pack("=Q", _SIGNALS_AND_ABSTRACT_SOCKETS)
    rules = system_call(machine.numbers["landlock_create_ruleset"], attributes, len(attributes), 0)
    prctl(PR_SET_NO_NEW_PRIVS, 1)
    system_call(machine.numbers["landlock_restrict_self"], rules, 0)
    return found


_SYSTEM = ("/usr", "/lib", "/lib32", "/lib64", "/bin", "/sbin")
_FILES = ("/etc/ld.so.cache", "/etc/localtime")


def find_bubblewrap() -> str | None:
    """Return where it is installed, if it is."""
    return shutil.which("bwrap")


def bubblewrap_command(program: str, folders: Iterable[str]) -> list[str]:
    """Return what to put before a command, so that it runs without network, and sees Python and `folders` only.

    Whoever starts it keeps the thread alive in which it does: the wrap dies with that.
    """
    words = [program, "--unshare-all", "--die-with-parent", "--uid", str(_NOBODY), "--gid", str(_NOBODY)]
    for folder in _SYSTEM:
        if os.path.islink(folder):
            words += ["--symlink", os.readlink(folder), folder]
        else:
            words += ["--ro-bind-try", folder, folder]
    for path in (*_FILES, sys.base_prefix, sys.prefix, *folders):
        words += ["--ro-bind-try", str(Path(path).absolute()), str(Path(path).absolute())]
    return [*words, "--proc", "/proc", "--dev", "/dev", "--chdir", "/", "--"]
