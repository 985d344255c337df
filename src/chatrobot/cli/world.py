"""`chatrobot world list|draw|check|new`: worlds for the simulated robot, and what is known around a real one."""

from __future__ import annotations

import argparse
import json
import shlex
from pathlib import Path
from typing import Any

from chatrobot.cli.folders import profile_folders
from chatrobot.cli.json_lines import json_line
from chatrobot.core.errors import InputError, UsageError, WorldError
from chatrobot.core.files import write_new
from chatrobot.core.geometry import ORIGIN
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.load import NEW_WORLD, WorldFile, find_world, world_names
from chatrobot.sim.world import World

_PICTURES = (".svg", ".png")
_NAME_COLUMNS = 11


def run(args: argparse.Namespace) -> int:
    """Return 0, or 1 where `check` found something.

    Raises:
        InputError: there is no such world, or a file cannot be read or written.
    """
    actions = {"list": list_worlds, "draw": _draw, "check": _check, "new": _new}
    return actions[args.action](args)


def list_worlds(args: argparse.Namespace) -> int:
    """List the built-in worlds, each with its size and its places."""
    for name in world_names():
        facts = _facts(find_world(name).world)
        if args.json:
            print(json_line({"event": "world", "name": name, **facts}), end="")
        elif facts["length_m"] is None:
            print(f"{name:<{_NAME_COLUMNS}}an open floor: no walls, no places")
        else:
            print(f"{name:<{_NAME_COLUMNS}}{_size(facts)}; places: {', '.join(facts['places'])}")
    if not args.json:
        print(
            "One of your own: chatrobot world new FILE.yaml; a map of ROS: --world map.yaml; see docs/worlds.md."
        )
    return 0


def _facts(world: World) -> dict[str, Any]:
    around = world.bounds
    return {
        "length_m": round(around.max_x_m - around.min_x_m, 3) if around else None,
        "width_m": round(around.max_y_m - around.min_y_m, 3) if around else None,
        "obstacles": len(world.obstacles),
        "places": list(world.places),
    }


def _size(facts: dict[str, Any]) -> str:
    return f"{facts['length_m']:g} × {facts['width_m']:g} m, {facts['obstacles']} obstacles"


def _profile(args: argparse.Namespace) -> RobotProfile:
    return load_profile(args.robot, profile_folders(args))


# --- drawn ---


def _draw(args: argparse.Namespace) -> int:
    world = find_world(args.world).world
    if not args.out:
        return _draw_here(world)
    out = Path(args.out).expanduser()
    if out.suffix.casefold() not in _PICTURES:
        raise UsageError(
            "no such kind of picture", where=args.out, allowed=f"a file that ends in {' or '.join(_PICTURES)}"
        )
    from chatrobot.cli.draw import draw_world

    try:
        draw_world(out, world=world, profile=_profile(args))
    except OSError as error:
        raise UsageError(f"cannot be written ({error.strerror or error})", where=str(out)) from error
    print(f"{out}: {world.name}, {_size(_facts(world))}" if world.bounds else f"{out}: an open floor")
    return 0


def _draw_here(world: World) -> int:
    from rich.console import Console

    from chatrobot.cli.console.motion_view import MotionView
    from chatrobot.cli.console.tables import big_map

    console = Console(highlight=False)
    console.print(big_map(MotionView(pose=ORIGIN), world, console.width))
    for name in world.places:
        console.print(f"  • {', '.join(world.names_of(name))}", style="dim")
    return 0


# --- checked ---


def _check(args: argparse.Namespace) -> int:
    profile = _profile(args)
    try:
        file = find_world(args.world)
        found = [*_problems(file, profile)]
    except WorldError as error:
        if not error.where:  # there is no such world to be checked
            raise
        return _tell(args, [error])
    if found:
        return _tell(args, found)
    if args.json:
        print(json_line({"event": "world", "name": file.world.name, **_facts(file.world)}), end="")
    else:
        print(f"{args.world}: fine for {profile.title}: {_told(file.world)}")
    return 0


def _tell(args: argparse.Namespace, found: list[InputError]) -> int:
    for error in found:
        told = {"where": error.where, "problem": error.problem, "allowed": error.allowed}
        print(json_line({"event": "problem", **told}) if args.json else f"{error}\n", end="")
    if not args.json:
        print(f"{len(found)} problem{'s' if len(found) > 1 else ''}: see docs/worlds.md")
    return 1


def _told(world: World) -> str:
    if world.bounds is None:
        return "an open floor"
    places = len(world.places)
    reached = (
        f"{places} places, each reached from the start" if places else "no places: nobody can say “go to …”"
    )
    return f"{_size(_facts(world))}, {reached}"


def _problems(file: WorldFile, profile: RobotProfile) -> list[InputError]:
    from chatrobot.cli.world_check import problems, unsaid_names

    return [*problems(file, profile), *unsaid_names(file, profile)]


# --- new ---


def _new(args: argparse.Namespace) -> int:
    path = Path(args.file).expanduser()
    if path.suffix not in (".yaml", ".yml"):
        raise UsageError("is no name for a world", where=args.file, allowed="a file that ends in .yaml")
    if not path.name.isprintable():
        raise UsageError("is no name for a world", where=args.file, allowed="printable characters")
    named, name = shlex.quote(args.file), path.stem
    if not name.replace("_", "").isalnum():  # in quotation marks, as YAML reads them
        name = json.dumps(name, ensure_ascii=False)
    text = NEW_WORLD.read_text(encoding="utf-8").replace("{file}", named).replace("{name}", name)
    try:
        write_new(path, text)
    except FileExistsError:
        raise UsageError("is there already", where=str(path), allowed="the name of a new file") from None
    except OSError as error:
        raise UsageError(f"cannot be written ({error.strerror})", where=str(path)) from error
    print(f"{path} is a room to change into your own; then:")
    for action in ("world draw", "world check", "--world"):
        print(f"  chatrobot {action} {named}")
    return 0
