"""Worlds by name or path: YAML files in a frame of their own, checked field by field, re-expressed in the frame of the
start."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.core.errors import WorldError
from chatrobot.core.geometry import Pose
from chatrobot.sim.shapes import Circle, Point, Polygon, Shape, polygon, rectangle
from chatrobot.sim.world import EMPTY_WORLD, Obstacle, World

if TYPE_CHECKING:
    import yaml


_BUILT_IN = Path(__file__).with_name("worlds")


def load_world(name_or_path: str) -> World:
    """Return the world of that name, or in that YAML file (anything with a slash, or ending in .yaml or .yml).

    Raises:
        WorldError: there is none, or it cannot be used; names file, line, field and what is allowed.
    """
    if name_or_path == EMPTY_WORLD.name:
        return EMPTY_WORLD
    if "/" in name_or_path or name_or_path.endswith((".yaml", ".yml")):
        return read_world(Path(name_or_path))
    path = _BUILT_IN / f"{name_or_path}.yaml"
    if path.is_file():
        return read_world(path)
    allowed = f"{', '.join(world_names())}, or a path to a .yaml file"
    raise WorldError(f"there is no world named {name_or_path!r}", allowed=allowed)


def world_names() -> list[str]:
    """Return the names of worlds, the empty one first."""
    return [EMPTY_WORLD.name, *sorted(file.stem for file in _BUILT_IN.glob("*.yaml"))]


MAX_COORDINATE_M = 1000.0


def read_world(path: Path) -> World:
    """Return the world in a YAML file.

    Raises:
        WorldError: names file, line, field, what is wrong and what is allowed.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise WorldError(f"cannot be read ({error.strerror})", where=str(path)) from error
    except UnicodeDecodeError as error:
        raise WorldError("cannot be read", where=str(path), allowed="YAML in UTF-8") from error
    return parse_world(text, str(path), default_name=path.stem)


def parse_world(text: str, source: str, default_name: str = "world") -> World:
    """Read the same from text; `source` is what errors call it."""
    root = _Field(_compose(text, source), source, "")
    fields = root.mapping("start", "name", "obstacles", "places", "allowed_area")
    start = _start(fields["start"]) if "start" in fields else Pose()
    obstacles = fields["obstacles"].items() if "obstacles" in fields else []
    places, aliases, without_heading = _places(fields.get("places"), start)
    area = fields.get("allowed_area")
    return World(
        name=fields["name"].text() if "name" in fields else default_name,
        obstacles=tuple(_obstacle(item, start) for item in obstacles),
        places=places,
        aliases=aliases,
        allowed_area=_polygon(area).seen_from(start) if area else None,
        without_heading=without_heading,
        start_yaw_rad=start.yaw_rad,
    )


class _Field:
    """A node of the file that knows its name and line."""

    def __init__(self, node: yaml.Node, source: str, name: str) -> None:
        self._node = node
        self._kind: str = node.id  # type: ignore[attr-defined]  # "scalar", "sequence" or "mapping"
        self._source = source
        self.name = name

    def error(self, problem: str, allowed: str = "") -> WorldError:
        line = self._node.start_mark.line + 1
        what = f"{self.name}: {problem}" if self.name else problem
        return WorldError(what, where=f"{self._source}, line {line}", allowed=allowed)

    def mapping(self, *allowed: str, required: tuple[str, ...] = ()) -> dict[str, _Field]:
        """The fields of a mapping; none but the allowed ones, none missing, none twice."""
        if self._kind != "mapping":
            raise self.error("must be a mapping of fields", f"allowed: {', '.join(allowed)}")
        fields: dict[str, _Field] = {}
        for key_node, value_node in self._node.value:
            key = str(key_node.value)
            field = _Field(value_node, self._source, f"{self.name}.{key}" if self.name else key)
            if key not in allowed:
                raise _Field(key_node, self._source, field.name).error(
                    "unknown field", f"allowed: {', '.join(allowed)}"
                )
            if key in fields:
                raise field.error("is given twice")
            fields[key] = field
        for key in required:
            if key not in fields:
                raise self.error(f"{key} is missing", f"required: {', '.join(required)}")
        return fields

    def items(self) -> list[_Field]:
        if self._kind != "sequence":
            raise self.error("must be a list")
        return [_Field(node, self._source, f"{self.name}[{i}]") for i, node in enumerate(self._node.value)]

    def text(self) -> str:
        value = self._node.value
        if self._kind != "scalar" or not value.strip() or not value.isprintable():
            raise self.error("must be a line of text")
        return str(value.strip())

    def number(self, least: float = -MAX_COORDINATE_M, most: float = MAX_COORDINATE_M) -> float:
        allowed = f"a number from {least:g} to {most:g}"
        if self._kind != "scalar":
            raise self.error("must be a number", allowed)
        try:
            value = float(self._node.value)
        except ValueError:
            raise self.error(f"{self._node.value!r} is not a number", allowed) from None
        if not (math.isfinite(value) and least <= value <= most):
            raise self.error(f"{self._node.value} is not possible", allowed)
        return value

    def size(self) -> float:
        """A length above zero."""
        return self.number(least=0.001)

    def point(self) -> Point:
        pair = self.items()
        if len(pair) != 2:
            raise self.error("a point is [x, y]")
        return pair[0].number(), pair[1].number()


def _compose(text: str, source: str) -> yaml.Node:
    import yaml  # late: an empty world needs none

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        node = yaml.compose(text, Loader=loader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f"{source}, line {mark.line + 1}" if mark else source
        problem = getattr(error, "problem", None) or str(error)
        raise WorldError(f"is not YAML: {problem}", where=where) from error
    except RecursionError as error:
        raise WorldError("is nested too deeply", where=source) from error
    if node is None:
        raise WorldError("is empty", where=source, allowed="a world has obstacles, places and a start")
    return node


def _start(field: _Field) -> Pose:
    fields = field.mapping("x_m", "y_m", "yaw_deg", required=("x_m", "y_m"))
    return Pose(fields["x_m"].number(), fields["y_m"].number(), _yaw(fields))


def _yaw(fields: dict[str, _Field]) -> float:
    return math.radians(fields["yaw_deg"].number(-360.0, 360.0)) if "yaw_deg" in fields else 0.0


def _rectangle(field: _Field) -> Polygon:
    required = ("x_m", "y_m", "length_m", "width_m")
    fields = field.mapping(*required, "yaw_deg", required=required)
    return rectangle(
        fields["x_m"].number(),
        fields["y_m"].number(),
        fields["length_m"].size(),
        fields["width_m"].size(),
        _yaw(fields),
    )


def _circle(field: _Field) -> Circle:
    required = ("x_m", "y_m", "radius_m")
    fields = field.mapping(*required, required=required)
    return Circle(fields["x_m"].number(), fields["y_m"].number(), fields["radius_m"].size())


def _polygon(field: _Field) -> Polygon:
    try:
        return polygon(tuple(point.point() for point in field.items()))
    except ValueError as error:
        raise field.error(str(error), "a list of at least 3 points [x, y]") from None


def _wall(field: _Field) -> Polygon:
    """Both ends reach half a thickness further, so that walls that meet have no gap at the corner."""
    required = ("from", "to", "thickness_m")
    fields = field.mapping(*required, required=required)
    (ax, ay), (bx, by) = fields["from"].point(), fields["to"].point()
    thickness_m = fields["thickness_m"].size()
    if (ax, ay) == (bx, by):
        raise field.error("both ends of a wall are the same point")
    length_m = math.hypot(bx - ax, by - ay) + thickness_m
    return rectangle((ax + bx) / 2, (ay + by) / 2, length_m, thickness_m, math.atan2(by - ay, bx - ax))


_SHAPES: dict[str, Callable[[_Field], Shape]] = {
    "rectangle": _rectangle,
    "polygon": _polygon,
    "circle": _circle,
    "wall": _wall,
}


def _obstacle(field: _Field, start: Pose) -> Obstacle:
    fields = field.mapping("name", "aliases", *_SHAPES, required=("name",))
    kinds = [kind for kind in _SHAPES if kind in fields]
    if len(kinds) != 1:
        raise field.error("needs exactly one shape", f"one of {', '.join(_SHAPES)}")
    shape = _SHAPES[kinds[0]](fields[kinds[0]])
    others = tuple(alias.text() for alias in fields["aliases"].items()) if "aliases" in fields else ()
    return Obstacle(fields["name"].text(), shape.seen_from(start), others)


def _places(field: _Field | None, start: Pose) -> tuple[dict[str, Pose], dict[str, str], frozenset[str]]:
    """The poses by main name, the main name of each name, and the main names without a heading."""
    places: dict[str, Pose] = {}
    without_heading: set[str] = set()
    aliases: dict[str, str] = {}
    for item in field.items() if field else []:
        fields = item.mapping("name", "aliases", "x_m", "y_m", "yaw_deg", required=("name", "x_m", "y_m"))
        name = fields["name"].text()
        pose = Pose(fields["x_m"].number(), fields["y_m"].number(), _yaw(fields))
        places[name] = pose.relative_to(start)
        if "yaw_deg" not in fields:
            without_heading.add(name)
        others = fields["aliases"].items() if "aliases" in fields else []
        for alias_field in (fields["name"], *others):
            alias = alias_field.text().casefold()
            if alias in aliases:
                raise alias_field.error(f"{alias} already names {aliases[alias]}")
            aliases[alias] = name
    return places, aliases, frozenset(without_heading)
