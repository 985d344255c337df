"""What may stand on the command line: the commands, what each takes, and how it is read.

Imports argparse alone: `chatrobot --help` must be there at once.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence

from chatrobot import __version__
from chatrobot.cli.families import PROGRAM_ACTIONS, WORLD_ACTIONS, actions_of, all_known, no_such_command
from chatrobot.cli.options import Once, Parser, add_defaults, add_options, joined, port, positive
from chatrobot.cli.options import argument as _add
from chatrobot.core.errors import UsageError
from chatrobot.options import NO_ODOMETRY, OF_NODES, OPTIONS
from chatrobot.programs.ros_args import split_ros_args

COMMANDS = {
    "do": "one instruction, or a dialogue turn by turn, then exit",
    "plan": "understand and rehearse only; nothing moves",
    "stop": "stop whatever you run on this machine",
    "lesson": "tasks for a simulated robot, checked by what it really did",
    "eval": "run a corpus of sayings and count correct, wrong and abstained",
    "calibrate": "one metre and one turn: you measure, your profile gets the correction",
    "doctor": "what works here, and how to get the rest",
    "robots": "the robots that there is a profile for",
    "world": "worlds for the simulated robot: list, draw, check, new",
    "worlds": "the same as world list",
    "program": "programs that move the robot: new, list, show, run, edit, rename, remove, export",
    "schema": "the JSON schema of plans",
    "sim": "run the simulated robot alone, for other programs to drive",
    "mcp": "an MCP server: a language agent's client drives the robot",
    "node": "one of the tutorial's three nodes: input, base or control",
    "model": "set up, list and test language models",
    "usage": "what language models have used and cost",
    "fake-model": "a scripted stand-in for a language model, for tests and demonstrations",
    "report": "a recording as a page: ways told and measured, speeds, what happened; or SVG, PNG, GIF, CSV",
    "web": "a page in your browser: chat, map, plan, stick and stop",
    "record": "record a robot that others drive, until Ctrl-C",
    "replay": "show a recording again, at any speed; no robot moves",
    "completion": "what makes Tab complete in bash, zsh or fish",
}
SHELLS = ("bash", "zsh", "fish")
LANGUAGES = ("en", "zh", "de")
_NODES = ("node", "sim")
_TALKS = ("", "do", "plan")
"""A conversation takes `--ros-args -p revChatGPT:=True` as the tutorial's base node does."""

_DESCRIPTION = "Say it, and a robot does exactly that, safely. Without a command: talk to it."
_EPILOG = """\
examples:
  chatrobot                                        talk to the simulated robot
  chatrobot do "forward 1 m, then turn left"       one instruction, in real time
  chatrobot do "draw a square" --fast              the same as fast as the machine goes
  printf 'forward 1 m\\nturn left\\n' | chatrobot    a line is a turn; all are done, quit ends them

exit codes: 0 completed or answered, 1 failed, 2 usage, 3 unclear, 4 refused, 5 stopped; of several turns that of
the last one, with --keep-going that of the first that was not done
"""


_CALIBRATE = """\
The robot drives one metre, then turns once. You measure how far it really went, with a tape and by a mark on the floor,
and the correction is saved in your copy of its profile, in the folder "robots" of the configuration folder. It holds
from the next start on. Answer y to begin a motion, skip to leave it out, anything else to leave; type stop or press
Ctrl-C to stop the robot. Give it two metres of free floor. A simulated robot is measured by the simulation.

exit codes: 0 saved, taken back, or nothing measured; 1 the measure or the robot is not right; 5 left or stopped
"""

_COMPLETION = """\
bash:  echo 'eval "$(chatrobot completion bash)"' >> ~/.bashrc
zsh:   echo 'eval "$(chatrobot completion zsh)"' >> ~/.zshrc       (after compinit)
fish:  chatrobot completion fish > ~/.config/fish/completions/chatrobot.fish"""

_PART_OF_SPEECH = re.compile(
    r"[-+]?\d*[.,]?\d+|c?m|mm|s|deg|degrees?|met(?:er|re)s?|seconds?|an?|the|to|at|by|for|of|and|then"
)
"""What nobody says alone."""


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Read the options and the `command` ("" for none).

    Raises:
        UsageError: what is wrong, and what is allowed.
    """
    arguments, program_args = _split_program_args(arguments)
    arguments, ros_args = split_ros_args(joined(arguments))
    word = _first_word(arguments)
    if word is not None and word not in COMMANDS:
        raise no_such_command(word, COMMANDS, arguments)
    parsed = all_known(*commands_parser().parse_known_args(list(arguments)))
    parsed.program_args, parsed.ros_args = program_args, ros_args
    _check_texts(parsed)
    _check_ros_args(parsed)
    if program_args and (parsed.command, getattr(parsed, "action", "")) != ("program", "run"):
        raise UsageError(
            "only a program that is run takes arguments after --", allowed="chatrobot program run …"
        )
    parsed.names_robot = hasattr(parsed, "robot")
    if not parsed.names_robot and getattr(parsed, "open_loop", False):
        parsed.robot = NO_ODOMETRY
    add_defaults(parsed, (*OPTIONS, *OF_NODES) if parsed.command == "node" else OPTIONS)
    return parsed


def _check_texts(parsed: argparse.Namespace) -> None:
    if parsed.command == "plan":
        _expect_words([parsed.text], "plan")
    elif parsed.command == "do":
        if not (parsed.texts or parsed.plan):
            raise UsageError(
                "do has no text", allowed='TEXT or --plan FILE, such as: chatrobot do "forward 1 m"'
            )
        _expect_words(parsed.texts, "do")
        _expect_quotes(parsed.texts)


def _check_ros_args(parsed: argparse.Namespace) -> None:
    are_parameters = all(word == "-p" for word in parsed.ros_args[::2])
    may_have_them = parsed.command in _NODES or (parsed.command in _TALKS and are_parameters)
    if parsed.ros_args and not may_have_them:
        allowed = "chatrobot node … or chatrobot sim … --on ros"
        if parsed.command == "program":
            allowed = "for a program, behind --: chatrobot program run NAME -- --ros-args -p NAME:=VALUE"
        raise UsageError("--ros-args is for nodes", allowed=allowed)


def _expect_words(texts: Sequence[str], command: str) -> None:
    """Refuse an empty text, which would be asked of a language model.

    Raises:
        UsageError: one of them has nothing in it that could be read.
    """
    if not all(any(sign.isprintable() and not sign.isspace() for sign in text) for text in texts):
        raise UsageError("a text is empty", allowed=f'say what to do: chatrobot {command} "forward 1 m"')


def _expect_quotes(texts: Sequence[str]) -> None:
    """`do forward 1 m` would be three turns, and `m` alone drives.

    Raises:
        UsageError: these are the words of one sentence, and not the turns of a dialogue.
    """
    are_words = len(texts) > 2 and all(text.isascii() and not re.search(r"\s", text) for text in texts)
    if are_words and any(_PART_OF_SPEECH.fullmatch(text.casefold()) for text in texts):
        raise UsageError(
            f"{len(texts)} words without quotes are {len(texts)} turns",
            allowed=f'chatrobot do "{" ".join(texts)}"',
        )


def _split_program_args(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return the arguments before the first `--`, and those behind it, which `program` hands on to a program."""
    if "--" not in arguments or _first_word(arguments) != "program":
        return list(arguments), []
    at = list(arguments).index("--")
    return list(arguments[:at]), list(arguments[at + 1 :])


def _first_word(arguments: Sequence[str]) -> str | None:
    """Return the first argument that is neither an option nor the value of one."""
    takes_value = {option.flag for option in OPTIONS if option.takes_value}
    rest = iter(arguments)
    for argument in rest:
        if argument in takes_value:
            next(rest, None)
        elif not argument.startswith("-"):
            return argument
    return None


def commands_parser() -> Parser:
    """Make the parser of the whole command line."""
    parser = Parser(
        prog="chatrobot", usage="%(prog)s [options] [COMMAND …]", description=_DESCRIPTION, epilog=_EPILOG
    )
    parser.add_argument("-V", "--version", action="version", version=f"chatrobot {__version__}")
    add_options(parser, "")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", title="commands", prog="chatrobot")
    for name, text in COMMANDS.items():
        command = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
        if name in _ARGUMENTS:
            _ARGUMENTS[name](command)
        add_options(command, name)
    return parser


def _do(parser: argparse.ArgumentParser) -> None:
    _add(parser, "texts", nargs="*", metavar="TEXT", help="what to do; several are turns of one dialogue")
    drive = "drive a saved plan, text or JSON (- for standard input), rehearsed anew; texts are the turns after it"
    _add(parser, "--plan", "files", action=Once, metavar="FILE", help=drive)
    keep = "do the rest, too, after a turn that was refused, stopped or failed; the exit code is then"
    keep = f"{keep} that of the first of these; a stop from somebody ends all of it"
    _add(parser, "--keep-going", action="store_true", help=keep)


def _plan(parser: argparse.ArgumentParser) -> None:
    _add(parser, "text", metavar="TEXT", help="what the robot would have to do")
    _add(parser, "--explain", action="store_true", help="say how it was read, and what is the next likeliest")
    _add(parser, "--png", "files .png", metavar="FILE", help="draw the way it would take into a picture")


def _eval(parser: argparse.ArgumentParser) -> None:
    _add(parser, "files", "files .yaml .yml", nargs="+", metavar="FILE", help="a corpus in YAML")
    _add(parser, "--only", choices=("odd", "even"), help="only the items whose running number is so")
    _add(parser, "--misses", action="store_true", help="list what was wrong and what was asked back")


def _lesson(parser: argparse.ArgumentParser) -> None:
    name = "a lesson, or a sheet of your own; without it the lessons are listed"
    _add(parser, "lesson", "lessons", nargs="?", default="", metavar="FILE|NAME", help=name)
    lines = (
        "do the lines of a file (- for standard input) without a person, in simulated time; 0 where they pass"
    )
    _add(parser, "--check", "files", default="", metavar="FILE", help=lines)
    _add(parser, "--solutions", action="store_true", help="print what passes, as --check reads it")
    tests = "try the sheet: each of its solutions has to pass, each of its mistakes must not"
    _add(parser, "--test", action="store_true", help=tests)
    parser.epilog = "exit codes: 0 passed, right or listed; 1 not; 2 usage, or a sheet that cannot be used"


def _calibrate(parser: argparse.ArgumentParser) -> None:
    parser.description = _CALIBRATE
    _add(parser, "--reset", action="store_true", help="take the saved correction back; nothing moves")


def _sim(parser: argparse.ArgumentParser) -> None:
    where = "where its wire is served (default: the runtime folder)"
    _add(parser, "--socket", "files", metavar="PATH", help=where)
    _ros_args(parser)


def _node(parser: argparse.ArgumentParser) -> None:
    nodes = "input: typed → user_input; base: user_input → chatgpt_node; control: chatgpt_node → cmd_vel"
    _add(parser, "which", choices=("input", "base", "control"), metavar="input|base|control", help=nodes)
    _ros_args(parser)


def _model(parser: argparse.ArgumentParser) -> None:
    actions = "setup: with questions (the default); list: what there is; test: try one sentence; use: keep a choice;"
    choices = ("setup", "list", "test", "use", "key")
    key = f"{actions} key: put a provider's key into the keyring"
    _add(parser, "action", nargs="?", default="setup", choices=choices, metavar="|".join(choices), help=key)
    none = "use none: keep that no model is used"
    _add(parser, "name", "models", nargs="?", default="", metavar="PROVIDER[:NAME]", help=none)
    _add(parser, "--delete", action="store_true", help="key: take it out of the keyring")


def _mcp(parser: argparse.ArgumentParser) -> None:
    _add(parser, "--http", action="store_true", help="over HTTP; without it over standard input and output")
    where = "with --http: where to listen (default: 127.0.0.1)"
    _add(parser, "--host", default=None, metavar="H", help=where)
    free = "with --http: the port (default: the first free one from 8765 on)"
    _add(parser, "--port", type=port, default=None, metavar="N", help=free)
    made = "with --http: what a client has to show (default: one is made and printed)"
    _add(parser, "--token", default=None, metavar="T", help=made)


def _usage(parser: argparse.ArgumentParser) -> None:
    _add(parser, "--by", choices=("session", "model", "day"), default="session", help="what to add up")


def _fake_model(parser: argparse.ArgumentParser) -> None:
    answers = "what it answers: docs/models.md has the form"
    _add(parser, "script", "files .yaml .yml", metavar="SCRIPT.yaml", help=answers)
    _add(parser, "--port", type=port, default=8399, help="0: any that is free (default: 8399)")
    _add(parser, "--host", default="127.0.0.1", help="where to listen; beyond loopback a token is asked for")


def _web(parser: argparse.ArgumentParser) -> None:
    where = "where to listen (default: 127.0.0.1, this machine alone); elsewhere a token is asked for"
    _add(parser, "--host", default="127.0.0.1", help=where)
    free = "the port of the page; 0: any that is free (default: 8080, or the next that is free)"
    _add(parser, "--port", type=port, default=None, help=free)
    token = "what the link has to bring that may steer (default: a new one where one is needed)"
    _add(parser, "--token", default="", help=token)
    pupils = "a class: so many pupils, 2 to 30, each with a simulated robot of their own; prints the teacher's link"
    _add(parser, "--class", dest="pupils", type=int, default=None, metavar="N", help=pupils)
    lesson = "a lesson, or a sheet of your own: the page, or each pupil's, shows its tasks and judges what was done"
    _add(parser, "--lesson", "lessons", default="", metavar="FILE|NAME", help=lesson)
    _add(parser, "--no-open", action="store_true", help="do not open the page in a browser")
    _add(parser, "--tls-cert", "files", default="", metavar="FILE", help="a certificate in PEM: speak HTTPS")
    _add(parser, "--tls-key", "files", default="", metavar="FILE", help="its key in PEM")


def _record(parser: argparse.ArgumentParser) -> None:
    new = "the new file (default: one in the recordings folder)"
    _add(parser, "file", "files .mcap", nargs="?", default="", metavar="FILE.mcap", help=new)


def _replay(parser: argparse.ArgumentParser) -> None:
    _add(parser, "file", "files .mcap", metavar="FILE.mcap", help="a recording")
    _add(parser, "--speed", type=positive, default=1.0, metavar="X", help="times as fast (default: 1)")


def _report(parser: argparse.ArgumentParser) -> None:
    _add(parser, "file", "files .mcap", metavar="FILE", help="the recording, an .mcap file")
    kinds = {
        "html": "a page that needs nothing else (the default: FILE.html beside the recording)",
        "svg": "one figure: map and speeds",
        "png": "the same as pixels",
        "gif": "an animation of the drive",
        "csv": "poses and commands, a row a message",
    }
    for kind, text in kinds.items():
        _add(
            parser, f"--{kind}", f"files .{kind}", nargs="?", const="", default=None, metavar="OUT", help=text
        )
    _add(parser, "--language", choices=LANGUAGES, default="", help="its language (default: the recording's)")


def _completion(parser: argparse.ArgumentParser) -> None:
    shells = "|".join(SHELLS)
    _add(parser, "shell", choices=SHELLS, metavar=shells, help="the shell whose script is printed")
    parser.epilog = _COMPLETION


def _world(parser: argparse.ArgumentParser) -> None:
    for _ in actions_of(parser, "world", WORLD_ACTIONS):
        pass


def _program(parser: argparse.ArgumentParser) -> None:
    for name, action in actions_of(parser, "program", PROGRAM_ACTIONS):
        if name == "run":
            action.usage = f"{action.prog} [options] NAME [-- ARGS]"
            action.epilog = "ARGS are the program's own: -- --ros-args -p speed:=0.35 -r velocity:=/cmd_vel"
        if name == "new":
            _add(action, "--name", dest="called", default="", metavar="NAME", help="what to call it")
        if name == "edit":
            source = "take this source, ask no editor"
            _add(action, "--file", "files .py", default="", metavar="FILE.py", help=source)


def _ros_args(parser: argparse.ArgumentParser) -> None:
    """For the help text alone: `split_ros_args` has taken them."""
    taken = "with --on ros what every ROS node takes: -p NAME:=VALUE, -r FROM:=TO, --params-file FILE"
    _add(parser, "--ros-args", nargs=argparse.REMAINDER, metavar="…", help=taken)


_ARGUMENTS = {
    "do": _do, "plan": _plan, "eval": _eval, "lesson": _lesson, "calibrate": _calibrate, "sim": _sim, "node": _node,
    "mcp": _mcp, "model": _model, "usage": _usage, "fake-model": _fake_model, "program": _program,
    "completion": _completion, "web": _web, "world": _world,
    "record": _record, "replay": _replay, "report": _report,
}  # fmt: skip
