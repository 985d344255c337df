"""What slash commands print: tables, and maps as something rich can print."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence

from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.text import Text

from chatrobot.cli.console.lines import INDENT, Rows, indented
from chatrobot.cli.console.motion_view import MotionView
from chatrobot.cli.console.words import Words
from chatrobot.cli.drawing.extent import Extent, Orientation, extent_around, extent_of_world
from chatrobot.cli.drawing.map_text import MapText
from chatrobot.language.context import Place
from chatrobot.language.phrases import by_language
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.world import World

_UNITS = {
    "mps": "m/s", "mps2": "m/s²", "mps3": "m/s³", "radps": "rad/s", "radps2": "rad/s²", "radps3": "rad/s³",
    "s": "s", "m": "m",
}  # fmt: skip


def example_place(world: World) -> str:
    """Return a place to go to in an example; empty where the world has none."""
    return "kitchen" if "kitchen" in world.places else next(iter(world.places), "")


def place_in(language: str, world: World, name: str) -> str:
    """Return a place's name in that language, if it has one."""
    return by_language(world.names_of(name), language)[0]


def help_table(words: Words, world: World, commands: Sequence[tuple[str, str]]) -> RenderableType:
    """List what one can say, the commands (as they are typed, with the code of their help), the keys."""
    place = place_in(words.language, world, example_place(world)) or words.say("place_name")
    examples = [
        Text("    ").append(part.strip(), "cyan")
        for part in words.say("help_examples", place=place).split("|")
    ]
    table = Rows()
    for typed, help_code in commands:
        table.add(Text(typed, "bold"), words.say(help_code))
    return Group(
        indented(Text(words.say("help_talk"))),
        *examples,
        Padding(table, (1, 0, 1, INDENT)),
        indented(Text(words.say("help_keys"), "dim")),
    )


def robot_tables(words: Words, profile: RobotProfile) -> Iterator[RenderableType]:
    """Limits with their sources, and what is meant where nothing is said."""
    xs, ys = zip(*profile.footprint)
    lidar = words.say("without_lidar")
    if profile.lidar is not None:
        lidar = words.say("with_lidar", range=f"{profile.lidar.max_range_m:g}")
    yield indented(Text(profile.title, "bold").append(f"  {profile.name}", "not bold dim"))
    footprint = words.say(
        "robot_footprint",
        length=f"{max(xs) - min(xs):.2f}",
        width=f"{max(ys) - min(ys):.2f}",
        kinematics=profile.kinematics,
        lidar=lidar,
    )
    defaults = words.say(
        "robot_defaults",
        speed=f"{profile.defaults.speed_mps:g}",
        rate=f"{math.degrees(profile.defaults.rate_radps):.0f}",
        distance=f"{profile.defaults.distance_m:g}",
        turn=f"{math.degrees(profile.defaults.turn_rad):.0f}",
    )
    yield indented(Text(f"{footprint}\n{defaults}"))
    table = Rows(words.say("robot_limit"), "", words.say("robot_source"))
    for field in dataclasses.fields(profile.limits):
        number = getattr(profile.limits, field.name)
        if field.name not in profile.sources:
            continue
        value = f"{number:g} {_UNITS[field.name.rpartition('_')[2]]}"
        table.add(words.say(f"limit_{field.name}"), value, Text(profile.sources.get(field.name, ""), "dim"))
    yield Padding(table, (1, 0, 0, INDENT))


def places_table(words: Words, world: World, remembered: Mapping[str, Place]) -> RenderableType:
    """List places, the person's own first, then the world's."""
    if not world.places and not remembered:
        return indented(Text(words.say("no_places"), "dim"))
    table = Rows(words.say("place_name"), words.say("place_pose"), words.say("place_also"))
    for name, place in remembered.items():
        note = words.say("place_yours" if place.usable else "place_old")
        table.add(Text(name, "bold" if place.usable else "dim"), words.pose(place.pose), Text(note, "dim"))
    own = {name for name, place in remembered.items() if place.usable}
    for main, pose in world.places.items():
        name, *others = by_language(world.names_of(main), words.language)
        if main not in own:
            table.add(name, words.pose(pose), Text(", ".join(others), "dim"))
    return Padding(table, (0, 0, 0, INDENT))


COLOURS = {
    "wall": "bright_black", "path": "blue", "trail": "dark_orange", "place": "cyan", "robot": "bold red", "": "",
}  # fmt: skip
BIG_COLUMNS, BIG_ROWS = 100, 30
WAY_COLUMNS, WAY_ROWS = 60, 14


def big_map(motion_view: MotionView, world: World, columns: int) -> Text:
    """Draw the whole world with its names, the last plan's way and what was driven of it."""
    extent = extent_of_world(world, (*motion_view.path, *motion_view.trail), margin_m=0.1, least_m=3.0)
    return _draw(motion_view, world, extent, min(columns - 4, BIG_COLUMNS), BIG_ROWS)


def way_map(motion_view: MotionView, world: World) -> Text:
    """Draw the predicted way of the last plan and what stands around it."""
    extent = extent_around(Orientation(world).points(motion_view.path), margin_m=0.8, least_m=3.0)
    return _draw(motion_view, world, extent, WAY_COLUMNS, WAY_ROWS)


def _draw(motion_view: MotionView, world: World, extent: Extent, columns: int, rows: int) -> Text:
    # As many cells as the extent fills; a braille dot is as wide as it is high, a cell has two by four.
    dots_per_m = min(columns * 2 / extent.width_m, rows * 4 / extent.height_m)
    columns, rows = (
        max(4, round(extent.width_m * dots_per_m / 2)),
        max(2, round(extent.height_m * dots_per_m / 4)),
    )
    drawing = MapText(world, extent, columns=columns, rows=rows, path=motion_view.path, names=True)
    text = Text(no_wrap=True)
    for number, line in enumerate(drawing.lines(trail=motion_view.trail, pose=motion_view.pose)):
        text.append("\n  " if number else "  ")
        for layer, run in line:
            text.append(run, COLOURS[layer])
    return text
