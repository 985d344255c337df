"""The slash commands: name, what it takes, and the function, each in this one place. Help texts are in the tables."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from rich.console import RenderableType
from rich.text import Text

from chatrobot.cli.console import tables
from chatrobot.cli.console.controller import ChatController
from chatrobot.cli.console.lines import shown
from chatrobot.cli.plan import read_plan_file
from chatrobot.core.errors import UsageError
from chatrobot.core.files import write_new
from chatrobot.link.envelope import OBSTACLE_RADIUS_M
from chatrobot.link.processes import SIMULATED
from chatrobot.robots.profile import NONE


@dataclass(frozen=True)
class Command:
    """`at_once` ones run where the line was typed; the others where the session is pumped, as they read it.

    One that takes nothing does nothing where more was typed: that meant something else. Only a stop is a stop all
    the same (`heeds_the_rest` is False). A stop makes void what `is_order` and has not been done yet.
    """

    name: str
    act: Callable[[ChatController, str], None]
    takes: str = ""
    at_once: bool = False
    heeds_the_rest: bool = True
    is_order: bool = False

    @property
    def typed(self) -> str:
        """As a person types it, with what it takes."""
        return f"/{self.name} {self.takes}".strip()

    @property
    def help_code(self) -> str:
        """The code of its help text in the tables."""
        return f"command_{self.name.replace('-', '_')}"


def run(controller: ChatController, line: str) -> None:
    """Do the command in `line`, which begins with a slash; an unknown one gets the nearest name."""
    word, _, argument = line[1:].strip().partition(" ")
    known = BY_NAME | {each.name: each for each in controller.commands}
    command = known.get(word.casefold())
    if command is None:
        _unknown(controller, word, known)
    elif argument.strip() and not command.takes and command.heeds_the_rest:
        controller.tell("takes_nothing", command=command.typed)
    elif command.at_once:
        command.act(controller, argument.strip())
    else:
        stops = controller.session.stops
        controller.pump.post(lambda: _act(controller, command, argument.strip(), stops))


def _act(controller: ChatController, command: Command, argument: str, stops: int) -> None:
    session = controller.session
    if command.is_order and session.stops != stops:
        controller.tell("command_dropped", command=f"/{command.name} {argument}".strip())
    else:
        command.act(controller, argument)
        if command.is_order and session.stops != stops:  # one came in between: nothing has been taken up yet
            controller.attempt(session.stop)
    controller.drop_behind_command()


def nearest(word: str, known: Iterable[str] = ()) -> str:
    """Return the command that was most likely meant; empty where none is near."""
    near = difflib.get_close_matches(word.casefold(), known or BY_NAME, n=1, cutoff=0.6)
    return near[0] if near else ""


def _unknown(controller: ChatController, word: str, known: Mapping[str, Command]) -> None:
    near = nearest(word, known)
    if near:
        controller.tell("nearest_command", command=f"/{word}", nearest=f"/{near}")
    else:
        told = (
            controller.words.say("no_such_command", command=f"/{word}"),
            controller.words.say("all_commands"),
        )
        controller.display.print(Text(f"  {' '.join(told)}"))


def _help(controller: ChatController, _: str) -> None:
    shown = [(command.typed, command.help_code) for command in (*COMMANDS, *controller.commands)]
    controller.display.print(tables.help_table(controller.words, controller.connection.world, shown))


def _world(controller: ChatController, _: str) -> None:
    world = controller.connection.world
    controller.display.print(_big_map(controller), tables.places_table(controller.words, world, {}))


def _places(controller: ChatController, _: str) -> None:
    remembered = controller.session.understanding.places.all()
    controller.display.print(tables.places_table(controller.words, controller.connection.world, remembered))


def _plan(controller: ChatController, _: str) -> None:
    view = controller.motion_view
    if view.plan_text:
        controller.display.print(*map(shown, controller.narrator.plan(view.plan_text, view.rehearsed)))
    else:
        controller.tell("no_plan")


def _why(controller: ChatController, _: str) -> None:
    controller.display.print(*(Text(f"  {line}") for line in controller.session.understanding.why()))


def _save_plan(controller: ChatController, argument: str) -> None:
    if not argument or not controller.motion_view.plan_text:
        controller.tell("no_plan" if argument else "save_which")
        return
    path = Path(argument).expanduser()
    try:
        write_new(path, f"{controller.motion_view.plan_text}\n")
        controller.tell("saved", file=path)
    except OSError as error:
        controller.tell("save_failed", problem=f"{path}: {error.strerror}")


def _run_plan(controller: ChatController, argument: str) -> None:
    if not argument:
        controller.tell("run_which")
        return
    stops = controller.session.stops
    try:
        plan_text = read_plan_file(argument, takes_pipe=False)
    except UsageError as error:
        controller.tell("run_failed", problem=error)
        return
    if controller.session.stops == stops:
        controller.say_plan(plan_text)
    else:  # it came while the file was read, which may take long on a disk that is far away
        controller.tell("command_dropped", command=f"/run-plan {argument}")


def _program(controller: ChatController, argument: str) -> None:
    """Ask for a new program; without words list those that are kept."""
    names = controller.session.authoring.library.names() if controller.session.authoring is not None else ()
    if argument in names:
        controller.tell("program_is_kept", name=argument)
        return
    if argument and argument.casefold() != "list":  # as `chatrobot program list`
        controller.say_as_one(lambda: controller.session.say_program(argument), "", argument)
        return
    controller.tell("programs_kept", names=", ".join(names)) if names else controller.tell("no_programs_kept")


def _map(controller: ChatController, argument: str) -> None:
    if not controller.motion_view.is_measured:  # nobody knows where on it the robot is
        controller.tell("not_measured")
    elif argument.casefold() in ("big", "大"):
        controller.display.print(_big_map(controller))
    elif argument:
        controller.tell("no_such_map", size=argument)
    else:
        bar = controller.status_bar
        bar.shows_map = not bar.shows_map
        controller.tell("map_on" if bar.shows_map else "map_off")


def _big_map(controller: ChatController) -> RenderableType:
    return tables.big_map(controller.motion_view, controller.connection.world, controller.display.width)


def _stop(controller: ChatController, _: str) -> None:
    controller.stop("/stop")
    if controller.session.is_idle:  # otherwise what is under way says how it ended
        controller.tell("stop_sent")


def _estop(controller: ChatController, _: str) -> None:
    controller.emergency_stop("/estop")
    controller.tell("estop_done")


def _limit(controller: ChatController, argument: str) -> None:
    limits = read_limits(argument)
    if limits is None:
        controller.tell("limit_unclear", argument=argument)
    else:
        controller.attempt(lambda: controller.session.limit(**limits))  # Motion says what holds then


_NUMBER = r"(-?\d+\.?\d*|-?\.\d+)"
_PUT = re.compile(
    rf"(?:add|put|放)\s+(.+?)\s+{_NUMBER}[\s,]+{_NUMBER}(?:[\s,]+{_NUMBER})?(?:\s*m)?", re.IGNORECASE
)
_TAKE = re.compile(r"(?:remove|take|拿走)\s+(.+)", re.IGNORECASE)


def _obstacle(controller: ChatController, argument: str) -> None:
    """Put a disc into the simulation, move it or take it away; without words list what was put there."""
    setup, names = controller.connection.prepared.setup, _added_names(controller)
    put, take = _PUT.fullmatch(argument), _TAKE.fullmatch(argument)
    if setup.on not in SIMULATED:
        controller.tell("obstacle_simulated_only")
    elif put is not None and float(put[4] or OBSTACLE_RADIUS_M) > 0.0:
        circle = [float(put[2]), float(put[3]), float(put[4] or OBSTACLE_RADIUS_M)]
        controller.attempt(lambda: controller.session.change_obstacle(add=put[1], circle=circle))
    elif take is not None:
        controller.attempt(lambda: controller.session.change_obstacle(remove=take[1]))
    elif argument:
        controller.tell("obstacle_how")
    else:
        controller.tell("obstacles_put", names=", ".join(names)) if names else controller.tell("obstacle_how")


def _added_names(controller: ChatController) -> list[str]:
    return [one.name for one in controller.connection.world.obstacles if one.is_added]


COMMANDS = (
    Command("help", _help),
    Command("robot", lambda it, _: it.display.print(*tables.robot_tables(it.words, it.connection.profile))),
    Command("world", _world),
    Command("places", _places),
    Command("plan", _plan),
    Command("why", _why),
    Command("save-plan", _save_plan, takes="FILE"),
    Command("run-plan", _run_plan, takes="FILE", is_order=True),
    Command("program", _program, takes="[TEXT]", is_order=True),
    Command(
        "undo", lambda it, _: it.attempt(lambda: it.session.say(it.words.say("undo_words"))), is_order=True
    ),
    Command("map", _map, takes="[big]"),
    Command("limit", _limit, takes="[200 m] [20 min] [none]"),
    Command("obstacle", _obstacle, takes="[add NAME X Y | remove NAME]"),
    Command("stop", _stop, at_once=True, heeds_the_rest=False),
    Command("estop", _estop, at_once=True, heeds_the_rest=False),
    Command("release", lambda it, _: it.release(), at_once=True),  # Motion says whether it is
    Command("quit", lambda it, _: it.leave(), at_once=True),
)
BY_NAME = {command.name: command for command in COMMANDS}


_DISTANCES: Mapping[str, float] = {"cm": 0.01, "m": 1.0, "km": 1000.0}
_TIMES: Mapping[str, float] = {"s": 1.0, "min": 60.0, "h": 3600.0}
_AMOUNT = re.compile(rf"({NONE}|\d+(?:\.\d+)?|\.\d+)\s*(cm|km|m|min|s|h)?(?![\w.])[\s,]*", re.ASCII)


def read_limits(text: str) -> dict[str, float | str] | None:
    """Return the payload of a `limit` envelope; None for no amounts. `none` without a unit lifts both limits."""
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
