"""How soon the kernel lets a process run that has just been woken, where others keep every core busy.

A process that asks for short turns on the processor gets them sooner, and no more of it in all: sched_setattr(2),
`sched_runtime` of an ordinary process, Linux 6.12 and later; no privilege is needed. Older kernels take the call and
change nothing.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import platform
import struct

_CALL = {"x86_64": 314, "aarch64": 274, "riscv64": 274, "armv7l": 380}
_SHORT_NS = 300_000
"""The kernel's own is 1.4 ms on two cores, in effect the 4 ms between two of its ticks. A tick of the control loop
fits into this one; the shortest that may be had, 0.1 ms, has it interrupted half-way."""
_KERNELS_OWN_NS = 0


def wake_promptly() -> None:
    """The calling thread, and whatever it starts from now on, is woken before what runs in long turns.

    One that a person has given real-time or batch scheduling keeps that.
    """
    if os.sched_getscheduler(0) == os.SCHED_OTHER:
        _take_turns_of(_SHORT_NS)


def wake_as_others_do() -> None:
    """Be scheduled like any other process, whatever was inherited: short turns, or a person's real-time priority."""
    _take_turns_of(_KERNELS_OWN_NS)


def _take_turns_of(slice_ns: int) -> None:
    """For the calling thread. Where the machine has no such call it waits its turn like everybody."""
    call = _CALL.get(platform.machine())
    if call is None:
        return
    no_flags, no_priority, no_deadline, no_period = 0, 0, 0, 0
    niceness = os.getpriority(os.PRIO_PROCESS, 0)
    policy = os.SCHED_OTHER
    size = 48  # struct sched_attr in its first version
    attributes = struct.pack(
        "=IIQiIQQQ", size, policy, no_flags, niceness, no_priority, slice_ns, no_deadline, no_period
    )
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).syscall(call, 0, attributes, 0)
