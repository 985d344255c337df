"""Shows a model what it asks to see, out of what Understanding, the lidar and the camera know."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from chatrobot.core.events import Finished, Looked
from chatrobot.dialogue.llm.camera import Camera
from chatrobot.dialogue.observations import observation
from chatrobot.models.seam import Message
from chatrobot.plan.base import Step

if TYPE_CHECKING:
    from chatrobot.dialogue.understanding import Understanding
    from chatrobot.link.motion_link import MotionLink

LOOK_S = 3.0
"""How long Motion may take to say what the lidar sees, and the camera to be found and to show something."""


class Surroundings:
    """Gives a conversation what it needs of the half that understands. `camera` is None where there is none."""

    def __init__(self, understanding: Understanding, camera: Camera | None) -> None:
        self._understanding = understanding
        self.camera = camera

    def describe(self, steps: tuple[Step, ...]) -> str:
        """Return the steps in a few words, in the person's language."""
        return self._understanding.describe(steps)

    def within_limit(self, step: Step) -> Step:
        """Return the step no faster than the person allows."""
        return self._understanding.within_limit(step)

    def observation(
        self, looks: tuple[str, ...], looked: Looked | None, finished: Finished | None
    ) -> Message:
        """Return what the model asked to see."""
        places = {**self._understanding.main_places, **self._understanding.usable_places}
        pose = finished.pose if finished is not None else self._understanding.known_pose
        return observation(looks, pose=pose, places=places, looked=looked, finished=finished, take=self._take)

    def _take(self) -> bytes | None:
        return self.camera.take() if self.camera is not None else None

    def give_up_looking(self) -> None:
        """Show no pictures any more: the model cannot see."""
        self.end_looking()
        self.camera = None

    def end_looking(self) -> None:
        """Close the camera: no model is being asked any more."""
        if self.camera is not None:
            self.camera.end()


class ObservationWait:
    """Begins at once. `hear` what Motion says, until it `is_over`.

    Args:
        looks: what the model wants to see.
    """

    def __init__(self, looks: tuple[str, ...], turn: int, link: MotionLink, camera: Camera | None) -> None:
        self.scan: Looked | None = None
        self._camera = camera if "camera" in looks else None
        self._wants_scan = "scan" in looks
        self._until_s = time.monotonic() + LOOK_S
        if self._wants_scan:
            link.send("look", turn)
        if self._camera is not None:
            self._camera.begin()

    def hear(self, scan: Looked) -> None:
        """Take in what the lidar sees."""
        self.scan = scan

    @property
    def is_over(self) -> bool:
        """True once all has been seen, or nothing more is waited for."""
        if time.monotonic() > self._until_s:
            return True
        has_scan = self.scan is not None or not self._wants_scan
        return has_scan and (self._camera is None or self._camera.has_picture)
