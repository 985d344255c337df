"""Where a sandboxed process begins: it puts names, time and output in place, runs the program and tells its end."""

from __future__ import annotations

import ast
import atexit
import builtins
import io
import linecache
import os
import socket
import sys
import threading
import traceback
from types import CodeType, ModuleType
from typing import Any, NoReturn

from chatrobot.programs.inside import event_loop, top_level, virtual_time
from chatrobot.programs.inside.link import Link, open_link
from chatrobot.programs.settings import ProgramSettings


def run(channel: socket.socket, payload: bytes) -> None:
    """Run the program of `payload` (`ProgramSettings`) on `channel`. Does not return."""
    settings = ProgramSettings.from_bytes(payload)
    link = open_link(channel, settings)
    if link.scheduler is not None:
        virtual_time.install(link.scheduler, settings.start_ns)
    top_level.install()
    event_loop.install()
    sys.stdout, sys.stderr = _PipeStream(link, "stdout"), _PipeStream(link, "stderr")
    sys.stdin = io.StringIO("")
    threading.excepthook = _tell_of_thread
    link.send("ready")
    _end(link, *_run(settings))


def _run(settings: ProgramSettings) -> tuple[str, int, BaseException | None]:
    """How the program ended: how, its exit code, and what it raised."""
    file_name = f"{settings.name}.py"
    linecache.cache[file_name] = (len(settings.source), None, settings.source.splitlines(True), file_name)
    module = ModuleType("__main__")
    module.__dict__.update(__file__=file_name, __builtins__=builtins)
    sys.modules["__main__"] = module
    sys.argv = [file_name, *settings.args]
    atexit._clear()
    try:
        exec(_compiled(settings.source, file_name), module.__dict__)
    except SystemExit as end:
        return "exit", _exit_code(end), None
    except BaseException as error:  # noqa: BLE001 - whatever a program raises ends it, and is reported
        return "raised", 1, error
    return "returned", 0, None


def _compiled(source: str, file_name: str) -> CodeType:
    """A program that only defines `main`, for an entry point of its package, has it called as that would."""
    tree = ast.parse(source, file_name)
    names = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    passive = (
        ast.Import,
        ast.ImportFrom,
        ast.FunctionDef,
        ast.AsyncFunctionDef,
        ast.ClassDef,
        ast.Assign,
        ast.AnnAssign,
    )
    if "main" in names and all(
        isinstance(node, passive) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant))
        for node in tree.body
    ):
        tree.body += ast.parse("main()").body
    return compile(tree, file_name, "exec")


def _tell_of_thread(args: threading.ExceptHookArgs) -> None:
    """A thread that raises is over, and the program goes on."""
    if args.exc_value is not None and args.exc_type is not SystemExit:
        name = args.thread.name if args.thread is not None else "?"
        print(f"Exception in thread {name}:\n{complaint(args.exc_value)[2]}", file=sys.stderr, end="")


def _exit_code(end: SystemExit) -> int:
    """As the interpreter has it: None is 0, a text goes to stderr and is 1."""
    if end.code is None:
        return 0
    if isinstance(end.code, int):
        return end.code & 0xFF
    print(end.code, file=sys.stderr)
    return 1


def _end(link: Link, how: str, code: int, error: BaseException | None) -> NoReturn:
    """Tell what became of it, once its threads are over, as the interpreter would wait for them."""
    told = complaint(error) if error is not None else None
    for at_exit in reversed(threading._threading_atexits):  # type: ignore[attr-defined]
        at_exit()
    for thread in threading.enumerate():
        if thread is not threading.current_thread() and not thread.daemon:
            thread.join()
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    if told is not None:
        link.send("raised", *told)
    else:
        link.send("ended", how, code)
    link.flush()
    os._exit(code)


LONGEST_TEXT = 8 * 1024


def complaint(error: BaseException) -> tuple[str, str, str, int]:
    """Return (type, message, traceback, the program's line or 0). Opens no file for the lines of others."""
    told = traceback.TracebackException.from_exception(error, lookup_lines=False)
    line = _line(told)
    _keep_own_frames(told)
    kind = type(error)
    name = (
        kind.__qualname__
        if kind.__module__ in ("builtins", "__main__")
        else f"{kind.__module__}.{kind.__qualname__}"
    )
    return name[:200], _text(error)[:LONGEST_TEXT], "".join(told.format())[-LONGEST_TEXT:], line


def _text(error: BaseException) -> str:
    try:
        return str(error)
    except Exception:  # noqa: BLE001 - its class is the program's, and may do anything
        return ""


def _is_own(file_name: str) -> bool:
    """The program's source is where `linecache` was given it."""
    return file_name in linecache.cache and file_name == getattr(sys.modules["__main__"], "__file__", None)


def _line(told: traceback.TracebackException) -> int:
    lines = [frame.lineno or 0 for frame in told.stack if _is_own(frame.filename)]
    if lines:
        return lines[-1]
    return int(getattr(told, "lineno", None) or 0)


def _keep_own_frames(told: traceback.TracebackException | None) -> None:
    depth = 0
    while told is not None and depth < 10:
        told.stack[:] = [frame for frame in told.stack if _is_own(frame.filename)]
        told = told.__cause__ or told.__context__
        depth += 1


class _PipeStream(io.TextIOBase):
    """Stands for `sys.stdout` or `sys.stderr`."""

    encoding = "utf-8"
    errors = "replace"

    def __init__(self, link: Link, name: str) -> None:
        self.name = name
        self._link = link
        self._line = ""
        self.buffer = _Bytes(self)

    def writable(self) -> bool:
        return True

    def write(self, text: str) -> int:
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        *lines, self._line = (self._line + text).split("\n")
        for line in lines:
            self._link.output(self.name, line)
        return len(text)

    def flush(self) -> None:
        if self._line:
            line, self._line = self._line, ""
            self._link.output(self.name, line)


class _Bytes(io.RawIOBase):
    def __init__(self, text: _PipeStream) -> None:
        self._text = text

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        self._text.write(bytes(data).decode(errors="replace"))
        return len(data)


def _warm_up() -> None:
    """Have all imported that a traceback needs when it is shown: in the sandbox it is too late."""
    try:
        sum([1, "2"])  # type: ignore[list-item]
    except TypeError:
        traceback.format_exc()


_warm_up()
