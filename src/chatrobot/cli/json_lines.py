"""How commands print a session's events on standard output, which may break; JSON, one object a line, in UTF-8."""

from __future__ import annotations

import argparse
import errno
import os
import select
import sys
from typing import Any, Protocol

from chatrobot.core.event import strict_json
from chatrobot.core.events import Event
from chatrobot.language.interpretation import LanguageCode

_NOT_SHOWN = frozenset({"telemetry", "scan", "finished"})
"""`result` says the same as `finished`; who wants to follow a motion reads `progress`."""


class JsonPrinter:
    """A `Printer` for programs."""

    def __init__(self, output: Output) -> None:
        self._output = output

    @property
    def is_broken(self) -> bool:
        """Nobody reads what is written."""
        return self._output.is_broken

    def turn(self, text: str) -> None:
        """Nothing: every event carries the number of its turn."""

    def show(self, event: Event, language: LanguageCode) -> None:  # noqa: ARG002
        """Print an event, unless it is for ourselves."""
        if event.name not in _NOT_SHOWN:
            self._output.write(json_line(event.to_json()))


def json_line(data: dict[str, Any]) -> str:
    """Write one line of strict JSON."""
    return strict_json(data) + "\n"


STDOUT = 1


class Output:
    """Standard output, each piece at once. It never raises: a robot must not run on because a pipe broke."""

    def __init__(self) -> None:
        self._broken = False
        self._poll = select.poll()
        self._poll.register(STDOUT, 0)

    def write(self, text: str) -> None:
        """Write all of `text`, or note that nobody reads."""
        if self._broken:
            return
        data = memoryview(text.encode("utf-8", errors="replace"))
        try:
            while data:
                data = data[os.write(STDOUT, data) :]
        except OSError as error:
            self._broken = True
            if error.errno != errno.EPIPE:
                print(f"chatrobot: standard output: {error.strerror}, so this ends here", file=sys.stderr)

    @property
    def is_broken(self) -> bool:
        """A reader that has left shows before anything more is written to it."""
        if not self._broken:
            self._broken = any(state & (select.POLLERR | select.POLLNVAL) for _, state in self._poll.poll(0))
        return self._broken


class Printer(Protocol):
    """Shows events as they come."""

    @property
    def is_broken(self) -> bool:
        """Nobody reads what is written."""
        ...

    def turn(self, text: str) -> None:
        """Show that a turn of a dialogue begins with `text`."""
        ...

    def show(self, event: Event, language: LanguageCode) -> None:
        """Show an event, in the language of the question."""
        ...


def printer_for(args: argparse.Namespace) -> Printer:
    """For machines with `--json`, else for people."""
    sys.stdout.flush()
    if args.json:
        from chatrobot.cli.json_lines import JsonPrinter

        return JsonPrinter(Output())
    from chatrobot.cli.human import HumanPrinter

    return HumanPrinter(Output())
