"""The robot and its world, as a page draws them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from chatrobot.language.context import Place
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.shapes import Circle
from chatrobot.sim.world import Obstacle, World

_DIGITS = 4
"""Of a metre or radian: a tenth of a millimetre."""


def robot_facts(profile: RobotProfile, *, is_simulated: bool, has_camera: bool) -> dict[str, Any]:
    """Return what a page shows of the robot, and what its stick may ask for."""
    limits = profile.limits
    return {
        "name": profile.name,
        "title": profile.title,
        "footprint": {
            "polygon_m": _points(profile.footprint),
            "radius_m": round(profile.footprint_radius_m, _DIGITS),
        },
        "limits": {
            "max_speed_mps": limits.max_speed_mps,
            "max_sideways_mps": limits.max_sideways_mps if profile.can_go_sideways else 0.0,
            "max_rate_radps": limits.max_rate_radps,
        },
        "defaults": {"speed_mps": profile.defaults.speed_mps, "rate_radps": profile.defaults.rate_radps},
        "has_lidar": profile.lidar is not None,
        "has_camera": has_camera,
        "has_odometry": profile.has_odometry,
        "simulated": is_simulated,
        "sideways": profile.can_go_sideways,
    }


def world_facts(world: World, remembered: Mapping[str, Place]) -> dict[str, Any]:
    """Return what is known to stand around the robot, in the frame of the start, which is `odom` there."""
    return {
        "name": world.name,
        "obstacles": [_obstacle(one) for one in world.obstacles],
        "places": place_facts(world, remembered),
        "area": _points(world.allowed_area.points) if world.allowed_area is not None else None,
        "start_yaw_rad": round(world.start_yaw_rad, _DIGITS),
    }


def place_facts(world: World, remembered: Mapping[str, Place]) -> list[dict[str, Any]]:
    """Return every place that can be gone to by its name: the world's, and what a person had remembered."""
    known = dict(world.places)
    known.update({name: place.pose for name, place in remembered.items() if place.usable})
    return [
        {"name": name, "names": list(world.names_of(name)) if name in world.places else [name], **_pose(pose)}
        for name, pose in known.items()
    ]


def _pose(pose: Any) -> dict[str, float]:
    return {key: round(value, _DIGITS) for key, value in zip(pose._fields, pose)}


def _obstacle(obstacle: Obstacle) -> dict[str, Any]:
    shape = obstacle.shape
    about = {"name": obstacle.name, "names": [obstacle.name, *obstacle.aliases], "added": obstacle.is_added}
    if isinstance(shape, Circle):
        circle = {"x_m": shape.x_m, "y_m": shape.y_m, "radius_m": shape.radius_m}
        return {
            **about,
            "circle": {key: round(value, _DIGITS) for key, value in circle.items()},
        }
    return {**about, "polygon": _points(shape.points)}


def _points(points: Any) -> list[list[float]]:
    return [[round(x_m, _DIGITS), round(y_m, _DIGITS)] for x_m, y_m in points]
