"""How argparse takes the options of `chatrobot.options`. Imports argparse alone: `--help` must be there at once."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NoReturn, TypeVar

from chatrobot.core.errors import UsageError
from chatrobot.options import COMMON, LIMITS, MODEL, OF_NODES, OPTIONS, SIMULATION, Option
from chatrobot.robots.profile import NONE, read_limit

Number = TypeVar("Number", int, float)
_FILE = re.compile(r"\S+\.[a-z]\w{1,4}")
_KINDS: dict[Any, str] = {int: "a whole number", float: "a number"}


class Parser(argparse.ArgumentParser):
    """Wrong usage leaves through `main` like every other mistake, not out of the middle of parsing."""

    def __init__(self, **how: Any) -> None:
        how.setdefault("formatter_class", _HelpText)
        super().__init__(**how, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        """Raise what argparse would print.

        Raises:
            UsageError: always.
        """
        from chatrobot.models.secret import scrub  # a key may have been typed where none belongs

        raise UsageError(scrub(message, None), allowed=f"see {self.prog} --help")


class _HelpText(argparse.RawDescriptionHelpFormatter):
    """Options are listed once, below: the line of usage has no room for them."""

    def add_usage(self, usage: str | None, actions: Any, groups: Any, prefix: str | None = None) -> None:
        if usage is None:
            self._prog += " [options]"
            actions, groups = [action for action in actions if not action.option_strings], []
        super().add_usage(usage, actions, groups, prefix)


def joined(arguments: Sequence[str]) -> list[str]:
    """Return them with `--record` and its file as one: without a file, what follows is no file but a text.

    Raises:
        UsageError: what follows is a file, but no recording.
    """
    found, rest = [], list(arguments)
    while rest and rest[0] != "--":
        word = rest.pop(0)
        if word == "--record":
            name = rest[0] if rest else ""
            if _FILE.fullmatch(name) and not name.endswith(".mcap"):
                raise UsageError(f"{name}: a recording's name ends in .mcap", allowed="--record FILE.mcap")
            word = f"--record={rest.pop(0) if name.endswith('.mcap') else ''}"
        found.append(word)
    return [*found, *rest]


def add_options(parser: argparse.ArgumentParser, command: str) -> None:
    """Have `parser` accept every option of `command`, and list those that it uses, group by group."""
    options = (*OPTIONS, *OF_NODES) if command == "node" else OPTIONS
    for title in (COMMON, SIMULATION, MODEL, LIMITS):
        group = parser if title == COMMON else parser.add_argument_group(title)
        for option in options:
            if option.group == title:
                _add(option, group, command)


def _add(option: Option, group: argparse._ActionsContainer, command: str) -> None:
    """Add an option, good before and after the command: hence no default here, the one would undo the other."""
    how: dict[str, Any] = {"dest": option.name, "default": argparse.SUPPRESS, "help": argparse.SUPPRESS}
    if command in option.commands:
        how["help"] = option.helps.get(command, option.help)
    if option.choices:
        how["choices"] = option.choices
    elif option.metavar:
        how |= {"metavar": option.metavar, "type": _READERS.get(option.kind, option.kind)}
    if option.is_repeated:
        how["action"] = "append"
    elif not option.takes_value:
        how["action"] = "store_true"
    offer(group.add_argument(option.flag, **how), option.offers)


def add_defaults(parsed: argparse.Namespace, options: Iterable[Option]) -> None:
    """Set what was not given on the command line."""
    for option in options:
        if not hasattr(parsed, option.name):
            setattr(parsed, option.name, option.default)


def argument(parser: argparse.ArgumentParser, name: str, offers: str = "", **how: Any) -> None:
    """Add an argument of a command of its own; `offers` as of `offer`."""
    offer(parser.add_argument(name, **how), offers or ())


class Once(argparse.Action):
    """Refuses a second value, where the first would be lost without a word."""

    def __call__(self, _: Any, namespace: argparse.Namespace, values: Any, option_string: Any = None) -> None:
        """Take the value.

        Raises:
            UsageError: there is one already.
        """
        if getattr(namespace, self.dest, None) is not None:
            raise UsageError(f"{option_string} is given twice", allowed=f"one {option_string} {self.metavar}")
        setattr(namespace, self.dest, values)


def offer(action: argparse.Action, offers: str | tuple[str, ...]) -> None:
    """Note what Tab completes the value of `action` with: see `Option`."""
    vars(action)["offers"] = offers


def port(text: str) -> int:
    """Read the number of a TCP port."""
    if not text.isdecimal() or int(text) > 65_535:
        raise argparse.ArgumentTypeError(f"{text!r} is not a port (0 to 65535)")
    return int(text)


def _limit(text: str) -> float:
    try:
        return read_limit(text if text == NONE else float(text))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is neither a number above zero nor {NONE}") from None


def _positive(kind: Callable[[str], Number]) -> Callable[[str], Number]:
    """Return a reader of numbers above zero."""

    def read(text: str) -> Number:
        try:
            value = kind(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not {_KINDS[kind]}") from None
        if not 0 < value < float("inf"):
            raise argparse.ArgumentTypeError(f"{text!r} is not above zero")
        return value

    return read


positive = _positive(float)
_READERS: dict[Any, Callable[[str], Any]] = {int: _positive(int), float: positive, "limit": _limit}
