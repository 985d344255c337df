"""What a hostile program may try, one snippet an attack.

A snippet finds `world` (addresses and paths outside that it must not reach), `channel` and `call(name, …)`, a raw
system call. It prints LEAK if it got hold of something; what it changes outside is watched by `witness.py`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.sandbox.limits import SandboxLimits

End = Literal["refused", "dies", "runs", "crashes", "fails"]
Family = Literal[
    "files", "network", "processes", "signals", "memory of others", "the kernel", "machine code",
    "shared memory", "using it up", "the box itself",
]  # fmt: skip

QUICK = SandboxLimits(cpu_s=10, wall_s=8.0)
SHORT = SandboxLimits(cpu_s=10, wall_s=0.25)
SMALL = SandboxLimits(cpu_s=10, wall_s=8.0, memory_bytes=64 << 20, threads=16)
QUIET = SandboxLimits(cpu_s=10, wall_s=0.3, log_bytes=10_000)


@dataclass(frozen=True)
class Attack:
    """One attempt and how it has to end.

    Args:
        name: says it in words, and is the test's name.
        ends: refused: an exception inside (exit code 1); dies: killed by the filter; runs: to its end, without an
            effect; crashes: by a signal of its own making, or of a limit's; fails: in whatever way this Python does.
        reason: the code of the reason in the report, if it is ended by a limit.
        finding: what the report says it tried, if it says so.
    """

    name: str
    family: Family
    source: str
    ends: End = "refused"
    reason: str = ""
    finding: str = ""
    limits: SandboxLimits = QUICK


def _files(name: str, source: str, ends: End = "refused") -> Attack:
    return Attack(name, "files", source, ends, finding="box_tried_files")


def _network(name: str, source: str, ends: End = "refused") -> Attack:
    return Attack(name, "network", "import socket\n" + source, ends, finding="box_tried_network")


def _kernel(name: str, source: str) -> Attack:
    return Attack(name, "the kernel", source + "; print('LEAK')", "dies", "box_forbidden")


FILES = (
    _files("reads a secret", "print('LEAK', open(world['secret']).read())"),
    _files("reads the password file", "print('LEAK', open('/etc/passwd').read())"),
    _files("writes a file", "open(world['writable'], 'w').write('mine')"),
    _files(
        "appends by a descriptor",
        "import os; os.write(os.open(world['writable'], os.O_WRONLY | os.O_APPEND), b'x')",
    ),
    _files("makes a file", "open(world['folder'] + '/new', 'x').write('mine')"),
    _files("lists a folder", "import os; print('LEAK', os.listdir(world['folder']))"),
    _files("deletes a file", "import os; os.remove(world['writable'])"),
    _files("renames a file", "import os; os.rename(world['writable'], world['folder'] + '/other')"),
    _files("links to a file", "import os; os.link(world['writable'], world['folder'] + '/other')"),
    _files("links symbolically", "import os; os.symlink('/etc', world['folder'] + '/other')"),
    _files("makes a folder", "import os; os.mkdir(world['folder'] + '/other')"),
    Attack("makes a pipe with a name", "files", "import os; os.mkfifo(world['folder'] + '/other')"),
    _files("changes rights", "import os; os.chmod(world['writable'], 0o777)"),
    _files("cuts a file", "import os; os.truncate(world['writable'], 0)"),
    _files("changes times", "import os; os.utime(world['writable'], (0, 0))"),
    _files("makes a temporary file", "import tempfile; tempfile.NamedTemporaryFile()"),
    _files(
        "asks for the environment of its parent",
        "import os; print('LEAK', open(f'/proc/{os.getppid()}/environ', 'rb').read())",
    ),
    _files("reads its own descriptors", "import os; print('LEAK', os.listdir('/proc/self/fd'))"),
    _files("writes into memory by /proc", "open('/proc/self/mem', 'r+b')"),
    _files("opens the robot's serial port", "open('/dev/ttyS0', 'r+b')"),
    Attack("asks whether a file is there", "files", "import os; os.stat(world['secret']); print('LEAK')"),
    Attack(
        "opens by openat2",
        "files",
        "call('openat2', -100, world['secret'].encode(), bytes([0] * 24), 24); print('LEAK')",
    ),
    Attack(
        "opens by a raw open", "files", "call('openat', -100, world['secret'].encode(), 0, 0); print('LEAK')"
    ),
    Attack(
        "opens by a file handle",
        "files",
        "call('open_by_handle_at', -100, bytes(128), 0)",
        "dies",
        "box_forbidden",
    ),
    Attack("changes its folder", "files", "import os; os.chdir(world['folder']); print('LEAK')"),
    Attack("imports what is not loaded", "files", "import turtledemo; print('LEAK')"),
    Attack("sends a file without opening", "files", "import os; os.sendfile(1, 0, 0, 10); print('LEAK')"),
    Attack("watches files", "files", "call('inotify_init1', 0); print('LEAK')"),
)

NETWORK = (
    _network("connects over TCP", "socket.create_connection(('127.0.0.1', world['tcp'])).send(b'out')"),
    _network(
        "sends UDP",
        "socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'out', ('127.0.0.1', world['udp']))",
    ),
    _network(
        "speaks DDS to the robot",
        """
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 1)
packet = b'RTPS\\x02\\x03\\x01\\x10' + bytes(12)
s.sendto(packet, ('239.255.0.1', 7400))
s.sendto(packet, ('127.0.0.1', world['udp']))
""",
    ),
    _network("listens on TCP", "s = socket.socket(); s.bind(('127.0.0.1', 0)); s.listen(); print('LEAK')"),
    _network(
        "speaks IPv6",
        "socket.socket(socket.AF_INET6, socket.SOCK_DGRAM).sendto(b'out', ('::1', world['udp']))",
    ),
    Attack(
        "connects to a unix socket",
        "network",
        "import socket; socket.socket(socket.AF_UNIX).connect(world['unix'])",
    ),
    Attack(
        "sends to a unix datagram socket",
        "network",
        "import socket; socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).sendto(b'out', world['unix_datagram'])",
    ),
    Attack(
        "connects to an abstract socket",
        "network",
        "import socket; socket.socket(socket.AF_UNIX).connect(world['abstract'])",
    ),
    _network("speaks netlink", "socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, 0); print('LEAK')"),
    _network("sends raw packets", "socket.socket(socket.AF_PACKET, socket.SOCK_RAW, 0x300); print('LEAK')"),
    _network("sends ICMP", "socket.socket(socket.AF_INET, socket.SOCK_RAW, 1); print('LEAK')"),
    _network("speaks to the hypervisor", "socket.socket(socket.AF_VSOCK, socket.SOCK_STREAM); print('LEAK')"),
    _network("speaks CAN to a motor", "socket.socket(socket.AF_CAN, socket.SOCK_RAW, 1); print('LEAK')"),
    _network(
        "uses the kernel's ciphers", "socket.socket(socket.AF_ALG, socket.SOCK_SEQPACKET); print('LEAK')"
    ),
    _network("asks for a name", "socket.getaddrinfo('example.org', 80); print('LEAK')"),
    _network(
        "fetches a page",
        "import urllib.request; urllib.request.urlopen(f\"http://127.0.0.1:{world['tcp']}/\", timeout=1)",
    ),
    Attack("makes a socket by a raw call", "network", "call('socket', 2, 2, 0); print('LEAK')"),
    Attack(
        "makes datagram pairs",
        "network",
        "import socket; socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)",
    ),
    _network(
        "addresses somebody from a stream pair",
        "a, b = socket.socketpair(); a.sendto(b'out', world['unix_datagram'])",
    ),
    Attack("connects the channel elsewhere", "network", "channel.connect(world['unix'])"),
    Attack("sends a descriptor out", "network", "import socket; socket.send_fds(channel, [b'x'], [1])"),
    Attack("takes a descriptor in", "network", "import socket; socket.recv_fds(channel, 1, 1)"),
    Attack("asks for a handle on its host", "network", "print('LEAK', channel.getsockopt(1, 77))"),
    Attack("sends out of band", "network", "import socket; channel.send(b'x', socket.MSG_OOB)"),
)

PROCESSES = (
    Attack("forks", "processes", "import os; os.fork() and print('LEAK')", finding="box_tried_processes"),
    Attack(
        "forks like a bomb",
        "processes",
        """
import os
while True:
    try:
        os.fork()
    except PermissionError:
        refused = globals().get('refused', 0) + 1
        if refused > 1000: raise
""",
        finding="box_tried_processes",
    ),
    Attack(
        "runs a shell",
        "processes",
        "import subprocess; subprocess.run(['/bin/sh', '-c', 'echo out > ' + world['writable']])",
        finding="box_tried_processes",
    ),
    Attack(
        "runs a shell by system",
        "processes",
        "import os; print(os.system('echo out > ' + world['writable']))",
        "runs",
        finding="box_tried_processes",
    ),
    Attack(
        "becomes another program",
        "processes",
        "import os; os.execv('/bin/sh', ['sh', '-c', 'echo out'])",
        finding="box_tried_processes",
    ),
    Attack(
        "spawns",
        "processes",
        "import os; os.posix_spawn('/bin/true', ['true'], {})",
        finding="box_tried_processes",
    ),
    Attack(
        "starts a process pool",
        "processes",
        "import multiprocessing; multiprocessing.Process(target=print).start()",
    ),
    Attack("clones without thread flags", "processes", "call('clone', 17, 0, 0, 0, 0); print('LEAK')"),
    Attack(
        "clones into a namespace of users",
        "processes",
        "call('clone', 0x10000000 | 17, 0, 0, 0, 0); print('LEAK')",
    ),
    Attack("clones by clone3", "processes", "call('clone3', bytes(88), 88); print('LEAK')"),
    Attack("makes a terminal", "processes", "import pty; pty.openpty(); print('LEAK')"),
)

SIGNALS = (
    Attack(
        "kills a process of the same user",
        "signals",
        "import os; os.kill(world['victim'], 9)",
        finding="box_tried_signals",
    ),
    Attack(
        "kills the warm server",
        "signals",
        "import os; os.kill(os.getppid() or 1, 9)",
        finding="box_tried_signals",
    ),
    Attack("kills its host", "signals", "import os; os.kill(world['host'], 9)", finding="box_tried_signals"),
    Attack(
        "kills everybody", "signals", "import os; os.kill(-1, 0); print('LEAK')", finding="box_tried_signals"
    ),
    Attack("kills its process group", "signals", "import os; os.killpg(0, 9)", finding="box_tried_signals"),
    Attack("signals a thread of another", "signals", "call('tgkill', world['victim'], world['victim'], 9)"),
    Attack("signals by tkill", "signals", "call('tkill', world['victim'], 9)"),
    Attack(
        "queues a signal",
        "signals",
        "call('rt_sigqueueinfo', world['victim'], 9, bytes(128))",
        "dies",
        "box_forbidden",
    ),
    Attack(
        "signals by a process descriptor",
        "signals",
        "call('pidfd_send_signal', 5, 9, 0, 0)",
        "dies",
        "box_forbidden",
    ),
    Attack("opens a process descriptor", "signals", "call('pidfd_open', world['victim'], 0); print('LEAK')"),
    Attack(
        "lets the kernel signal for it",
        "signals",
        """
import fcntl
fcntl.fcntl(channel.fileno(), fcntl.F_SETOWN, world['victim'])
""",
    ),
    Attack("outlives its parent", "signals", "call('prctl', 1, 0, 0, 0, 0); print('LEAK')"),
    Attack("lets itself be looked into", "signals", "call('prctl', 4, 1, 0, 0, 0); print('LEAK')"),
    Attack(
        "goes before the governor",
        "signals",
        "import os; os.setpriority(os.PRIO_PROCESS, 0, -20); print('LEAK')",
    ),
    Attack(
        "becomes a real-time process",
        "signals",
        "import os; os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(50)); print('LEAK')",
    ),
    Attack(
        "slows the host down",
        "signals",
        "import os; os.setpriority(os.PRIO_PROCESS, world['victim'], 19); print('LEAK')",
    ),
)

MEMORY_OF_OTHERS = (
    Attack(
        "traces another process",
        "memory of others",
        "call('ptrace', 16, world['victim'], 0, 0); print('LEAK')",
        "dies",
        "box_forbidden",
    ),
    Attack(
        "reads another's memory",
        "memory of others",
        "call('process_vm_readv', world['victim'], 0, 0, 0, 0, 0)",
        "dies",
        "box_forbidden",
    ),
    Attack(
        "writes another's memory",
        "memory of others",
        "call('process_vm_writev', world['victim'], 0, 0, 0, 0, 0)",
        "dies",
        "box_forbidden",
    ),
    Attack(
        "steals a descriptor", "memory of others", "call('pidfd_getfd', 5, 3, 0)", "dies", "box_forbidden"
    ),
    Attack(
        "changes another's limits",
        "memory of others",
        "import resource; resource.prlimit(world['victim'], resource.RLIMIT_NOFILE, (1, 1))",
    ),
    Attack(
        "raises its own limits",
        "memory of others",
        "import resource; resource.setrlimit(resource.RLIMIT_CPU, (-1, -1))",
    ),
)

SHARED_MEMORY = (
    Attack(
        "makes shared memory",
        "shared memory",
        "from multiprocessing.shared_memory import SharedMemory; SharedMemory(world['shm'], create=True, size=99)",
    ),
    Attack("writes in /dev/shm", "shared memory", "open('/dev/shm/' + world['shm'], 'w').write('out')"),
    Attack("makes a file in memory", "shared memory", "import os; os.memfd_create('x'); print('LEAK')"),
    Attack(
        "makes System V memory",
        "shared memory",
        "call('shmctl', call('shmget', 0, 4096, 0o600), 0, 0); print('LEAK')",
        "dies",
        "box_forbidden",
    ),
    Attack(
        "makes a message queue",
        "shared memory",
        "call('mq_open', b'x', 0o102, 0o666, 0)",
        "dies",
        "box_forbidden",
    ),
    Attack(
        "makes a semaphore",
        "shared memory",
        "import multiprocessing; multiprocessing.Semaphore(1); print('LEAK')",
    ),
)

KERNEL = (
    _kernel("makes namespaces", "call('unshare', 0x10000000)"),
    _kernel("changes its root", "call('chroot', b'/')"),
    _kernel("mounts", "call('mount', b'none', b'/', b'tmpfs', 0, 0)"),
    _kernel("turns the root around", "call('pivot_root', b'.', b'.')"),
    _kernel("joins a namespace", "call('setns', 1, 0)"),
    _kernel("asks for keys", "call('keyctl', 0, -3, 0, 0, 0)"),
    _kernel("changes its personality", "call('personality', 0x0040000)"),
    _kernel("loads a kernel", "call('kexec_load', 0, 0, 0, 0)"),
    _kernel("loads a module", "call('init_module', 0, 0, b'')"),
    _kernel("loads a kernel program", "call('bpf', 0, bytes(64), 64)"),
    _kernel("counts events", "call('perf_event_open', bytes(128), 0, -1, -1, 0)"),
    _kernel("handles page faults", "call('userfaultfd', 0)"),
    _kernel("uses io_uring", "call('io_uring_setup', 1, bytes(120))"),
    _kernel("restarts the machine", "call('reboot', 0, 0, 0, 0)"),
    _kernel("sets the clock", "import time; time.clock_settime(time.CLOCK_REALTIME, time.time() + 0.001)"),
    _kernel("renames the machine", "import socket; socket.sethostname('mine')"),
    _kernel("puts a filter over the filter", "call('seccomp', 1, 0, bytes(16))"),
    _kernel("uses the other set of calls", "call('x32')"),
    Attack("becomes root", "the kernel", "import os; os.setuid(0); print('LEAK')"),
    Attack("takes groups", "the kernel", "import os; os.setgroups([0]); print('LEAK')"),
    Attack("calls what is not known yet", "the kernel", "call('unknown')"),
)

CODE = (
    Attack("maps memory to run", "machine code", "import mmap; mmap.mmap(-1, 4096, prot=7); print('LEAK')"),
    Attack(
        "makes memory runnable",
        "machine code",
        """
import ctypes, mmap
memory = mmap.mmap(-1, 4096)
address = ctypes.addressof(ctypes.c_char.from_buffer(memory))
call('mprotect', address, 4096, 7); print('LEAK')
""",
    ),
    Attack(
        "calls system in libc",
        "machine code",
        "import ctypes; ctypes.CDLL(None).system(('echo out > ' + world['writable']).encode())",
        "runs",
        finding="box_tried_native",
    ),
    Attack(
        "loads a library",
        "machine code",
        "import ctypes; ctypes.CDLL('libm.so.6'); ctypes.CDLL('libcrypt.so.1'); print('LEAK')",
    ),
    Attack(
        "looks at the environment of libc",
        "machine code",
        "import ctypes; e = ctypes.POINTER(ctypes.c_char_p).in_dll(ctypes.CDLL(None), 'environ')\n"
        "i = 0\nwhile e and e[i]: print(e[i]); i += 1",
        "runs",
    ),
    Attack(
        "writes to nowhere", "machine code", "import ctypes; ctypes.memset(0, 1, 1)", "crashes", "box_crashed"
    ),
    Attack(
        "unpickles a command",
        "machine code",
        """
import pickle
class Evil:
    def __reduce__(self):
        import os
        return os.system, ('echo out > ' + world['writable'],)
pickle.loads(pickle.dumps(Evil()))
""",
        "runs",
        finding="box_tried_processes",
    ),
)

USING_UP = (
    Attack(
        "takes all memory",
        "using it up",
        "x = []\nwhile True: x.append(bytearray(1 << 20))",
        reason="box_used_too_much_memory",
        finding="box_tried_memory",
        limits=SMALL,
    ),
    Attack(
        "reserves a gigabyte",
        "using it up",
        "import mmap; mmap.mmap(-1, 1 << 30); print('LEAK')",
        limits=SMALL,
    ),
    Attack(
        "takes all memory at once",
        "using it up",
        "bytearray(1 << 40)",
        reason="box_used_too_much_memory",
        limits=SMALL,
    ),
    Attack(
        "takes memory that is shared",
        "using it up",
        "import mmap\nx = []\nwhile True: x.append(mmap.mmap(-1, 1 << 20))",
        limits=SMALL,
    ),
    Attack(
        "starts threads without end",
        "using it up",
        "import threading, time\nwhile True: threading.Thread(target=time.sleep, args=(9,), daemon=True).start()",
        limits=SMALL,
    ),
    Attack(
        "loops without end", "using it up", "while True: pass", "crashes", "box_lasted_too_long", limits=SHORT
    ),
    Attack(
        "loops and ignores all signals",
        "using it up",
        """
import signal
for each in range(1, 65):
    try: signal.signal(each, signal.SIG_IGN)
    except (OSError, ValueError): pass
while True: pass
""",
        "crashes",
        "box_lasted_too_long",
        limits=SHORT,
    ),
    Attack(
        "computes in C without end",
        "using it up",
        "9 ** 9 ** 9",
        "crashes",
        "box_lasted_too_long",
        limits=SHORT,
    ),
    Attack(
        "waits without end",
        "using it up",
        "import time; time.sleep(1e9)",
        "crashes",
        "box_lasted_too_long",
        limits=SHORT,
    ),
    Attack(
        "stops itself",
        "using it up",
        "import os, signal; os.kill(os.getpid(), signal.SIGSTOP)",
        "crashes",
        "box_lasted_too_long",
        limits=SHORT,
    ),
    Attack("calls itself without end", "using it up", "def f(): f()\nf()"),
    Attack(
        "calls itself until it breaks",
        "using it up",
        """
import sys
sys.setrecursionlimit(10**9)
class A:
    def __repr__(self): return repr([self])
repr(A())
""",
        "fails",
        limits=SMALL,
    ),
    Attack(
        "floods its output",
        "using it up",
        "while True: print('x' * 1000)",
        "crashes",
        "box_lasted_too_long",
        limits=QUIET,
    ),
    Attack(
        "floods its errors",
        "using it up",
        "import os\nwhile True: os.write(2, b'\\xff' * 65536)",
        "crashes",
        "box_lasted_too_long",
        limits=QUIET,
    ),
    Attack(
        "floods its channel",
        "using it up",
        "while True: channel.sendall(b'x' * 65536)",
        "crashes",
        "box_lasted_too_long",
        limits=SHORT,
    ),
    Attack("opens pipes without end", "using it up", "import os\nwhile True: os.pipe()"),
    Attack(
        "leaves a thread behind",
        "using it up",
        "import threading\ndef f():\n  while True: pass\nthreading.Thread(target=f).start()",
        "crashes",
        "box_lasted_too_long",
        limits=SHORT,
    ),
    Attack(
        "fills the disk",
        "using it up",
        "import os\nwhile True: os.write(os.open(world['folder'] + '/big', os.O_CREAT | os.O_WRONLY), bytes(1 << 20))",
    ),
)

THE_BOX = (
    Attack(
        "looks for secrets in the environment", "the box itself", "import os; print(dict(os.environ))", "runs"
    ),
    Attack(
        "looks for the server's objects",
        "the box itself",
        """
import gc, socket, sys
gc.unfreeze()
frame = sys._getframe()
while frame: last, frame = frame, frame.f_back
for each in [*gc.get_objects(), *last.f_locals.values()]:
    if isinstance(each, socket.socket) and each.fileno() > 3: print('LEAK', each)
    if type(each).__name__ == 'Server': each._host.sendall(b'out'); print('LEAK')
""",
        "refused",
    ),
    Attack(
        "writes to every descriptor",
        "the box itself",
        """
import os
for each in range(4, 4096):
    try: os.write(each, b'out')
    except OSError: continue
    print('LEAK', each)
""",
        "runs",
    ),
    Attack(
        "forges the report of its end",
        "the box itself",
        """
import json, os, struct
text = json.dumps({'event': 'ended', 'exit_code': 0, 'signal': None}).encode()
for each in range(0, 4096):
    try: os.write(each, struct.pack('=II', len(text), 0) + text)
    except OSError: pass
os._exit(3)
""",
        "refused",
    ),
    Attack("closes all descriptors", "the box itself", "import os; os.closerange(0, 4096)", "runs"),
    Attack(
        "scribbles over the notes about it",
        "the box itself",
        """
import mmap, sys
frame = sys._getframe()
while frame:
    for each in list(frame.f_locals.values()):
        page = getattr(each, 'page', None)
        if isinstance(page, mmap.mmap) and not page.closed: page[:] = b'\\xff' * len(page)
    frame = frame.f_back
""",
        "runs",
    ),
    Attack(
        "commands the terminal it is shown on",
        "the box itself",
        "print('\\x1b]52;c;bWluZQ==\\x07\\x1b[2J\\u202e')",
        "runs",
    ),
    Attack("leaves without a word", "the box itself", "import os; os._exit(7)", "refused"),
    Attack(
        "raises in its last function",
        "the box itself",
        "import atexit; atexit.register(lambda: 1 / 0)",
        "runs",
    ),
    Attack(
        "prints nonsense",
        "the box itself",
        "import os; os.write(1, bytes(range(256))); print('\\ud800')",
        "runs",
    ),
    Attack(
        "breaks the library under itself",
        "the box itself",
        "import builtins, sys, os\nsys.modules.clear()\nbuiltins.__dict__.clear()\n",
        "refused",
    ),
    Attack("throws nonsense to unwind the server", "the box itself", "raise BaseException('up')", "refused"),
    Attack(
        "interrupts itself",
        "the box itself",
        "import os, signal; os.kill(os.getpid(), signal.SIGINT)\nimport time; time.sleep(1)",
    ),
)

ATTACKS = (
    *FILES, *NETWORK, *PROCESSES, *SIGNALS, *MEMORY_OF_OTHERS, *SHARED_MEMORY, *KERNEL, *CODE, *USING_UP, *THE_BOX,
)  # fmt: skip
