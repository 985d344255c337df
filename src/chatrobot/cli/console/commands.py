"""The slash commands: name, what it takes, and the function, each in this one place. Help texts are in the tables."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from rich.text import Text

from chatrobot.cli.console import tables
from chatrobot.cli.console.controller import ChatController
from chatrobot.cli.console.maps import big_map
from chatrobot.cli.plan_file import read_plan_file
from chatrobot.core.errors import UsageError
from chatrobot.robots.profile import NONE


@dataclass(frozen=True)
class Command:
    """`at_once` ones run where the line was typed; the others where the session is pumped, as they read it.

    One that takes nothing does nothing where more was typed: that meant something else. Only a stop is a stop all
    the same (`heeds_the_rest` is False).
    """

    name: str
    act: Callable[[ChatController, str], None]
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


def run(controller: ChatController, line: str) -> None:
    """Do the command in `line`, which begins with a slash; an unknown one gets the nearest name."""
    word, _, argument = line[1:].strip().partition(" ")
    command = BY_NAME.get(word.casefold())
    if command is None:
        _unknown(controller, word)
    elif argument.strip() and not command.takes and command.heeds_the_rest:
        controller.tell("takes_nothing", command=command.typed)
    elif command.at_once:
        command.act(controller, argument.strip())
    else:
        controller.pump.post(lambda: command.act(controller, argument.strip()))


def nearest(word: str) -> str:
    """The command that was most likely meant; empty where none is near."""
    near = difflib.get_close_matches(word.casefold(), BY_NAME, n=1, cutoff=0.5)
    return near[0] if near else ""


def _unknown(controller: ChatController, word: str) -> None:
    near = nearest(word)
    if near:
        controller.tell("nearest_command", command=f"/{word}", nearest=f"/{near}")
    else:
        controller.display.print(
            Text("  ").append(controller.words.say("no_such_command", command=f"/{word}")).append(" ")
            .append(controller.words.say("all_commands"))
        )  # fmt: skip


def _help(controller: ChatController, _: str) -> None:
    shown = [(command.typed, command.help_code) for command in COMMANDS]
    controller.display.print(tables.help_table(controller.words, controller.connection.world, shown))


def _robot(controller: ChatController, _: str) -> None:
    controller.display.print(*tables.robot_tables(controller.words, controller.connection.profile))


def _world(controller: ChatController, _: str) -> None:
    controller.display.print(
        big_map(controller.motion_view, controller.connection.world, controller.display.width),
        tables.world_table(controller.words, controller.connection.world),
    )


def _places(controller: ChatController, _: str) -> None:
    remembered = controller.session.understanding.places.all()
    controller.display.print(tables.places_table(controller.words, controller.connection.world, remembered))


def _undo(controller: ChatController, _: str) -> None:
    controller.attempt(lambda: controller.session.say(controller.words.say("undo_words")))


def _plan(controller: ChatController, _: str) -> None:
    if not controller.motion_view.plan_text:
        controller.tell("no_plan")
        return
    controller.display.print(
        *controller.narrator.plan(controller.motion_view.plan_text, controller.motion_view.rehearsed)
    )


def _save_plan(controller: ChatController, argument: str) -> None:
    if not argument or not controller.motion_view.plan_text:
        controller.tell("no_plan" if argument else "save_which")
        return
    path = Path(argument).expanduser()
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(f"{controller.motion_view.plan_text}\n")
    except OSError as error:
        controller.tell("save_failed", problem=f"{path}: {error.strerror}")
        return
    controller.tell("saved", file=path)


def _run_plan(controller: ChatController, argument: str) -> None:
    if not argument:
        controller.tell("run_which")
        return
    try:
        controller.say_plan(read_plan_file(argument))
    except UsageError as error:
        controller.tell("run_failed", problem=error)


def _program(controller: ChatController, argument: str) -> None:
    """A new program, or without words the list of those that are kept."""
    if argument:
        controller.attempt(lambda: controller.session.say_program(argument))
        return
    names = controller.session.authoring.library.names() if controller.session.authoring is not None else ()
    controller.tell("programs_kept", names=", ".join(names)) if names else controller.tell("no_programs_kept")


def _map(controller: ChatController, argument: str) -> None:
    if not controller.motion_view.is_measured:  # nobody knows where on it the robot is
        controller.tell("not_measured")
        return
    if argument.casefold() in ("big", "大"):
        controller.display.print(
            big_map(controller.motion_view, controller.connection.world, controller.display.width)
        )
        return
    if argument:
        controller.tell("no_such_map", size=argument)
        return
    controller.strip.shows_map = not controller.strip.shows_map
    controller.tell("map_on" if controller.strip.shows_map else "map_off")


def _stop(controller: ChatController, _: str) -> None:
    controller.stop("/stop")


def _estop(controller: ChatController, _: str) -> None:
    controller.emergency_stop("/estop")
    controller.tell("estop_done")


def _release(controller: ChatController, _: str) -> None:
    controller.release()  # Motion says whether it is


def _limit(controller: ChatController, argument: str) -> None:
    limits = read_limits(argument)
    if limits is None:
        controller.tell("limit_unclear", argument=argument)
    else:
        controller.attempt(lambda: controller.session.limit(**limits))  # Motion says what holds then


def _quit(controller: ChatController, _: str) -> None:
    controller.leave()


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


_DISTANCES: Mapping[str, float] = {"m": 1.0, "km": 1000.0}
_TIMES: Mapping[str, float] = {"s": 1.0, "min": 60.0, "h": 3600.0}
_AMOUNT = re.compile(rf"({NONE}|\d+(?:\.\d+)?|\.\d+)\s*(km|m|min|s|h)?(?![\w.])[\s,]*", re.ASCII)


def read_limits(text: str) -> dict[str, float | str] | None:
    """The payload of a `limit` envelope; None where `text` is no amounts. `none` without a unit lifts both limits."""
    found: dict[str, float | str] = {}
    rest = text.strip().casefold()
    while rest:
        match = _AMOUNT.match(rest)
        if match is None or not _note(match[1], match[2] or "", found):
            return None
        rest = rest[match.end() :]
    return found


def _note(amount: str, unit: str, found: dict[str, float | str]) -> bool:
    """Note one amount; False where it cannot be one, or is the second of its kind."""
    if amount != NONE and (not unit or float(amount) <= 0.0):
        return False
    for name, factors in (("max_distance_m", _DISTANCES), ("max_time_s", _TIMES)):
        if unit and unit not in factors:
            continue
        if name in found:
            return False
        found[name] = NONE if amount == NONE else float(amount) * factors[unit]
    return True
