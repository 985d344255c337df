"""The filter that stands between a program in the sandbox and the kernel."""

from __future__ import annotations

import ctypes
import struct

from chatrobot.sandbox.bpf import INSTRUCTION, assemble
from chatrobot.sandbox.libc import PR_SET_NO_NEW_PRIVS, PR_SET_SECCOMP, prctl
from chatrobot.sandbox.policy import OWN_PID, RULES
from chatrobot.sandbox.syscalls import Machine

_MODE_FILTER = 2


class Filter:
    """The assembled filter, made once in the warm server; each child fills in its own number and installs it.

    Args:
        machine: whose system calls it names.
    """

    def __init__(self, machine: Machine) -> None:
        self._code = bytearray(assemble(machine, RULES))
        self._own_pid_at = [
            offset + INSTRUCTION.size - 4
            for offset in range(0, len(self._code), INSTRUCTION.size)
            if INSTRUCTION.unpack_from(self._code, offset)[3] == OWN_PID
        ]

    def for_process(self, pid: int) -> bytes:
        code = bytearray(self._code)
        for offset in self._own_pid_at:
            struct.pack_into("=I", code, offset, pid)
        return bytes(code)

    def install(self, pid: int) -> None:
        """From here on, for ever, for this thread and all it starts. Call it before there is a second thread.

        Raises:
            OSError: this kernel has no seccomp filters.
        """
        install(self.for_process(pid))


def install(code: bytes) -> None:
    """Put an assembled filter over this process.

    Raises:
        OSError: this kernel has no seccomp filters.
    """
    buffer = ctypes.create_string_buffer(code, len(code))
    # struct sock_fprog: the number of instructions, padding, and where they are.
    program = struct.pack("=H6xQ", len(code) // INSTRUCTION.size, ctypes.addressof(buffer))
    holder = ctypes.create_string_buffer(program, len(program))
    prctl(PR_SET_NO_NEW_PRIVS, 1)
    prctl(PR_SET_SECCOMP, _MODE_FILTER, ctypes.addressof(holder))
