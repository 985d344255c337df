"""Commands that have actions, as `chatrobot program run NAME` has: what each action takes."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from chatrobot.cli.options import add_options, offer
from chatrobot.core.errors import UsageError
from chatrobot.options import OPTIONS

Actions = dict[str, tuple[str, dict[str, str]]]
"""The name of each action, what it does, and its arguments; one in brackets may be left out."""
_OFFERED = {
    ("", "NAME"): "programs", ("run", "NAME"): "programs or files", ("", "DIR"): "folders",
    ("", "FILE"): "files .yaml .yml", ("", "WORLD"): "worlds", ("", "OUT.svg|OUT.png"): "files .svg .png",
}  # fmt: skip
"""What Tab completes an argument of an action with."""
_A_WORLD = "a world by its name, a world file, or a map.yaml of ROS"
WORLD_ACTIONS: Actions = {
    "list": ("the worlds there are, with their places", {}),
    "draw": (
        "draw a world here, or as a picture",
        {"WORLD": _A_WORLD, "[OUT.svg|OUT.png]": "the picture to write"},
    ),
    "check": ("what is wrong with a world, in which line, and what is allowed", {"WORLD": _A_WORLD}),
    "new": ("write a world of your own to begin with, with comments", {"FILE": "a new .yaml file"}),
}
PROGRAM_ACTIONS: Actions = {
    "new": ("write a program, rehearse it, run it and keep it", {"TEXT": "what it is to do"}),
    "list": ("the programs that are kept", {}),
    "show": ("one program: its source, where it comes from, how it went", {"NAME": "which"}),
    "run": ("rehearse a program in today's world, and run it", {"NAME": "a kept program, or FILE.py"}),
    "edit": ("change a program's source in your editor", {"NAME": "which"}),
    "rename": ("give a program another name", {"NAME": "which", "TO": "its new name"}),
    "remove": ("forget a program", {"NAME": "which"}),
    "export": ("write a program as a ROS 2 workspace", {"NAME": "which", "DIR": "a new or empty folder"}),
}


def actions_of(
    parser: argparse.ArgumentParser, command: str, family: Actions
) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    """Add the actions of a command; what is added to one comes before its options."""
    added = parser.add_subparsers(
        dest="action", metavar="ACTION", required=False, title="actions", prog=f"chatrobot {command}"
    )
    for name, (text, takes) in family.items():
        action = added.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
        for argument, meaning in takes.items():
            shown = argument.strip("[]")
            offers = _OFFERED.get((name, shown), _OFFERED.get(("", shown), ""))
            how: dict[str, Any] = {"nargs": "?", "default": ""} if argument != shown else {}
            dest = shown.split("|")[0].split(".")[0].casefold()
            offer(action.add_argument(dest, metavar=shown, help=meaning, **how), offers)
        yield name, action
        add_options(action, f"{command} {name}")


_FAMILIES = {"world": WORLD_ACTIONS, "program": PROGRAM_ACTIONS}


_ROOT_FLAGS = {"--help", "--version", *(option.flag for option in OPTIONS)}


def no_such_command(word: str, commands: Iterable[str], arguments: Sequence[str]) -> UsageError:
    """Return the mistake of a word that is no command, with what may be meant."""
    from difflib import get_close_matches  # late: `--help` must be there at once

    flag = ["", *arguments][list(arguments).index(word)]
    if flag.startswith("--") and flag not in _ROOT_FLAGS:  # of some command, with the word as its value
        allowed = "an option of a command stands behind it, such as: chatrobot web --class 20"
        return UsageError(f"'chatrobot' does not take {flag} {word}", allowed=allowed)
    if near := get_close_matches(word.casefold(), commands, n=1):
        return UsageError(f"there is no command {word!r}", allowed=f"did you mean chatrobot {near[0]}?")
    said = f'commands: {", ".join(commands)}; to tell the robot something: chatrobot do "{word} …"'
    return UsageError(f"there is no command {word!r}", allowed=said)


def all_known(parsed: argparse.Namespace, unknown: Sequence[str]) -> argparse.Namespace:
    """Return what was read, with a command ("" for none), where nothing is left over and no action is missing.

    The texts of `do` may stand on both sides of its options: argparse leaves those behind them over.

    Raises:
        UsageError: with the help that tells more, or the actions.
    """
    if parsed.command == "do" and not any(word.startswith("-") and " " not in word for word in unknown):
        parsed.texts, unknown = [*parsed.texts, *unknown], ()
    if hasattr(parsed, "yes") and hasattr(parsed, "approve"):
        raise UsageError("either of both", where="--yes --approve", allowed="leave one out")
    parsed.command = parsed.command or ""
    said = " ".join(filter(None, ("chatrobot", parsed.command, getattr(parsed, "action", ""))))
    if unknown:
        from chatrobot.models.secret import scrub  # a key may have been typed where none belongs

        given = scrub(" ".join(unknown), None)
        raise UsageError(f"'{said}' does not take {given}", allowed=f"see {said} --help")
    if parsed.command in _FAMILIES and not parsed.action:
        raise UsageError(f"'{said}' needs an action", allowed=", ".join(_FAMILIES[parsed.command]))
    return parsed
