"""The filter between a program in the sandbox and the kernel: what may be asked, assembled for this machine.

Three answers: what a program needs to compute, wait and talk over descriptors it has is allowed; what an ordinary
program may try (open a file, a socket, a process) is a PermissionError; what only an attack tries kills.

The language is classic BPF (`linux/filter.h`): a 32-bit accumulator, loads from `struct seccomp_data`, and jumps
that go forward only. Jumps reach 255 instructions; every rule is far shorter.
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from chatrobot.sandbox.libc import PR_SET_NO_NEW_PRIVS, PR_SET_SECCOMP, prctl
from chatrobot.sandbox.syscalls import NEWEST, Machine

KILL_PROCESS = 0x80000000
ALLOW = 0x7FFF0000
ERRNO = 0x00050000
EPERM = 1
ENOSYS = 38
REFUSE = ERRNO | EPERM
NOT_THERE = ERRNO | ENOSYS

INSTRUCTION = struct.Struct("=HBBI")
_LOAD, _JUMP_EQUAL, _JUMP_GREATER_EQUAL, _RETURN, _AND = 0x20, 0x15, 0x35, 0x06, 0x54
_NUMBER_AT, _ARCH_AT, _ARGUMENTS_AT = 0, 4, 16
_X32_BIT = 0x40000000
_LOW = 0xFFFFFFFF


@dataclass(frozen=True)
class Is:
    """Argument number `index` (from 0), all of its 64 bits, is `value`."""

    index: int
    value: int


@dataclass(frozen=True)
class Masked:
    """The low half of argument `index`, cut to the bits of `mask`, is `value`."""

    index: int
    mask: int
    value: int


Test = Is | Masked


@dataclass(frozen=True)
class Rule:
    """Calls that are answered the same way.

    Args:
        names: system calls; one that a machine does not have is left out there.
        action_code: what the kernel answers.
        when: any of these sets of tests must hold as a whole; empty: always.
        otherwise_code: the answer where none holds.
    """

    names: tuple[str, ...]
    action_code: int = ALLOW
    when: tuple[tuple[Test, ...], ...] = ()
    otherwise_code: int = REFUSE


Code = list[tuple[int, int, int, int]]


def assemble(machine: Machine, rules: Iterable[Rule], default_code: int = REFUSE) -> bytes:
    """The filter as an array of `struct sock_filter`.

    Calls of another machine's kind, which would have other numbers, kill.

    Args:
        machine: whose numbers to use.
        rules: the first that names a call counts.
        default_code: the answer to what no rule names.
    """
    code: Code = [
        (_LOAD, 0, 0, _ARCH_AT),
        (_JUMP_EQUAL, 1, 0, machine.audit_arch),
        (_RETURN, 0, 0, KILL_PROCESS),
        (_LOAD, 0, 0, _NUMBER_AT),
    ]
    if machine.name == "x86_64":
        code += [(_JUMP_GREATER_EQUAL, 0, 1, _X32_BIT), (_RETURN, 0, 0, KILL_PROCESS)]
    for rule in rules:
        for name in rule.names:
            if name in machine.numbers:
                answer = _answer(rule)
                code += [(_JUMP_EQUAL, 0, len(answer), machine.numbers[name]), *answer]
    code += [
        (_JUMP_GREATER_EQUAL, 0, 1, NEWEST),
        (_RETURN, 0, 0, NOT_THERE),
        (_RETURN, 0, 0, default_code),
    ]
    return b"".join(INSTRUCTION.pack(*each) for each in code)


def _answer(rule: Rule) -> Code:
    code: Code = []
    for tests in rule.when:
        code += _all_of(tests, rule.action_code)
    return [*code, (_RETURN, 0, 0, rule.otherwise_code if rule.when else rule.action_code)]


def _all_of(tests: Sequence[Test], action_code: int) -> Code:
    """Return `action_code` if all tests hold, else fall through behind the last instruction."""
    steps: list[tuple[tuple[int, int, int, int], bool]] = []
    for test in tests:
        low_at = _ARGUMENTS_AT + 8 * test.index
        steps.append(((_LOAD, 0, 0, low_at), False))
        if isinstance(test, Masked):
            steps.append(((_AND, 0, 0, test.mask), False))
        steps.append(((_JUMP_EQUAL, 0, 0, test.value & _LOW), True))
        if isinstance(test, Is):
            steps.append(((_LOAD, 0, 0, low_at + 4), False))
            steps.append(((_JUMP_EQUAL, 0, 0, test.value >> 32), True))
    code: Code = []
    for place, ((operation, _, _, operand), is_test) in enumerate(steps):
        to_the_end = len(steps) - place if is_test else 0
        code.append((operation, 0, to_the_end, operand))
    return [*code, (_RETURN, 0, 0, action_code)]


OWN_PID = 0x5EC0_0B0C
"""Stands in the filter for the process's own number until that is known."""

_ALLOWED = """
read write readv writev close fstat lseek
clock_gettime clock_getres gettimeofday time nanosleep clock_nanosleep times getrusage getitimer setitimer alarm
futex set_robust_list rseq set_tid_address sched_yield getcpu
getpid gettid getppid getuid geteuid getgid getegid getresuid getresgid getpgrp getgroups getcwd uname getrlimit
brk munmap mremap madvise
rt_sigaction rt_sigprocmask rt_sigreturn rt_sigpending rt_sigsuspend rt_sigtimedwait sigaltstack pause restart_syscall
poll ppoll select pselect6 epoll_create epoll_create1 epoll_ctl epoll_wait epoll_pwait epoll_pwait2 eventfd2 pipe
dup dup2 dup3 shutdown getsockname getpeername getrandom exit exit_group
"""
_DEADLY = """
ptrace process_vm_readv process_vm_writev process_madvise process_mrelease kcmp pidfd_getfd pidfd_send_signal
bpf seccomp perf_event_open userfaultfd io_uring_setup io_uring_enter io_uring_register memfd_secret
kexec_load kexec_file_load init_module finit_module delete_module reboot swapon swapoff acct quotactl syslog vhangup
mount umount2 pivot_root chroot setns unshare move_mount open_tree fsopen fsconfig fsmount fspick mount_setattr
add_key request_key keyctl personality modify_ldt iopl ioperm capset
shmget shmat shmctl shmdt msgget msgctl msgsnd msgrcv semget semop semctl mq_open mq_unlink
settimeofday clock_settime adjtimex clock_adjtime sethostname setdomainname
name_to_handle_at open_by_handle_at fanotify_init fanotify_mark lookup_dcookie move_pages migrate_pages vmsplice
landlock_create_ruleset landlock_add_rule landlock_restrict_self rt_sigqueueinfo rt_tgsigqueueinfo
"""

_PROT_EXEC = 0x4
_MAP_ANONYMOUS, _MAP_HUGE = 0x20, 0x40000
_AF_UNIX, _SOCK_KIND, _SOCK_STREAM, _MSG_OOB = 1, 0xF, 1, 1
_SOL_SOCKET, _SOCKET_OPTIONS = 1, (3, 4, 7, 8, 30, 38, 39)
"""SO_TYPE, SO_ERROR, SO_SNDBUF, SO_RCVBUF, SO_ACCEPTCONN, SO_PROTOCOL, SO_DOMAIN."""
_O_NOTIFICATION_PIPE, _CLOSE_RANGE_CLOEXEC = 0x80, 4
_DUPLICATE, _GET_FLAGS, _SET_FLAGS, _GET_STATUS, _SET_STATUS, _DUPLICATE_CLOEXEC = 0, 1, 2, 3, 4, 1030
_FCNTLS = (_DUPLICATE, _GET_FLAGS, _SET_FLAGS, _GET_STATUS, _SET_STATUS, _DUPLICATE_CLOEXEC)
_IS_A_TERMINAL, _BLOCKING, _WAITING_BYTES, _NO_CLOEXEC, _CLOEXEC = 0x5401, 0x5421, 0x541B, 0x5450, 0x5451
_IOCTLS = (_IS_A_TERMINAL, _BLOCKING, _WAITING_BYTES, _NO_CLOEXEC, _CLOEXEC)
_A_THREAD = (0x003D0F00, 0x007D0F00)
"""The flags with which glibc and musl make a thread: shares everything, no namespace, no new process."""


def _one_of(index: int, values: tuple[int, ...]) -> tuple[tuple[Is], ...]:
    return tuple((Is(index, value),) for value in values)


RULES = (
    Rule(tuple(_ALLOWED.split())),
    Rule(tuple(_DEADLY.split()), KILL_PROCESS),
    # glibc falls back to clone, whose flags a filter can see.
    Rule(("clone3",), NOT_THERE),
    Rule(("clone",), when=_one_of(0, _A_THREAD)),
    # No machine code of its own, and no file either: only anonymous memory in ordinary pages.
    Rule(
        ("mmap",), when=((Masked(2, _PROT_EXEC, 0), Masked(3, _MAP_ANONYMOUS | _MAP_HUGE, _MAP_ANONYMOUS)),)
    ),
    Rule(("mprotect",), when=((Masked(2, _PROT_EXEC, 0),),)),
    # An address would let it speak to somebody else's socket; out-of-band data has been a way out of other sandboxes.
    Rule(("sendto",), when=((Is(4, 0), Masked(3, _MSG_OOB, 0)),)),
    Rule(("recvfrom",), when=((Masked(3, _MSG_OOB, 0),),)),
    # What Python asks to know a socket; not its peer's process (SO_PEERPIDFD), which would be a descriptor of the host.
    Rule(("getsockopt",), when=tuple((Is(1, _SOL_SOCKET), Is(2, option)) for option in _SOCKET_OPTIONS)),
    Rule(("close_range",), when=_one_of(2, (0, _CLOSE_RANGE_CLOEXEC))),
    Rule(("pipe2",), when=((Masked(1, _O_NOTIFICATION_PIPE, 0),),)),
    Rule(("socketpair",), when=((Is(0, _AF_UNIX), Masked(1, _SOCK_KIND, _SOCK_STREAM)),)),
    # Not F_SETOWN and F_SETSIG, with which the kernel sends signals on its behalf.
    Rule(("fcntl",), when=_one_of(1, _FCNTLS)),
    Rule(("ioctl",), when=_one_of(1, _IOCTLS)),
    # raise(), os.kill(os.getpid(), …) and abort() are ordinary; anybody else's number is not.
    Rule(("kill", "tgkill"), when=((Is(0, OWN_PID),),)),
    Rule(("prlimit64",), when=((Is(0, 0), Is(2, 0)), (Is(0, OWN_PID), Is(2, 0)))),
    Rule(("sched_getaffinity",), when=((Is(0, 0),), (Is(0, OWN_PID),))),
)


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
        """Fill in a process's own number."""
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
