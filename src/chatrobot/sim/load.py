"""Worlds by name or path."""

from __future__ import annotations

from pathlib import Path

from chatrobot.core.errors import WorldError
from chatrobot.sim.world import EMPTY_WORLD, World

_BUILT_IN = Path(__file__).with_name("worlds")


def load_world(name_or_path: str) -> World:
    """The world of that name, or in that YAML file (anything with a slash, or ending in .yaml or .yml).

    Raises:
        WorldError: there is none, or it cannot be used; names file, line, field and what is allowed.
    """
    if name_or_path == EMPTY_WORLD.name:
        return EMPTY_WORLD
    from chatrobot.sim.world_file import read_world

    if "/" in name_or_path or name_or_path.endswith((".yaml", ".yml")):
        return read_world(Path(name_or_path))
    path = _BUILT_IN / f"{name_or_path}.yaml"
    if path.is_file():
        return read_world(path)
    allowed = f"{', '.join(world_names())}, or a path to a .yaml file"
    raise WorldError(f"there is no world named {name_or_path!r}", allowed=allowed)


def world_names() -> list[str]:
    """The worlds that have a name, the empty one first."""
    return [EMPTY_WORLD.name, *sorted(file.stem for file in _BUILT_IN.glob("*.yaml"))]
