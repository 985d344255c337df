"""The `chatrobot` command. Nothing is imported before it is known to be needed: start-up time counts."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Sequence

FAILED, USAGE, STOPPED = 1, 2, 5

_MODULES = {
    "": "talk",
    "eval": "eval.command",
    "lesson": "lesson.command",
    "model": "model.command",
    "fake-model": "fake_model",
    "report": "report.command",
}
"""The module of a command, if not that of its name; its function is `run(args)`."""
_LISTS = ("robots", "worlds", "usage", "schema")
"""Commands that are functions of `lists`."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code. The outermost handler: what breaks is told in a sentence.

    `CHATROBOT_DEBUG=1` lets the traceback through.
    """
    arguments = sys.argv[1:] if arguments is None else arguments
    _mend_streams()
    try:
        return _run(arguments)
    except KeyboardInterrupt:
        return STOPPED
    except BrokenPipeError:
        forget_stdout()
        return STOPPED
    except Exception as error:  # the outermost boundary
        if os.environ.get("CHATROBOT_DEBUG"):
            raise
        from chatrobot.core.errors import InputError
        from chatrobot.core.reason import printable

        print(f"chatrobot: {printable(_sentence(error))}", file=sys.stderr)
        return USAGE if isinstance(error, InputError) else FAILED


def _mend_streams() -> None:
    """Open a stream that was closed (`>&-`) as empty, before a socket gets its number; no locale is an error."""
    for number, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
        if getattr(sys, name) is None:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free: this one
            setattr(sys, name, os.fdopen(number, mode))
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def forget_stdout() -> None:
    """Whoever read us has left; Python would complain once more when it flushes at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def _run(arguments: Sequence[str]) -> int:
    if [word.casefold() for word in arguments] == ["stop"]:  # ahead of everything else: 60 ms from cold
        from chatrobot.cli import stop

        return stop.run()
    if list(arguments[:3]) == ["completion", "words", "--"]:  # half a command line follows: nothing to parse
        from chatrobot.cli import completion

        return completion.print_words(arguments[3:])
    from importlib import import_module

    from chatrobot.cli.arguments import parse

    args = parse(arguments)
    from chatrobot.cli.early import started_early

    with started_early(args):
        is_list = args.command in _LISTS
        name = "lists" if is_list else _MODULES.get(args.command, args.command)
        code: int = getattr(import_module(f"chatrobot.cli.{name}"), args.command if is_list else "run")(args)
    return code


def _sentence(error: Exception) -> str:
    from chatrobot.core.errors import ChatRobotError

    reason = getattr(error, "reason", None)
    if isinstance(error, ChatRobotError):
        if reason is None:
            return str(error)
        from chatrobot.language.phrases import render_reason

        return render_reason(reason, "en")
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return f"unexpected error: {type(error).__name__}: {error} (set CHATROBOT_DEBUG=1 to see where)"
