"""What stands where: what an agent sees of the robot's surroundings, by name, by direction, and in a picture."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from typing import Any

from chatrobot.compose import Connection
from chatrobot.core.events import Looked, Telemetry
from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.core.reason import fixed
from chatrobot.dialogue.llm.camera import Camera
from chatrobot.execution.estimator import stands
from chatrobot.link.processes import SIMULATED
from chatrobot.mcp_server.told import in_words, pose_told, tidy
from chatrobot.sim.world import World

DIRECTIONS = ("ahead", "ahead left", "left", "behind left", "behind", "behind right", "right", "ahead right")
NEAR_M = 2.5
HERE_M = 0.05
MOST_NEAR = 8
OLD_S = 1.0
"""Older news of the robot are none."""
PICTURE_S = 3.0

Point = tuple[float, float]


def direction_of(pose: Pose, point: Point) -> tuple[float, str]:
    """Return the bearing of a point, degrees to the left of straight ahead, and in words."""
    bearing_rad = math.atan2(point[1] - pose.y_m, point[0] - pose.x_m) - pose.yaw_rad
    bearing_rad = wrap_angle(bearing_rad)
    return tidy(math.degrees(bearing_rad), 0), DIRECTIONS[round(bearing_rad / (math.pi / 4.0)) % 8]


def things_near(world: World, pose: Pose) -> list[dict[str, Any]]:
    """Return the obstacles of the known world around `pose`, the nearest first, each name once."""
    nearest: dict[str, tuple[float, Point]] = {}
    for obstacle in world.obstacles:
        point = _nearest_point(obstacle.shape.outline(), pose)
        distance_m = max(0.0, obstacle.shape.distance_m(pose.x_m, pose.y_m))
        if distance_m <= NEAR_M and distance_m < nearest.get(obstacle.name, (math.inf,))[0]:
            nearest[obstacle.name] = (distance_m, point)
    told = []
    for name, (distance_m, point) in sorted(nearest.items(), key=lambda item: item[1][0])[:MOST_NEAR]:
        bearing_deg, words = direction_of(pose, point)
        told.append(
            {"name": name, "distance_m": round(distance_m, 2), "bearing_deg": bearing_deg, "side": words}
        )
    return told


def _nearest_point(outline: Iterable[Point], pose: Pose) -> Point:
    points = tuple(outline)
    at = (pose.x_m, pose.y_m)
    edges = zip(points, (*points[1:], points[0]))
    return min((_on_segment(at, a, b) for a, b in edges), key=lambda point: math.dist(at, point))


def _on_segment(at: Point, a: Point, b: Point) -> Point:
    dx_m, dy_m = b[0] - a[0], b[1] - a[1]
    length2 = dx_m * dx_m + dy_m * dy_m
    share = ((at[0] - a[0]) * dx_m + (at[1] - a[1]) * dy_m) / length2 if length2 else 0.0
    share = max(0.0, min(1.0, share))
    return a[0] + share * dx_m, a[1] + share * dy_m


def places_of(connection: Connection, pose: Pose | None) -> list[dict[str, Any]]:
    """Return every place that can be gone to, with all its names; the nearest first where the pose is known."""
    understanding = connection.session.understanding
    own, world = understanding.usable_places, understanding.main_places
    told: list[dict[str, Any]] = []
    for names in understanding.place_names():
        at = own.get(names[0]) or world.get(names[0])
        if at is None:
            continue
        place: dict[str, Any] = {"name": names[0], "also": list(names[1:]), **pose_told(at)}
        if pose is not None:
            bearing_deg, words = direction_of(pose, (at.x_m, at.y_m))
            beeline_m = round(pose.distance_to(at), 2)
            place |= {"beeline_m": beeline_m, "bearing_deg": bearing_deg, "side": words}
        told.append(place)
    return sorted(told, key=lambda place: place.get("beeline_m", 0.0))


def lost_places(connection: Connection) -> list[str]:
    """Return the places of earlier sessions: nobody knows whether odometry has begun anew since."""
    places = connection.session.understanding.places.all()
    return sorted(name for name, place in places.items() if not place.usable)


def map_of(connection: Connection, pose: Pose | None) -> dict[str, Any]:
    """Return the known world, its places, and where the robot is."""
    world, profile = connection.world, connection.profile
    return {
        "frame": "odom: metres from where the robot started, x ahead and y to the left of it then",
        "world": world.name,
        "obstacles": [
            {"name": name, "polygon_m": [[round(x, 3), round(y, 3)] for x, y in outline]}
            for name, outline in world.outline()
        ],
        "places": places_of(connection, pose),
        "allowed_area_m": [list(point) for point in world.allowed_area.points]
        if world.allowed_area
        else None,
        "robot": {
            "name": profile.name,
            "footprint_m": [list(point) for point in profile.footprint],
            "pose": pose_told(pose) if pose is not None else None,
        },
    }


def robot_told(connection: Connection, *, is_shared: bool) -> dict[str, Any]:
    """Return which robot it is: an agent may have meant another one."""
    return {
        "name": connection.profile.name,
        "simulated": connection.prepared.setup.on in SIMULATED,
        "world": connection.world.name,
        "shared_with": "chatrobot web" if is_shared else None,
    }


def sectors_told(looked: Looked | None) -> dict[str, float | None] | None:
    """Return the free way by direction, metres from the robot's edge; None where nothing is seen there."""
    if looked is None or not looked.sectors_m:
        return None
    return {
        name: None if free_m is None else round(free_m, 2)
        for name, free_m in zip(DIRECTIONS, looked.sectors_m)
    }


def motion_told(telemetry: Telemetry | None, heard_at_s: float) -> dict[str, Any]:
    """Return where the robot is and how it moves; `is_heard` is false where it has fallen silent."""
    if telemetry is None:
        return {"is_heard": False}
    twist = telemetry.twist
    return {
        "is_heard": time.monotonic() - heard_at_s <= OLD_S,
        "pose": pose_told(telemetry.pose),
        "moving": moves(telemetry),
        "speed_mps": round(twist.speed_mps, 3),
        "turning_degps": tidy(math.degrees(twist.wz_radps), 1),
        "path_m": round(telemetry.path_m, 2),
        "battery_percent": telemetry.battery_percent,
        "nearest_obstacle_m": telemetry.nearest_obstacle_m,
    }


def moves(telemetry: Telemetry) -> bool:
    """Tell whether it moves: a motion is under way, or has ended while the robot still rolls."""
    return telemetry.moving or not stands(telemetry.twist)


def take_picture(camera: Camera) -> bytes | None:
    """Look through the camera once; blocks until there is a picture, or `PICTURE_S` are over."""
    camera.begin()
    try:
        ends_s = time.monotonic() + PICTURE_S
        while not camera.has_picture and time.monotonic() < ends_s:
            time.sleep(0.02)
        return camera.take()
    finally:
        camera.end()


def place_in_words(place: dict[str, Any]) -> str:
    """Return a place of `places_of` in a few words, by its first name."""
    where = f"{place['name']} at ({fixed(place['x_m'], 2)}, {fixed(place['y_m'], 2)})"
    if "side" not in place:
        return where
    return (
        f"{where}, {place['beeline_m']:.1f} m {place['side']}"
        if place["beeline_m"] > HERE_M
        else f"{where}, here"
    )


def seen_in_words(data: dict[str, Any]) -> str:
    """Return what is observed in a few lines."""
    robot = data["robot"]
    kind = f"simulated in the world {robot['world']}" if robot["simulated"] else "real"
    whose = "of the person's chatrobot web" if robot["shared_with"] else "of this server alone"
    lines = [f"Robot {robot['name']}, {kind}, {whose}."]
    if "pose" not in data:
        lines.append("The robot has not said where it is.")
    else:
        how = (
            f"moving at {data['speed_mps']:.2f} m/s, turning {data['turning_degps']:.0f} deg/s"
            if data["moving"]
            else "standing"
        )
        old = "" if data["is_heard"] else " (old: the robot has fallen silent)"
        lines.append(f"The robot is {in_words(data['pose'])}, {how}{old}.")
    if data["free_way_m"]:
        free = (f"{side} {'free' if m is None else f'{m:.2f}'}" for side, m in data["free_way_m"].items())
        lines.append(f"Free way by lidar, m: {', '.join(free)}.")
    if data["near"]:
        near = (f"{thing['name']} {thing['distance_m']:.2f} m {thing['side']}" for thing in data["near"])
        lines.append(f"Near, from the robot's centre: {'; '.join(near)}.")
    for key, words in (
        ("emergency_stop", "Emergency stop is set: "),
        ("waiting_for_approval_at", "Waiting for approval at "),
    ):
        if key in data:
            lines.append(f"{words}{data[key]}")
    if data.get("paused"):
        lines.append('A plan is paused: instruct("continue") goes on with it.')
    if data["happened"]:
        lines.append("Last: " + " | ".join(data["happened"][:4]))
    return "\n".join(lines)
