"""Writes docs/cli.md and docs/events.md from the code: `python -m scripts.make_reference` (`make reference`).

Commands and options come from the parser, events from their dataclasses. Only what no code says, the meaning of a key,
stands in scripts/events.toml. tests/docs/test_reference.py fails when a page is stale.
"""

from __future__ import annotations

import argparse
import dataclasses
import sys
import types
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

from chatrobot import options
from chatrobot.cli import arguments, entry, families, json_lines
from chatrobot.cli.console.commands import COMMANDS
from chatrobot.core import events, sensed_events
from chatrobot.core.event import Event
from chatrobot.core.geometry import Pose, Twist
from chatrobot.language.data_files import load_table

ROOT = Path(__file__).resolve().parents[1]
MEANINGS = ROOT / "scripts" / "events.toml"
MADE = "<!-- Made by `python -m scripts.make_reference` from the code: do not edit. -->\n"
SETS = {"understanding": options.UNDERSTAND, "planning": options.PLAN, "driving": options.DRIVE}
"""Commands that take the same options, the larger set first."""
_GROUPS = {options.COMMON: "Common"}
UNITS = (
    ("_radps", "rad/s"), ("_mps", "m/s"), ("_rad", "rad"), ("_percent", "%"), ("_usd", "US dollars"), ("_m", "m"),
    ("_s", "s"),
)  # fmt: skip
KINDS = {
    "s": "string", "i": "integer", "n": "number", "b": "boolean", "l": "list", "o": "object",
    str: "string", int: "integer", float: "number", bool: "boolean",
    Pose: "pose", Twist: "twist", events.Reason: "reason", events.Proposal: "object", events.FindingSeen: "object",
}  # fmt: skip
VARIABLES = {
    "CHATROBOT_MODEL": "the language model, as `--model` (which goes before it)",
    "XDG_RUNTIME_DIR": "where running robots keep their sockets, beside `/run/user/UID` and `/tmp`: "
    "[who stops whom](troubleshooting.md#who-stops-whom)",
    "CHATROBOT_CONVERSATION": "with `openai-responses`: the conversation on the server to go on with",
    "CHATROBOT_PEERS": "with `--on dds`: addresses to look for robots at, where there is no multicast; comma between",
    "CHATROBOT_DEBUG": "any value: an unexpected error shows its traceback",
    "ROS_DOMAIN_ID, ROS_AUTOMATIC_DISCOVERY_RANGE": "as in ROS 2; with `--on dds` the range is LOCALHOST by default",
    "LC_ALL, LC_MESSAGES, LANG": "the language that the console begins in: English, Chinese or German",
    "NO_COLOR": "the console prints plain lines",
}

CLI_HEAD = f"""{MADE}
# Command line

    chatrobot [options] [COMMAND …]

Options may stand before or after the command. `chatrobot COMMAND --help` prints the same as this page.
"""
CODES_TAIL = (
    "Of several turns: that of the last; with `--keep-going` that of the first turn that was not done.\n"
)
EVENTS_HEAD = f"""{MADE}
# Events: `--json`

`--json` prints one JSON object a line, in UTF-8. `chatrobot --json` is a session that lasts: text in, a line a turn,
events out. At the [nodes](nodes.md) the same objects are on `chatrobot/events`, and `telemetry` on
`chatrobot/telemetry`. In [Python](python-api.md) they are objects with the same names.

* A turn: `interpreted`, `rehearsed`, `started`, `progress` …, `result`. `result` is its last event. A turn that moves
  nothing has no `started`; a plan that a model streams has `streamed` before `interpreted`.
* **Lines in** are texts, `{{"text": …}}` for a text with line breaks, or `{{"approve": true}}` (or false) for the plan
  that waits for a yes. A line that is JSON is never read as a text: `5`, `null`, `[]` and `"forward"` are of no known
  form, and `{{"text": "5"}}` says the first of them; `"stop"` stops all the same. A line of more than 65,536 bytes is
  answered as too long, and nothing of it is done.
* **Which line a result belongs to: `turn`.** It counts the lines with a text, from 1. These have no number: blank
  lines; `approve`; what is JSON of no known form (a `notice` of turn 0 tells); `quit` and `exit`, where they
  end the input. A list that comes with its heading (`Do as follows:`, `1. forward 1 m`) is one text with it.
* **Results may come out of the order of the lines**: what nobody understands is answered while a line before it still
  runs, and so is one too many of those that wait; a yes has its result before the plan that it starts.
* **A yes counts once its plan was shown**, with `rehearsed` and `needs_approval`. A line `yes` that came before is told
  so and approves nothing (but with `--fast`, where the line behind the plan's own answers it); an `approve` that came
  before is a `notice` (`nothing_asked`). Where the input has ended and nobody is left to say yes, the plan is refused
  (`notice`: `nobody_approves`).
* A number that is NaN or infinite is null. Keys may be added; none is renamed or removed.
* A **pose** is `{{x_m, y_m, yaw_rad}}` (m, rad), a **twist** `{{vx_mps, vy_mps, wz_radps}}` (m/s, rad/s), as odometry
  measures them: x forward, y left, counter-clockwise positive. A **reason** is `{{code, …}}`: a code, which stays from
  release to release, and its values with units in their names.
* “null: unmeasured” marks keys that are null where `measured` is false, for
  [a robot without odometry](robots.md#a-robot-without-odometry).
"""


def read_meanings() -> dict[str, Any]:
    """What scripts/events.toml says."""
    return tomllib.loads(MEANINGS.read_text(encoding="utf-8"))


# --- events ---


def event_types() -> list[type[Event]]:
    """The events of a session, in the order of the code."""
    modules = (events.__name__, sensed_events.__name__)
    kinds = [kind for kind in Event.__subclasses__() if kind.__module__ in modules]
    return sorted(kinds, key=lambda kind: modules.index(kind.__module__))


def keys_of(kind: type[Event]) -> list[str]:
    """The keys of its JSON but for `event`."""
    return [field.name for field in dataclasses.fields(kind)]


def events_page() -> str:
    """docs/events.md."""
    meanings = read_meanings()
    parts = [EVENTS_HEAD, "## Events of a session\n"]
    parts += [_event(kind, meanings) for kind in event_types()]
    parts.append(
        "## Objects of other commands\n\nThey have no `turn`. A key with “?” may be null or absent.\n"
    )
    parts += [_command_object(name, dict(about)) for name, about in meanings["commands"].items()]
    return "\n".join(parts)


def _event(kind: type[Event], meanings: Mapping[str, Any]) -> str:
    hints = get_type_hints(kind)
    own = meanings.get(kind.name, {})
    rows = []
    for key in keys_of(kind):
        if key == "turn":
            continue
        null = " (null: unmeasured)" if key in kind.unmeasured else ""
        rows.append(
            (f"`{key}`", _kind(hints[key]), unit(key), f"{own.get(key, meanings['every'].get(key))}{null}")
        )
    about = own.get("about") or (kind.__doc__ or "").strip().split("\n\n")[0].replace("\n    ", " ")
    where = "" if kind.name not in json_lines._NOT_SHOWN else " Not printed by `--json`; at the nodes only."
    text = f"### `{kind.name}`\n\n{about}{where}\n"
    return text if not rows else f"{text}\n{_table(('key', 'type', 'unit', 'meaning'), rows)}\n"


def _kind(hint: Any) -> str:
    """A type, as JSON has it."""
    if get_origin(hint) in (Union, types.UnionType):
        return " or ".join("null" if part is type(None) else _kind(part) for part in get_args(hint))
    if get_origin(hint) is Literal:
        return ", ".join(f"`{value}`" for value in get_args(hint))
    if get_origin(hint) is tuple:
        inside = get_args(hint)[0]
        return "list of lists" if get_origin(inside) is tuple else f"list of {_kind(inside)}"
    return KINDS[hint]


def unit(key: str) -> str:
    """The unit in the name of a key."""
    return next((name for ending, name in UNITS if key.endswith(ending)), "")


def _command_object(name: str, about: dict[str, Any]) -> str:
    command = about.pop("command")
    rows = [
        (f"`{key}`{'?' * kind.endswith('?')}", KINDS[kind[0]], text) for key, (kind, text) in about.items()
    ]
    return f"### `{name}`\n\n`{command}`\n\n{_table(('key', 'type', 'meaning'), rows)}\n"


# --- command line ---


FAMILIES = {"program": families.PROGRAM_ACTIONS, "world": families.WORLD_ACTIONS}


def cli_page() -> str:
    """docs/cli.md."""
    parser = arguments.commands_parser()
    codes = [(str(code), what) for code, what in _exit_codes()]
    found = dict(_commands(parser))
    overview = [(f"`chatrobot {name}`", text) for name, text in arguments.COMMANDS.items()]
    parts = [
        CLI_HEAD,
        "## Commands\n",
        _table(("command", "meaning"), [("`chatrobot`", "talk to the robot"), *overview]),
    ]
    parts += [""] + [section for name, child in found.items() if (section := _command(name, child))]
    for family, about in FAMILIES.items():
        rows = _actions(found[family], about)
        parts += [f"### `chatrobot {family}`\n", _table(("action", "meaning", "arguments"), rows), ""]
    parts += ["## Options\n", _legend()]
    for group in dict.fromkeys(option.group for option in options.OPTIONS):
        parts += [
            f"### {_GROUPS.get(group, group.capitalize())}\n",
            _table(("option", "meaning", "used by"), _options(group)),
            "",
        ]
    parts += ["## Exit codes\n", _table(("code", "meaning"), codes), "", CODES_TAIL]
    parts += ["## Environment\n", _table(("variable", "meaning"), _variables()), ""]
    texts = load_table("en", "console")
    typed = [(f"`{each.typed}`", str(texts[each.help_code])) for each in COMMANDS]
    parts += ["## Typed at the console\n", _table(("command", "meaning"), typed)]
    return "\n".join(parts) + "\n"


def _exit_codes() -> Iterator[tuple[int, str]]:
    by_code: dict[int, list[str]] = {entry.USAGE: ["wrong usage"]}
    for outcome, code in events.EXIT_CODES.items():
        by_code.setdefault(code, []).append(f"`{outcome}`")
    yield from ((code, ", ".join(what)) for code, what in sorted(by_code.items()))


def _commands(parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            yield from action.choices.items()


def _command(name: str, parser: argparse.ArgumentParser) -> str:
    """The arguments of its own; empty where there are none."""
    rows = [(_flag(action), str(action.help)) for action in _own(parser)]
    if not rows:
        return ""
    about = arguments.COMMANDS[name]
    description = (parser.description or "").strip()
    longer = "" if description.casefold() == f"{about}.".casefold() else f"{description}\n\n"
    return f"### `chatrobot {name}`\n\n{longer}{_table(('argument', 'meaning'), rows)}\n"


def _own(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    shared = {option.flag for option in options.OPTIONS}
    others = (argparse._HelpAction, argparse._SubParsersAction)
    return [
        action
        for action in parser._actions
        if not isinstance(action, others) and not shared.intersection(action.option_strings)
    ]


def _actions(command: argparse.ArgumentParser, about: families.Actions) -> Iterator[tuple[str, str, str]]:
    for name, parser in _commands(command):
        taken = [f"{_flag(action)}: {action.help}" for action in _own(parser)]
        yield f"`{name}`", about[name][0], "; ".join(taken)


def _placeholder(action: argparse.Action) -> str:
    shown = str(action.metavar or "|".join(map(str, action.choices or ())) or action.dest.upper())
    if action.nargs in ("?", "*"):
        return f"[{shown}{' …' if action.nargs == '*' else ''}]"
    return f"{shown} …" if action.nargs == "+" else shown


def _flag(action: argparse.Action) -> str:
    if not action.option_strings:
        return f"`{_placeholder(action)}`"
    value = (
        ""
        if action.nargs == 0
        else f" {action.metavar or '|'.join(action.choices or (action.dest.upper(),))}"
    )
    return f"`{action.option_strings[0]}{value}`"


def _options(group: str) -> Iterator[tuple[str, ...]]:
    for option in options.OPTIONS:
        if option.group == group:
            value = (
                " " + "|".join(option.choices)
                if option.choices
                else f" {option.metavar}" * bool(option.metavar)
            )
            others = (f"`{command}`: {text}" for command, text in option.helps.items() if command)
            yield (f"`{option.flag}{value}`", "; ".join((option.help, *others)), _where(option.commands))


def _where(commands: tuple[str, ...]) -> str:
    """The commands, those of a set by its name."""
    for title, members in SETS.items():
        if set(members) <= set(commands):
            rest = [command for command in commands if command not in members]
            return ", ".join([f"**{title}**", *rest])
    return ", ".join(command or "`chatrobot` alone" for command in commands)


def _legend() -> str:
    told: list[str] = []
    for title, members in reversed(SETS.items()):
        told.append(f"**{title}**: " + _where_of(members, told))
    return f"Every command takes every option; “used by” says where it matters. {'; '.join(told)}.\n"


def _where_of(members: tuple[str, ...], told: list[str]) -> str:
    smaller = list(SETS)[len(SETS) - len(told) :]
    parts = [f"**{smaller[0]}**"] if smaller else []
    known = SETS[smaller[0]] if smaller else ()
    return ", ".join(parts + [command or "`chatrobot` alone" for command in members if command not in known])


def _variables() -> Iterator[tuple[str, str]]:
    for names, text in VARIABLES.items():
        yield ", ".join(f"`{name}`" for name in names.split(", ")), text


def _table(head: Sequence[str], rows: Any) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


PAGES = {ROOT / "docs" / "cli.md": cli_page, ROOT / "docs" / "events.md": events_page}


if __name__ == "__main__":
    for file, write in PAGES.items():
        file.write_text(write(), encoding="utf-8")
