"""How a command shows a session's events on standard output, and what becomes of it when nobody reads any more."""

from __future__ import annotations

import argparse
import sys
from typing import Protocol

from chatrobot.cli.json_lines import Output
from chatrobot.core.events import Event
from chatrobot.language.interpretation import LanguageCode


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


def printer_for(args: argparse.Namespace) -> Printer:
    """For machines with `--json`, else for people."""
    sys.stdout.flush()
    if args.json:
        from chatrobot.cli.json_lines import JsonPrinter

        return JsonPrinter(Output())
    from chatrobot.cli.human import HumanPrinter

    return HumanPrinter(Output())
