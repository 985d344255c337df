"""The robot and its world, as a page draws them; and what its camera sees, for pages that ask.

Of a camera that is the newest picture, a few times a second, kept nowhere.
"""

from __future__ import annotations

import base64
import threading
import time
from collections.abc import Mapping, Sequence
from typing import Any

from chatrobot.dialogue.llm.camera import Camera
from chatrobot.language.context import Place
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.language.phrases import by_language
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.shapes import Circle
from chatrobot.sim.world import Obstacle, World
from chatrobot.web.outbox import Face
from chatrobot.web.words import told

_DIGITS = 4
"""Of a metre or radian: a tenth of a millimetre."""
PICTURE_S = 0.3
"""So often a picture is given at most, to however many pages."""
IDLE_S = 2.0
"""Where nobody has asked for so long, the camera is looked through no more."""
FIRST_S = 3.0
"""So long whoever asks waits for a camera that shows nothing yet."""


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
    named = {name: world.names_of(name) if name in world.places else (name,) for name in known}
    return [{"name": name, **_called(named[name]), **_pose(pose)} for name, pose in known.items()]


def _called(names: Sequence[str]) -> dict[str, Any]:
    """All names of a place or thing, and what a page calls it, by language."""
    return {"names": list(names), "called": {code: by_language(names, code)[0] for code in REPLY_LANGUAGES}}


def _pose(pose: Any) -> dict[str, float]:
    return {key: round(value, _DIGITS) for key, value in zip(pose._fields, pose)}


def _obstacle(obstacle: Obstacle) -> dict[str, Any]:
    shape = obstacle.shape
    called = _called((obstacle.name, *obstacle.aliases))
    about = {"name": obstacle.name, **called, "added": obstacle.is_added}
    if isinstance(shape, Circle):
        circle = {"x_m": shape.x_m, "y_m": shape.y_m, "radius_m": shape.radius_m}
        return {
            **about,
            "circle": {key: round(value, _DIGITS) for key, value in circle.items()},
        }
    return {**about, "polygon": _points(shape.points)}


def _points(points: Any) -> list[list[float]]:
    return [[round(x_m, _DIGITS), round(y_m, _DIGITS)] for x_m, y_m in points]


class CameraView:
    """Looks through the camera while pages ask, in a thread of its own. `ask` from any thread."""

    def __init__(self, camera: Camera) -> None:
        self._camera = camera
        self._lock = threading.Lock()
        self._asking: list[Face] = []
        self._asked_s = 0.0
        self._is_looking = False

    def ask(self, viewer: Face) -> None:
        """Have that page told the next picture, or that there is none."""
        with self._lock:
            if viewer not in self._asking:
                self._asking.append(viewer)
            self._asked_s = time.monotonic()
            starts, self._is_looking = not self._is_looking, True
        if starts:
            threading.Thread(target=self._look, name="camera view", daemon=True).start()

    def _look(self) -> None:
        self._camera.begin()
        try:
            while not self._is_idle():
                if self._asking:
                    self._show()
                time.sleep(PICTURE_S)
        finally:
            self._camera.end()

    def _is_idle(self) -> bool:
        with self._lock:
            self._is_looking = bool(self._asking) or time.monotonic() - self._asked_s < IDLE_S
            return not self._is_looking

    def _show(self) -> None:
        ends_s = time.monotonic() + FIRST_S
        while not self._camera.has_picture and time.monotonic() < ends_s:
            time.sleep(0.02)
        picture = self._camera.take() if self._camera.has_picture else None
        with self._lock:
            asking, self._asking = self._asking, []
        message = told("picture", data=_as_address(picture) if picture else None)
        for viewer in asking:
            viewer.put(message)


def _as_address(picture: bytes) -> str:
    kind = "png" if picture.startswith(b"\x89PNG") else "jpeg"
    return f"data:image/{kind};base64,{base64.b64encode(picture).decode()}"
