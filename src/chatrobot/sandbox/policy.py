"""What a program in the sandbox may ask of the kernel. Everything else is refused.

Three answers: what a program needs to compute, wait and talk over descriptors it has is allowed; what an ordinary
program may try (open a file, a socket, a process) is a PermissionError; what only an attack tries kills.
"""

from __future__ import annotations

from chatrobot.sandbox.bpf import KILL_PROCESS, NOT_THERE, Is, Masked, Rule

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
