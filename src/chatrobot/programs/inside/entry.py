"""Where a sandboxed process begins: it puts the names and the time in place, and runs the program."""

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
from types import CodeType, ModuleType
from typing import NoReturn

from chatrobot.programs.inside import event_loop, top_level, virtual_time
from chatrobot.programs.inside.complaint import complaint
from chatrobot.programs.inside.complaint import preload as preload_complaint
from chatrobot.programs.inside.link import set_link
from chatrobot.programs.inside.live_link import LiveLink
from chatrobot.programs.inside.output import PipeStream
from chatrobot.programs.inside.virtual_link import VirtualLink
from chatrobot.programs.settings import ProgramSettings

AnyLink = VirtualLink | LiveLink


def preload() -> None:
    """For the warm server, before it forks."""
    top_level.preload()
    preload_complaint()


def run(channel: socket.socket, payload: bytes) -> None:
    """Run the program of `payload` (`ProgramSettings`) on `channel`. Does not return."""
    settings = ProgramSettings.from_bytes(payload)
    link: AnyLink
    if settings.mode == "virtual":
        link = VirtualLink(channel, settings)
        virtual_time.install(link.scheduler, settings.start_ns)
    else:
        link = LiveLink(channel, settings)
        link.start()
    set_link(link)
    top_level.install()
    event_loop.install()
    sys.stdout, sys.stderr = PipeStream(link, "stdout"), PipeStream(link, "stderr")
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


def _end(link: AnyLink, how: str, code: int, error: BaseException | None) -> NoReturn:
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
