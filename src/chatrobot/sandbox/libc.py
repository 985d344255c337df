"""The few calls to the kernel that Python has no function for."""

from __future__ import annotations

import ctypes
import os

PR_SET_PDEATHSIG = 1
PR_SET_DUMPABLE = 4
PR_SET_SECCOMP = 22
PR_SET_NO_NEW_PRIVS = 38
_PIDFD_SEND_SIGNAL, _PIDFD_OPEN = 424, 434
"""The same on every machine, like all numbers since Linux 5.1."""

_libc = ctypes.CDLL(None, use_errno=True)
_libc.syscall.restype = ctypes.c_long
_libc.prctl.restype = ctypes.c_int


def system_call(number: int, *arguments: int | bytes | ctypes.Array[ctypes.c_char] | None) -> int:
    """`syscall(2)`. Integers are passed as 64-bit words.

    Raises:
        OSError: the kernel's answer.
    """
    words = [ctypes.c_long(each) if isinstance(each, int) else each for each in arguments]
    answer = int(_libc.syscall(ctypes.c_long(number), *words))
    if answer < 0:
        _raise_errno()
    return answer


def prctl(option: int, value: int | bytes = 0, address: int = 0) -> None:
    """`prctl(2)`.

    Raises:
        OSError: the kernel's answer.
    """
    words = [ctypes.c_ulong(value) if isinstance(value, int) else value, ctypes.c_void_p(address)]
    if _libc.prctl(option, *words, ctypes.c_ulong(0), ctypes.c_ulong(0)) != 0:
        _raise_errno()


def mount(source: str, target: str, kind: str, flags: int, data: str = "") -> None:
    """`mount(2)`.

    Raises:
        OSError: the kernel's answer.
    """
    texts = [source.encode(), target.encode(), kind.encode()]
    if _libc.mount(*texts, ctypes.c_ulong(flags), data.encode() or None) != 0:
        _raise_errno()


def pidfd_open(pid: int) -> int:
    """A descriptor for a process, which never means another one. Python has it only where it was built with it.

    Raises:
        OSError: no such process, or a kernel before 5.3.
    """
    return system_call(_PIDFD_OPEN, pid, 0)


def pidfd_send_signal(pidfd: int, signal_number: int) -> None:
    """Raises: OSError: the process is gone."""
    system_call(_PIDFD_SEND_SIGNAL, pidfd, signal_number, None, 0)


def _raise_errno() -> None:
    number = ctypes.get_errno()
    raise OSError(number, os.strerror(number))
