"""Worlds by name or path: YAML files in a frame of their own, checked field by field, re-expressed in the frame of the
start."""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from chatrobot.core.errors import WorldError
from chatrobot.core.geometry import Pose
from chatrobot.sim.fields import Field, compose, read_text
from chatrobot.sim.map_server import KEYS as MAP_KEYS
from chatrobot.sim.map_server import is_map, walls_of
from chatrobot.sim.shapes import Circle, Polygon, Shape, polygon, rectangle
from chatrobot.sim.world import EMPTY_WORLD, Obstacle, World

_BUILT_IN = Path(__file__).with_name("worlds")
NEW_WORLD = _BUILT_IN / "new.txt"
"""What a world of one's own begins with; {file} and {name} are to be filled in."""


def load_world(name_or_path: str) -> World:
    """Return the world of that name, or in that YAML file (anything with a slash, or ending in .yaml or .yml).

    Raises:
        WorldError: there is none, or it cannot be used; names file, line, field and what is allowed.
    """
    return find_world(name_or_path).world


def find_world(name_or_path: str) -> WorldFile:
    """Return the same, with the lines of its file."""
    if name_or_path == EMPTY_WORLD.name:
        return WorldFile(EMPTY_WORLD, EMPTY_WORLD.name)
    if "/" in name_or_path or name_or_path.endswith((".yaml", ".yml")):
        return read_world_file(Path(name_or_path).expanduser())
    path = _BUILT_IN / f"{name_or_path}.yaml"
    if path.is_file():
        return read_world_file(path)
    near = difflib.get_close_matches(name_or_path, world_names(), n=1)
    meant = f"did you mean {near[0]}? " if near else ""
    allowed = f"{meant}{', '.join(world_names())}, or a path to a .yaml file"
    raise WorldError(f"there is no world named {name_or_path!r}", allowed=allowed)


def world_names() -> list[str]:
    """Return the names of worlds, the empty one first."""
    return [EMPTY_WORLD.name, *sorted(file.stem for file in _BUILT_IN.glob("*.yaml"))]


@dataclass(frozen=True)
class WorldFile:
    """A world, and where in its file each thing stands: `start`, `allowed_area`, each place by its main name."""

    world: World
    source: str
    where: Mapping[str, str] = field(default_factory=dict)

    def where_is(self, what: str) -> str:
        """Return file and line of `start`, `allowed_area` or a place; the file where it is not in it."""
        return self.where.get(what, self.source)


def read_world_file(path: Path) -> WorldFile:
    """Return the world in a YAML file, with its lines. A map of map_server may have places in a file beside it.

    Raises:
        WorldError: names file, line, field, what is wrong and what is allowed.
    """
    root = compose(read_text(path), str(path))
    if not is_map(root):
        return _world(root.mapping(*_KEYS), (), path.stem, str(path))
    fields = root.mapping(*MAP_KEYS, *_KEYS, required=("image", "resolution", "origin"))
    beside = path.with_name(f"{path.stem}{PLACES_SUFFIX}")
    if beside.is_file():
        fields |= compose(read_text(beside), str(beside)).mapping(*_KEYS)
    return _world(fields, walls_of(fields, path.parent), path.stem, str(path))


def parse_world(text: str, source: str, default_name: str = "world") -> World:
    """Read a world, which is no map, from text; `source` is what errors call it."""
    return _world(compose(text, source).mapping(*_KEYS), (), default_name, source).world


_KEYS = ("start", "name", "obstacles", "places", "allowed_area")
PLACES_SUFFIX = ".places.yaml"
"""Of the file beside a map.yaml: map.places.yaml."""


def _world(
    fields: dict[str, Field], walls: tuple[Obstacle, ...], default_name: str, source: str
) -> WorldFile:
    start = _start(fields["start"]) if "start" in fields else Pose()
    obstacles = fields["obstacles"].items() if "obstacles" in fields else []
    places, aliases, without_heading = _places(fields.get("places"), start)
    area = fields.get("allowed_area")
    world = World(
        name=fields["name"].text() if "name" in fields else default_name,
        obstacles=(
            *(replace(wall, shape=wall.shape.seen_from(start)) for wall in walls),
            *(_obstacle(item, start) for item in obstacles),
        ),
        places=places,
        aliases=aliases,
        allowed_area=_polygon(area).seen_from(start) if area else None,
        without_heading=without_heading,
        start=start,
    )
    where = {key: fields[key].where for key in ("start", "allowed_area") if key in fields}
    items = fields["places"].items() if "places" in fields else []
    return WorldFile(world, source, where | {name: item.where for name, item in zip(places, items)})


def _start(field: Field) -> Pose:
    fields = field.mapping("x_m", "y_m", "yaw_deg", required=("x_m", "y_m"))
    return Pose(fields["x_m"].number(), fields["y_m"].number(), _yaw(fields))


def _yaw(fields: dict[str, Field]) -> float:
    return math.radians(fields["yaw_deg"].number(-360.0, 360.0)) if "yaw_deg" in fields else 0.0


def _rectangle(field: Field) -> Polygon:
    required = ("x_m", "y_m", "length_m", "width_m")
    fields = field.mapping(*required, "yaw_deg", required=required)
    return rectangle(
        fields["x_m"].number(),
        fields["y_m"].number(),
        fields["length_m"].size(),
        fields["width_m"].size(),
        _yaw(fields),
    )


def _circle(field: Field) -> Circle:
    required = ("x_m", "y_m", "radius_m")
    fields = field.mapping(*required, required=required)
    return Circle(fields["x_m"].number(), fields["y_m"].number(), fields["radius_m"].size())


def _polygon(field: Field) -> Polygon:
    try:
        return polygon(tuple(point.point() for point in field.items()))
    except ValueError as error:
        raise field.error(
            str(error), "a list of at least 3 points [x, y], one after the other around it"
        ) from None


def _wall(field: Field) -> Polygon:
    """Both ends reach half a thickness further, so that walls that meet have no gap at the corner."""
    required = ("from", "to", "thickness_m")
    fields = field.mapping(*required, required=required)
    (ax, ay), (bx, by) = fields["from"].point(), fields["to"].point()
    thickness_m = fields["thickness_m"].size()
    if (ax, ay) == (bx, by):
        raise field.error("both ends of a wall are the same point", "from: [x, y], to: another [x, y]")
    length_m = math.hypot(bx - ax, by - ay) + thickness_m
    return rectangle((ax + bx) / 2, (ay + by) / 2, length_m, thickness_m, math.atan2(by - ay, bx - ax))


_SHAPES: dict[str, Callable[[Field], Shape]] = {
    "rectangle": _rectangle,
    "polygon": _polygon,
    "circle": _circle,
    "wall": _wall,
}


def _obstacle(field: Field, start: Pose) -> Obstacle:
    fields = field.mapping("name", "aliases", *_SHAPES, required=("name",))
    kinds = [kind for kind in _SHAPES if kind in fields]
    if len(kinds) != 1:
        raise field.error("needs exactly one shape", f"one of {', '.join(_SHAPES)}")
    shape = _SHAPES[kinds[0]](fields[kinds[0]])
    others = tuple(alias.called() for alias in fields["aliases"].items()) if "aliases" in fields else ()
    return Obstacle(fields["name"].called(), shape.seen_from(start), others)


def _places(field: Field | None, start: Pose) -> tuple[dict[str, Pose], dict[str, str], frozenset[str]]:
    """The poses by main name, the main name of each name, and the main names without a heading."""
    places: dict[str, Pose] = {}
    without_heading: set[str] = set()
    aliases: dict[str, str] = {}
    for item in field.items() if field else []:
        fields = item.mapping("name", "aliases", "x_m", "y_m", "yaw_deg", required=("name", "x_m", "y_m"))
        name = fields["name"].called()
        pose = Pose(fields["x_m"].number(), fields["y_m"].number(), _yaw(fields))
        places[name] = pose.relative_to(start)
        if "yaw_deg" not in fields:
            without_heading.add(name)
        others = fields["aliases"].items() if "aliases" in fields else []
        for alias_field in (fields["name"], *others):
            alias = alias_field.called()
            if (folded := alias.casefold()) in aliases:
                main = aliases[folded]
                is_alias = alias_field is not fields["name"]
                other = f"the place {main!r}" if is_alias or main != alias else "another place"
                raise alias_field.error(
                    f"{alias!r} names {other} already", "each name once; capitals count alike"
                )
            aliases[folded] = name
    return places, aliases, frozenset(without_heading)
