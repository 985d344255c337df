"""The host's end of the warm server: start it once, launch programs in milliseconds, see which walls stand."""

from __future__ import annotations

import os
import queue
import socket
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

from chatrobot.core.errors import SandboxError
from chatrobot.core.reason import Reason
from chatrobot.sandbox.libc import pidfd_open
from chatrobot.sandbox.limits import Layers, SandboxLimits, receive_message, send_message
from chatrobot.sandbox.process import SandboxedProcess
from chatrobot.sandbox.walls import bubblewrap_command, find_bubblewrap

_START = (
    "import sys; sys.path.append(sys.argv[1]); from chatrobot.sandbox.server import main; "
    "main(*map(int, sys.argv[2:]))"
)
_ROOT = str(Path(__file__).parents[2])
LAUNCH_TIMEOUT_S = 2.0


class WarmServer:
    """A clean interpreter that has imported everything and forks a sandboxed child for each program.

    It runs in a session of its own with an empty environment and no descriptor but its line; it and all its children
    die with the process that started it, and its children with it.

    Args:
        path: folders whose modules go before the standard library's, such as an `rclpy` of ours.
        preload: modules to import; entry functions are in one of them. Many of the standard library are, anyway.
        limits: of each program, unless `launch` gets others.
        layers: walls wanted beside the sound minimum; by default all that stand here.
        has_library: False leaves the standard library unloaded, for whoever only wants to know what stands.
    """

    def __init__(
        self,
        path: Sequence[Path] = (),
        preload: Sequence[str] = (),
        limits: SandboxLimits | None = None,
        layers: Layers | None = None,
        *,
        has_library: bool = True,
    ) -> None:
        self._path = [str(folder) for folder in path]
        self._preload = list(preload)
        self._limits = limits or SandboxLimits()
        self._layers = layers or Layers()
        self._has_library = has_library
        self._lock = threading.Lock()
        self._line: socket.socket | None = None
        self.process: subprocess.Popen[bytes] | None = None
        self.problems: Mapping[str, str] = {}

    def start(self, timeout_s: float = 10.0) -> None:
        """Start the process and wait until it has imported everything and built its walls.

        Raises:
            SandboxError: it does not start, or the sound minimum cannot be had here; `reason` says which.
        """
        self.close()
        said = self._begin(timeout_s, is_wrapped=False)
        if said["event"] == "wrap":
            said = self._begin(timeout_s, is_wrapped=True)
            if said["event"] != "ready":
                self._layers = replace(self._layers, bubblewrap=False)
                said = self._begin(timeout_s, is_wrapped=False)
        layers = said.get("layers")
        self.problems = {str(k): str(v) for k, v in layers.items()} if isinstance(layers, dict) else {}
        if said["event"] == "ready":
            return
        self.close()
        if said["event"] == "refused":
            raise SandboxError(Reason("box_not_possible", {"missing": self.problems["seccomp"]}))
        raise SandboxError(Reason("box_does_not_start", {"problem": str(said["problem"])}))

    def launch(
        self, entry: str, payload: bytes = b"", limits: SandboxLimits | None = None
    ) -> SandboxedProcess:
        """Fork a child, shut it in, and let it call `function(channel, payload)`.

        Args:
            entry: "module:function" of a preloaded module.
            payload: anything; the function gets it as it is.
            limits: instead of the server's.

        Raises:
            SandboxError: the server is not running, or cannot fork.
        """
        limits = limits or self._limits
        channel, their_channel = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        report, their_report = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        log, their_log = os.pipe()
        process = SandboxedProcess(channel, log, report, limits)
        said = {"entry": entry, "limits": asdict(limits)}
        problem = "the warm server is not running"
        try:
            with self._lock:
                if self._line is not None:
                    given = (their_channel.fileno(), their_log, their_report.fileno())
                    send_message(self._line, said, payload, given)
                    problem = ""
        except OSError as error:
            problem = str(error)
            self._hang_up()
        finally:
            their_channel.close()
            their_report.close()
            os.close(their_log)
        problem = problem or process.wait_until_started(LAUNCH_TIMEOUT_S)
        if problem:
            process.close()
            raise SandboxError(Reason("box_does_not_start", {"problem": problem}))
        return process

    def is_running(self) -> bool:
        """Tell whether its process is there."""
        return self.process is not None and self.process.poll() is None

    def close(self) -> None:
        """End it and all its children."""
        self._hang_up()
        if self.process is not None:
            self.process.kill()
            self.process.wait()

    def _hang_up(self) -> None:
        """The server ends when its line does. After half a message there is no other way."""
        line, self._line = self._line, None
        if line is not None:
            line.close()

    def __enter__(self) -> WarmServer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _begin(self, timeout_s: float, *, is_wrapped: bool) -> Mapping[str, object]:
        """Start the process. Returns its first word, or one of ours where it says none."""
        line, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        alive, ours = _life_line()
        flags = ["-B"] if sys.flags.dont_write_bytecode else []
        given = [theirs.fileno(), *alive]
        words = [sys.executable, "-I", "-S", *flags, "-c", _START, _ROOT, *map(str, given)]
        wrap = find_bubblewrap() if self._layers.bubblewrap else None
        if is_wrapped and wrap is not None:
            words = bubblewrap_command(wrap, [_ROOT, *self._path, *_site_folders()]) + words
        with theirs:
            self.process = _spawn(words, given)
        for each in ours:
            os.close(each)
        setup = {
            "path": self._path,
            "behind": _site_folders(),
            "has_library": self._has_library,
            "preload": self._preload,
            "layers": asdict(self._layers),
            "tasks": _tasks_of_this_user(),
            "is_wrapped": is_wrapped,
            "can_wrap": wrap is not None,
        }
        line.settimeout(timeout_s)
        try:
            send_message(line, setup)
            said, _, _ = receive_message(line)
        except (EOFError, OSError) as error:
            said = {"event": "failed", "problem": str(error) or "it ended at once"}
        line.settimeout(LAUNCH_TIMEOUT_S)
        if said["event"] == "ready":
            self._line = line
        else:
            line.close()
            self.close()
        return said


def _life_line() -> tuple[list[int], list[int]]:
    """A descriptor that becomes readable when this process ends. Returns what to give, and what to close then."""
    try:
        pidfd = pidfd_open(os.getpid())
    except OSError:
        return [], []
    return [pidfd], [pidfd]


def _spawn(words: list[str], given: list[int]) -> subprocess.Popen[bytes]:
    """Start it on a thread that lives as long as it does: "my parent's death" means that thread's."""
    started: queue.SimpleQueue[subprocess.Popen[bytes] | OSError] = queue.SimpleQueue()

    def stay() -> None:
        try:
            process = subprocess.Popen(
                words,
                pass_fds=given,
                env=_clean_environment(),
                cwd="/",
                start_new_session=True,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        except OSError as error:
            started.put(error)
            return
        started.put(process)
        process.wait()

    threading.Thread(target=stay, name="sandbox server", daemon=True).start()
    process = started.get()
    if isinstance(process, OSError):
        raise SandboxError(Reason("box_does_not_start", {"problem": str(process)})) from process
    return process


def _clean_environment() -> dict[str, str]:
    """Nothing of the host's, but where its libraries are and what time it is here."""
    environment = {
        "LANG": "C.UTF-8",
        "HOME": "/",
        "TZ": os.environ.get("TZ") or ":/etc/localtime",
        # One thread until a program makes some: a process with several cannot be forked well.
        **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
        # Each arena would reserve 64 MB of the address space that is the limit of memory.
        "MALLOC_ARENA_MAX": "2",
    }
    if libraries := os.environ.get("LD_LIBRARY_PATH"):
        environment["LD_LIBRARY_PATH"] = libraries
    return environment


def _site_folders() -> list[str]:
    """Return where installed packages are: `-S` leaves them out, and a program may want numpy."""
    folders = [each for each in sys.path if each.rstrip("/").endswith(("site-packages", "dist-packages"))]
    numpy = find_spec("numpy")
    if numpy is not None and numpy.origin is not None:
        folders.append(str(Path(numpy.origin).parents[1]))
    return list(dict.fromkeys(folders))


def _tasks_of_this_user() -> int:
    """Return how many tasks this user has now, all processes and threads."""
    user, tasks = os.geteuid(), 0
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                if folder.stat().st_uid == user:
                    tasks += (folder / "task").stat().st_nlink - 2
            except OSError:
                continue
    return tasks


Level = Literal["none", "minimum", "good", "full"]


@dataclass(frozen=True)
class SandboxReport:
    """The walls that stand here.

    Args:
        problems: for each layer that was tried why it does not stand, or "" where it does.
        refusal: why no program runs here at all, or None.
    """

    problems: Mapping[str, str]
    refusal: Reason | None

    @property
    def standing(self) -> tuple[str, ...]:
        """The layers that stand."""
        return tuple(layer for layer, problem in self.problems.items() if not problem)

    @property
    def level(self) -> Level:
        """minimum: filter, limits and a clean environment; good: Landlock or namespaces too; full: both."""
        if self.refusal is not None:
            return "none"
        levels: tuple[Level, ...] = ("minimum", "good", "full")
        has_world = "namespaces" in self.standing or "bubblewrap" in self.standing
        return levels[("landlock" in self.standing) + has_world]


def probe(layers: Layers | None = None) -> SandboxReport:
    """Start a warm server without any modules, see what stands, and end it again (0.1 s)."""
    refusal = None
    with WarmServer(layers=layers, has_library=False) as server:
        try:
            server.start()
        except SandboxError as error:
            refusal = error.reason
        return SandboxReport(server.problems, refusal)
