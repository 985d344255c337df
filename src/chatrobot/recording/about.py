"""The metadata of a recording: whose it is, and all that a report or a replay needs to know of robot and world.

Every value is text; what has parts is JSON. `world_of` reads the world again, without its file.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from typing import Any

from chatrobot import __version__
from chatrobot.core.event import strict_json
from chatrobot.core.geometry import ORIGIN, Pose, wrap_angle
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.load import parse_world
from chatrobot.sim.shapes import Circle, Shape
from chatrobot.sim.world import EMPTY_WORLD, World


def about_of(profile: RobotProfile, world: World, *, on: str, language: str = "en") -> dict[str, str]:
    """Describe a robot in a world.

    Args:
        on: how its wire is called.
        language: of the last question, `en`, `zh` or `de`.
    """
    wiring = profile.wiring
    return {
        "version": __version__,
        "robot": profile.name,
        "title": profile.title,
        "on": on,
        "language": language,
        "world": world.name,
        "world_file": strict_json(_world_file(world)),
        "footprint_m": json.dumps([list(point) for point in profile.footprint]),
        "limits": strict_json(dataclasses.asdict(profile.limits)),
        "topics": json.dumps({"cmd_vel": wiring.cmd_vel_topic, **wiring.sensor_topics}),
    }


def world_of(about: Mapping[str, str]) -> World:
    """Return the world of a recording, in the frame of the start; an empty one where none was described.

    Raises:
        WorldError: the description is none of ours.
    """
    name, text = about.get("world", ""), about.get("world_file", "")
    if not text or name == EMPTY_WORLD.name:
        return EMPTY_WORLD
    return parse_world(text, "the world in the recording", name)


def _world_file(world: World) -> dict[str, Any]:
    """The world as its file could say it (JSON is YAML)."""
    back = ORIGIN.relative_to(world.start)
    found: dict[str, Any] = {
        "name": world.name,
        "start": _pose(world.start),
        "obstacles": [
            {"name": one.name, "aliases": list(one.aliases), **_shape(one.shape.seen_from(back))}
            for one in world.obstacles
        ],
        "places": [
            {"name": name, **_place(world, name, pose.relative_to(back))}
            for name, pose in world.places.items()
        ],
    }
    if world.allowed_area is not None:
        found["allowed_area"] = _points(world.allowed_area.seen_from(back).points)
    return found


def _pose(pose: Pose) -> dict[str, float]:
    yaw_deg = math.degrees(wrap_angle(pose.yaw_rad))
    return {"x_m": round(pose.x_m, 6), "y_m": round(pose.y_m, 6), "yaw_deg": round(yaw_deg, 6)}


def _place(world: World, name: str, pose: Pose) -> dict[str, Any]:
    facts: dict[str, Any] = _pose(pose)
    if name in world.without_heading:
        del facts["yaw_deg"]
    others = [alias for alias in world.names_of(name)[1:] if alias != name]
    return {**facts, "aliases": others} if others else facts


def _shape(seen: Shape) -> dict[str, Any]:
    if isinstance(seen, Circle):
        return {"circle": {"x_m": seen.x_m, "y_m": seen.y_m, "radius_m": seen.radius_m}}
    return {"polygon": _points(seen.outline())}


def _points(points: Any) -> list[list[float]]:
    return [[round(x_m, 6), round(y_m, 6)] for x_m, y_m in points]
