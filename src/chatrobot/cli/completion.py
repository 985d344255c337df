"""`chatrobot completion bash|zsh|fish`: the script that makes Tab complete, and what that script asks for.

The scripts in `shells` know no command of ours: at each Tab they run `chatrobot completion words -- WORDS`, with the
words up to the cursor, and offer its lines. A line is a word, or a word, a tab and what it means; `:files` and
`:folders` stand for what the shell itself completes; behind `:files` and a tab, how those files may end. So Tab
knows what this version takes, and the robots and programs of today.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from chatrobot.cli.arguments import commands_parser
from chatrobot.core.errors import ChatRobotError
from chatrobot.options import OPTIONS

_SHELLS = Path(__file__).with_name("shells")
_DASHES = "--"


class Offer(NamedTuple):
    """One thing that the word at the cursor may become."""

    word: str
    meaning: str = ""


FILES, FOLDERS = Offer(":files"), Offer(":folders")
PROFILES, WORLDS, PROGRAMS = Offer(":files", ".toml"), Offer(":files", ".yaml .yml"), Offer(":files", ".py")
_OF_THE_SHELL = (FILES.word, FOLDERS.word)


def run(args: argparse.Namespace) -> int:
    """Print the script for a shell. Always 0."""
    print((_SHELLS / f"chatrobot.{args.shell}").read_text(encoding="utf-8"), end="")
    return 0


def print_words(words: Sequence[str]) -> int:
    """Print what the last of `words` may become. Always 0: Tab has no place for a complaint."""
    try:
        for offer in offers_for(words):
            print("\t".join(offer).rstrip("\t").replace("\n", " "))
    except ChatRobotError:
        pass  # such as a settings folder that is a file: the command itself will say so
    return 0


def offers_for(words: Sequence[str]) -> list[Offer]:
    """List what the last of `words` may become; those before it are the command line up to there."""
    *before, current = words or [""]
    line = _Line(commands_parser())
    for word in before:
        line.take(word)
    if current.startswith("-") and "=" in current:  # --robot=turt: zsh and fish give it as one word
        option, _, value = current.partition("=")
        line.take(option)
        return [
            each if each.word in _OF_THE_SHELL else each._replace(word=f"{option}={each.word}")
            for each in _beginning(line.offers(), value)
        ]
    return _beginning(line.options() if current.startswith("-") else line.offers(), current)


def _beginning(offers: Iterator[Offer], current: str) -> list[Offer]:
    return [each for each in offers if each.word in _OF_THE_SHELL or each.word.startswith(current)]


class _Line:
    """The command line up to the cursor: which parser reads on, and the argument that the next word belongs to."""

    def __init__(self, parser: argparse.ArgumentParser) -> None:
        self._values = argparse.Namespace(**{option.name: option.default for option in OPTIONS})
        self._enter(parser)
        self._waits: argparse.Action | None = None
        self._is_behind_dashes = False

    def _enter(self, parser: argparse.ArgumentParser) -> None:
        self._options = {name: action for action in parser._actions for name in action.option_strings}
        self._arguments = [action for action in parser._actions if not action.option_strings]

    def take(self, word: str) -> None:
        """Take in a word that stands before the cursor."""
        if self._is_behind_dashes or word == _DASHES:
            self._is_behind_dashes = True
        elif word == "=":
            pass  # bash cuts --robot=turtlesim into three
        elif self._waits is not None:
            setattr(self._values, self._waits.dest, word)
            self._waits = None
        elif word in self._options:
            self._waits = self._options[word] if self._options[word].nargs is None else None
        elif not word.startswith("-") and self._arguments:
            self._take_argument(word)

    def _take_argument(self, word: str) -> None:
        argument = self._arguments[0]
        if isinstance(argument, argparse._SubParsersAction):
            self._arguments = []
            if word in argument.choices:
                self._enter(argument.choices[word])
        elif argument.nargs not in ("+", "*"):
            self._arguments.pop(0)

    def options(self) -> Iterator[Offer]:
        """Those that the help lists, each by its longest name."""
        if self._waits is not None or self._is_behind_dashes:
            return
        for action in dict.fromkeys(self._options.values()):
            if action.help != argparse.SUPPRESS:
                yield Offer(max(action.option_strings, key=len), action.help or "")

    def offers(self) -> Iterator[Offer]:
        """List what the option or the argument at the cursor may be."""
        if self._is_behind_dashes:
            yield FILES
        elif self._waits is not None:
            yield from self._values_of(self._waits)
        elif self._arguments:
            yield from self._values_of(self._arguments[0])

    def _values_of(self, action: argparse.Action) -> Iterator[Offer]:
        if isinstance(action, argparse._SubParsersAction):
            yield from (Offer(str(each.dest), each.help or "") for each in action._choices_actions)
        elif action.choices is not None:
            yield from (Offer(str(each)) for each in action.choices)
        else:
            named = getattr(action, "offers", ())
            if isinstance(named, tuple):
                yield from map(Offer, named)
            elif named.startswith("files"):
                yield FILES._replace(meaning=named.removeprefix("files").lstrip())
            else:
                yield from OFFERS[named](self._values)


def _robots(args: argparse.Namespace) -> Iterator[Offer]:
    from chatrobot.cli.lists import robot_titles

    yield PROFILES
    yield from (Offer(*each) for each in robot_titles(args))


def _worlds(_: argparse.Namespace) -> Iterator[Offer]:
    from chatrobot.sim.load import world_names

    yield WORLDS
    yield from map(Offer, world_names())


def _lessons(_: argparse.Namespace) -> Iterator[Offer]:
    from chatrobot.lessons.sheet import lesson_names

    yield WORLDS
    yield from map(Offer, lesson_names())


def _programs(args: argparse.Namespace) -> Iterator[Offer]:
    from chatrobot.cli.folders import config_folder
    from chatrobot.programs.library import Library

    yield from map(Offer, Library(config_folder(args)).names())


def _models(_: argparse.Namespace) -> Iterator[Offer]:
    from chatrobot.models.providers import providers

    yield from (Offer(f"{provider.name}:", provider.title) for provider in providers().values())


OFFERS: dict[str, Callable[[argparse.Namespace], Iterable[Offer]]] = {
    "robots": _robots,
    "worlds": _worlds,
    "lessons": _lessons,
    "programs": _programs,
    "programs or files": lambda args: (PROGRAMS, *_programs(args)),
    "models": _models,
    "folders": lambda _: (FOLDERS,),
}
"""What an argument's value is completed with, by the name that `options.offer` was given: one of these, `files`, or
`files` and how they may end."""
