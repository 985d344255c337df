"""What the robot's camera sees, for pages that ask: the newest picture, a few times a second, kept nowhere."""

from __future__ import annotations

import base64
import threading
import time
from typing import Protocol

from chatrobot.dialogue.llm.camera import Camera
from chatrobot.web.outbox import Message
from chatrobot.web.words import told

PICTURE_S = 0.3
"""So often a picture is given at most, to however many pages."""
IDLE_S = 2.0
"""Where nobody has asked for so long, the camera is looked through no more."""
FIRST_S = 3.0
"""So long whoever asks waits for a camera that shows nothing yet."""


class Viewer(Protocol):
    """A page that looks."""

    def put(self, message: Message) -> None:
        """Tell it. Called on any thread; returns at once."""


class CameraView:
    """Looks through the camera while pages ask, in a thread of its own. `ask` from any thread."""

    def __init__(self, camera: Camera) -> None:
        self._camera = camera
        self._lock = threading.Lock()
        self._asking: list[Viewer] = []
        self._asked_s = 0.0
        self._is_looking = False

    def ask(self, viewer: Viewer) -> None:
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
