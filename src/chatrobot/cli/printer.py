"""How a command shows a session's events on standard output, and what becomes of it when nobody reads any more."""

from __future__ import annotations

import argparse
import os
import select
import sys
from typing import Protocol

from chatrobot.core.events import Event
from chatrobot.language.interpretation import LanguageCode

STDOUT = 1


class Printer(Protocol):
    """Shows events as they come."""

    @property
    def is_broken(self) -> bool:
        """Nobody reads what is written."""
        ...

    def turn(self, text: str) -> None:
        """A turn of a dialogue begins with `text`."""
        ...

    def show(self, event: Event, language: LanguageCode) -> None: ...


class Output:
    """Standard output, each piece at once. It never raises: a robot must not run on because a pipe broke."""

    def __init__(self) -> None:
        self._broken = False
        self._poll = select.poll()
        self._poll.register(STDOUT, 0)

    def write(self, text: str) -> None:
        if self._broken:
            return
        data = memoryview(text.encode("utf-8", errors="replace"))
        try:
            while data:
                data = data[os.write(STDOUT, data) :]
        except OSError:
            self._broken = True

    @property
    def is_broken(self) -> bool:
        """A reader that has left shows before anything more is written to it."""
        if not self._broken:
            self._broken = any(state & (select.POLLERR | select.POLLNVAL) for _, state in self._poll.poll(0))
        return self._broken

    @property
    def is_terminal(self) -> bool:
        return os.isatty(STDOUT)


def printer_for(args: argparse.Namespace) -> Printer:
    """For machines with `--json`, else for people."""
    sys.stdout.flush()
    if args.json:
        from chatrobot.cli.json_lines import JsonPrinter

        return JsonPrinter(Output())
    from chatrobot.cli.human import HumanPrinter

    return HumanPrinter(Output())
