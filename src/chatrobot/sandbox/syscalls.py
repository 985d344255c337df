"""Numbers of the system calls that the sandbox speaks of, for each machine it knows.

From the kernel's `asm/unistd_64.h` (x86-64) and `asm-generic/unistd.h` (aarch64 and all newer machines); a test
compares them with the headers where they are installed.
"""

from __future__ import annotations

import platform
from dataclasses import dataclass

_TABLE = """
read 0 63; write 1 64; readv 19 65; writev 20 66; close 3 57; fstat 5 80; lseek 8 62
clock_gettime 228 113; clock_getres 229 114; gettimeofday 96 169; time 201 -; nanosleep 35 101
clock_nanosleep 230 115; times 100 153; getrusage 98 165; getitimer 36 102; setitimer 38 103; alarm 37 -
futex 202 98; set_robust_list 273 99; rseq 334 293; set_tid_address 218 96; sched_yield 24 124
sched_getaffinity 204 123; membarrier 324 283; getcpu 309 168
getpid 39 172; gettid 186 178; getppid 110 173; getuid 102 174; geteuid 107 175; getgid 104 176; getegid 108 177
getresuid 118 148; getresgid 120 150; getpgrp 111 -; getgroups 115 158; getcwd 79 17; uname 63 160
brk 12 214; mmap 9 222; mprotect 10 226; munmap 11 215; mremap 25 216; madvise 28 233
rt_sigaction 13 134; rt_sigprocmask 14 135; rt_sigreturn 15 139; rt_sigpending 127 136; rt_sigsuspend 130 133
rt_sigtimedwait 128 137; sigaltstack 131 132; pause 34 -; restart_syscall 219 128
poll 7 -; ppoll 271 73; select 23 -; pselect6 270 72; epoll_create 213 -; epoll_create1 291 20; epoll_ctl 233 21
epoll_wait 232 -; epoll_pwait 281 22; epoll_pwait2 441 441; eventfd2 290 19; pipe 22 -; pipe2 293 59
dup 32 23; dup2 33 -; dup3 292 24; close_range 436 436; fcntl 72 25; ioctl 16 29
sendto 44 206; recvfrom 45 207; shutdown 48 210; getsockopt 55 209; getsockname 51 204; getpeername 52 205
socketpair 53 199; getrandom 318 278; exit 60 93; exit_group 231 94
clone 56 220; clone3 435 435; tgkill 234 131; kill 62 129; prlimit64 302 261; getrlimit 97 163
ptrace 101 117; process_vm_readv 310 270; process_vm_writev 311 271; process_madvise 440 440; kcmp 312 272
process_mrelease 448 448; pidfd_getfd 438 438; pidfd_open 434 434; pidfd_send_signal 424 424
rt_sigqueueinfo 129 138; rt_tgsigqueueinfo 297 240; bpf 321 280; seccomp 317 277; perf_event_open 298 241
userfaultfd 323 282; io_uring_setup 425 425; io_uring_enter 426 426; io_uring_register 427 427
kexec_load 246 104; kexec_file_load 320 294; init_module 175 105; finit_module 313 273; delete_module 176 106
mount 165 40; umount2 166 39; pivot_root 155 41; chroot 161 51; setns 308 268; unshare 272 97; move_mount 429 429
open_tree 428 428; fsopen 430 430; fsconfig 431 431; fsmount 432 432; fspick 433 433; mount_setattr 442 442
add_key 248 217; request_key 249 218; keyctl 250 219; personality 135 92; modify_ldt 154 -; iopl 172 -; ioperm 173 -
shmget 29 194; shmat 30 196; shmctl 31 195; shmdt 67 197; msgget 68 186; msgctl 71 187; msgsnd 69 189; msgrcv 70 188
semget 64 190; semop 65 193; semctl 66 191; mq_open 240 180; mq_unlink 241 181
reboot 169 142; swapon 167 224; swapoff 168 225; settimeofday 164 170; clock_settime 227 112; adjtimex 159 171
clock_adjtime 305 266; sethostname 170 161; setdomainname 171 162; acct 163 89; quotactl 179 60; syslog 103 116
vhangup 153 58; name_to_handle_at 303 264; open_by_handle_at 304 265; fanotify_init 300 262; fanotify_mark 301 263
lookup_dcookie 212 18; move_pages 279 239; migrate_pages 256 238; vmsplice 278 75; capset 126 91
landlock_create_ruleset 444 444; landlock_add_rule 445 445; landlock_restrict_self 446 446; memfd_secret 447 447
"""

NEWEST = 451
"""Numbers from here on are not in the table: libraries fall back when they hear "not implemented"."""


@dataclass(frozen=True)
class Machine:
    """A machine as the kernel's filters name it: the AUDIT_ARCH value and the number of every call it has."""

    name: str
    audit_arch: int
    numbers: dict[str, int]


def _column(column: int) -> dict[str, int]:
    rows = [row.split() for row in _TABLE.replace("\n", ";").split(";") if row.strip()]
    return {row[0]: int(row[column]) for row in rows if row[column] != "-"}


X86_64 = Machine("x86_64", 0xC000003E, _column(1))
AARCH64 = Machine("aarch64", 0xC00000B7, _column(2))


def this_machine() -> Machine | None:
    """None where no filter is written for this kind of machine (or Python is a 32-bit one)."""
    if platform.system() != "Linux" or platform.architecture()[0] != "64bit":
        return None
    return {"x86_64": X86_64, "aarch64": AARCH64}.get(platform.machine())
