"""The slash commands: name, what it takes, and the function, each in this one place. Help texts are in the tables."""

from __future__ import annotations

import difflib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rich.text import Text

from chatrobot.cli.console import tables
from chatrobot.cli.console.limits import read_limits
from chatrobot.cli.console.maps import big_map
from chatrobot.cli.console.talk import Talk
from chatrobot.cli.plan_file import read_plan_file
from chatrobot.core.errors import UsageError


@dataclass(frozen=True)
class Command:
    """`at_once` ones run where the line was typed; the others where the session is pumped, as they read it.

    One that takes nothing does nothing where more was typed: that meant something else. Only a stop is a stop all
    the same (`heeds_the_rest` is False).
    """

    name: str
    act: Callable[[Talk, str], None]
    takes: str = ""
    at_once: bool = False
    heeds_the_rest: bool = True

    @property
    def typed(self) -> str:
        """As a person types it, with what it takes."""
        return f"/{self.name} {self.takes}".strip()

    @property
    def help_code(self) -> str:
        return f"command_{self.name.replace('-', '_')}"


def run(talk: Talk, line: str) -> None:
    """Do the command in `line`, which begins with a slash; an unknown one gets the nearest name."""
    word, _, argument = line[1:].strip().partition(" ")
    command = BY_NAME.get(word.casefold())
    if command is None:
        _unknown(talk, word)
    elif argument.strip() and not command.takes and command.heeds_the_rest:
        talk.tell("takes_nothing", command=command.typed)
    elif command.at_once:
        command.act(talk, argument.strip())
    else:
        talk.pump.post(lambda: command.act(talk, argument.strip()))


def nearest(word: str) -> str:
    """The command that was most likely meant; empty where none is near."""
    near = difflib.get_close_matches(word.casefold(), BY_NAME, n=1, cutoff=0.5)
    return near[0] if near else ""


def _unknown(talk: Talk, word: str) -> None:
    near = nearest(word)
    if near:
        talk.tell("nearest_command", command=f"/{word}", nearest=f"/{near}")
    else:
        talk.face.print(
            Text("  ").append(talk.words.say("no_such_command", command=f"/{word}")).append(" ")
            .append(talk.words.say("all_commands"))
        )  # fmt: skip


def _help(talk: Talk, _: str) -> None:
    shown = [(command.typed, command.help_code) for command in COMMANDS]
    talk.face.print(tables.help_table(talk.words, talk.connection.world, shown))


def _robot(talk: Talk, _: str) -> None:
    talk.face.print(*tables.robot_tables(talk.words, talk.connection.profile))


def _world(talk: Talk, _: str) -> None:
    talk.face.print(
        big_map(talk.ride, talk.connection.world, talk.face.width),
        tables.world_table(talk.words, talk.connection.world),
    )


def _places(talk: Talk, _: str) -> None:
    remembered = talk.session.understanding.places.all()
    talk.face.print(tables.places_table(talk.words, talk.connection.world, remembered))


def _undo(talk: Talk, _: str) -> None:
    talk.attempt(lambda: talk.session.say(talk.words.say("undo_words")))


def _plan(talk: Talk, _: str) -> None:
    if not talk.ride.plan_text:
        talk.tell("no_plan")
        return
    talk.face.print(*talk.narrator.plan(talk.ride.plan_text, talk.ride.rehearsed))


def _save_plan(talk: Talk, argument: str) -> None:
    if not argument or not talk.ride.plan_text:
        talk.tell("no_plan" if argument else "save_which")
        return
    path = Path(argument).expanduser()
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(f"{talk.ride.plan_text}\n")
    except OSError as error:
        talk.tell("save_failed", problem=f"{path}: {error.strerror}")
        return
    talk.tell("saved", file=path)


def _run_plan(talk: Talk, argument: str) -> None:
    if not argument:
        talk.tell("run_which")
        return
    try:
        talk.say_plan(read_plan_file(argument))
    except UsageError as error:
        talk.tell("run_failed", problem=error)


def _program(talk: Talk, argument: str) -> None:
    """A new program, or without words the list of those that are kept."""
    if argument:
        talk.attempt(lambda: talk.session.say_program(argument))
        return
    names = talk.session.authoring.library.names() if talk.session.authoring is not None else ()
    talk.tell("programs_kept", names=", ".join(names)) if names else talk.tell("no_programs_kept")


def _map(talk: Talk, argument: str) -> None:
    if not talk.ride.is_measured:  # nobody knows where on it the robot is
        talk.tell("not_measured")
        return
    if argument.casefold() in ("big", "大"):
        talk.face.print(big_map(talk.ride, talk.connection.world, talk.face.width))
        return
    if argument:
        talk.tell("no_such_map", size=argument)
        return
    talk.strip.shows_map = not talk.strip.shows_map
    talk.tell("map_on" if talk.strip.shows_map else "map_off")


def _stop(talk: Talk, _: str) -> None:
    talk.stop("/stop")


def _estop(talk: Talk, _: str) -> None:
    talk.emergency_stop("/estop")
    talk.tell("estop_done")


def _release(talk: Talk, _: str) -> None:
    talk.release()  # Motion says whether it is


def _limit(talk: Talk, argument: str) -> None:
    limits = read_limits(argument)
    if limits is None:
        talk.tell("limit_unclear", argument=argument)
    else:
        talk.attempt(lambda: talk.session.limit(**limits))  # Motion says what holds then


def _quit(talk: Talk, _: str) -> None:
    talk.leave()


COMMANDS = (
    Command("help", _help),
    Command("robot", _robot),
    Command("world", _world),
    Command("places", _places),
    Command("plan", _plan),
    Command("save-plan", _save_plan, takes="FILE"),
    Command("run-plan", _run_plan, takes="FILE"),
    Command("program", _program, takes="[TEXT]"),
    Command("undo", _undo),
    Command("map", _map, takes="[big]"),
    Command("limit", _limit, takes="[200 m] [20 min] [none]"),
    Command("stop", _stop, at_once=True, heeds_the_rest=False),
    Command("estop", _estop, at_once=True, heeds_the_rest=False),
    Command("release", _release, at_once=True),
    Command("quit", _quit, at_once=True),
)
BY_NAME = {command.name: command for command in COMMANDS}
