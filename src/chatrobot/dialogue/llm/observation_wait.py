"""A model has asked to look: what it wants to see is on its way."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from chatrobot.core.events import Looked
from chatrobot.dialogue.llm.terms import Surroundings

if TYPE_CHECKING:
    from chatrobot.link.motion_link import MotionLink

LOOK_S = 3.0
"""How long Motion may take to say what the lidar sees, and the camera to be found and to show something."""


class ObservationWait:
    """Begins at once. `hear` what Motion says, until it `is_over`.

    Args:
        looks: what the model wants to see.
    """

    def __init__(
        self, looks: tuple[str, ...], turn: int, link: MotionLink, surroundings: Surroundings
    ) -> None:
        self.scan: Looked | None = None
        self._surroundings = surroundings
        self._wants_scan, self._wants_picture = "scan" in looks, "camera" in looks
        self._until_s = time.monotonic() + LOOK_S
        if self._wants_scan:
            link.send("look", turn)
        if self._wants_picture:
            surroundings.begin_looking()

    def hear(self, scan: Looked) -> None:
        """What the lidar sees."""
        self.scan = scan

    @property
    def is_over(self) -> bool:
        """All has been seen, or nothing more is waited for."""
        if time.monotonic() > self._until_s:
            return True
        has_scan = self.scan is not None or not self._wants_scan
        return has_scan and (not self._wants_picture or self._surroundings.has_picture)
