"""Takes pictures for a model: with a robot's camera on its wire, or with what the caller of the API passed.

Pictures have an end of the wire of their own, open only while a model looks: a megabyte of picture must not stand
before a stop in a socket, nor cost anything as long as nobody looks.
"""

from __future__ import annotations

import io
import struct
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.connect import connect_wire
from chatrobot.wire.messages import Picture
from chatrobot.wire.wire import Wire

if TYPE_CHECKING:
    from PIL import Image


FRESH_S = 1.0
"""An older picture is not shown as what the robot sees now."""

NODE = "chatrobot_camera"


class Camera(Protocol):
    """Belongs to one thread. `begin` when a model wants to see, `take` once `has_picture`, `end` with its turn."""

    def begin(self) -> None:
        """Begin to look. Returns at once; looking already is fine."""

    @property
    def has_picture(self) -> bool:
        """Tell whether `take` would give one."""

    def take(self) -> bytes | None:
        """Return what the robot sees now, as JPEG or PNG; None where that is not known."""

    def end(self) -> None:
        """Look no more. Returns at once."""


class PassedCamera:
    """Calls a function of somebody else's that takes a picture when it is called."""

    has_picture = True

    def __init__(self, take: Callable[[], bytes | None]) -> None:
        self.take = take

    def begin(self) -> None:
        """Do nothing: the function is called when the picture is needed."""

    def end(self) -> None:
        """Do nothing: nothing is open."""


class WireCamera:
    """Camera of a robot on a wire.

    Args:
        open_wire: opens an end of the robot's wire, for pictures alone; it may take its time.
        topic: of the camera.
        now_s: the clock of the pictures' stamps.
    """

    def __init__(
        self, open_wire: Callable[[], Wire], topic: str, now_s: Callable[[], float] = time.monotonic
    ) -> None:
        self._open_wire = open_wire
        self._topic = topic
        self._now_s = now_s
        self._view: _View | None = None

    def begin(self) -> None:
        """Open the wire, in a thread of its own."""
        if self._view is None:
            self._view = _View(self._open_wire, self._topic)

    @property
    def has_picture(self) -> bool:
        """Tell whether one came within `FRESH_S`."""
        return self._fresh() is not None

    def take(self) -> bytes | None:
        """Return the newest as JPEG; None where it is too old or cannot be read."""
        picture = self._fresh()
        return as_jpeg(picture) if picture is not None else None

    def end(self) -> None:
        """Close the wire."""
        view, self._view = self._view, None
        if view is not None:
            view.ended.set()

    def _fresh(self) -> Picture | None:
        picture = self._view.newest if self._view is not None else None
        return picture if picture is not None and self._now_s() - picture.stamp_s <= FRESH_S else None


def wire_camera(address: str, wiring: Wiring) -> WireCamera | None:
    """Return the camera of the robot at that wire's address; None where its profile names none. Opens nothing."""
    if not wiring.camera_topic:
        return None
    return WireCamera(lambda: connect_wire(address, wiring, NODE), wiring.camera_topic)


class _View:
    """Open eye: a thread opens the wire, and closes it when `ended` is set."""

    def __init__(self, open_wire: Callable[[], Wire], topic: str) -> None:
        self.newest: Picture | None = None
        self.ended = threading.Event()
        self._open_wire = open_wire
        self._topic = topic
        threading.Thread(target=self._look, name="camera", daemon=True).start()

    def _look(self) -> None:
        try:
            wire = self._open_wire()
        except (WireError, UsageError):
            return  # the model is told that there is no picture
        try:
            if not self.ended.is_set():
                wire.subscribe(self._topic, Picture, self._keep)
                self.ended.wait()
        except WireError:
            return
        finally:
            wire.close()

    def _keep(self, picture: Picture) -> None:
        self.newest = picture


MOST_SIDE_PX = 640
"""VGA: every model that can see reads as much in it as in a larger one that it would shrink by itself; with Anthropic
it costs 410 tokens (width times height over 750)."""
MOST_PIXELS = 33_177_600
"""8K. A file that claims more is not unpacked."""
QUALITY = 80
_BROKEN = (OSError, ValueError, SyntaxError, EOFError, IndexError, TypeError, struct.error, MemoryError)
"""What pillow raises over a file that is none."""


def as_jpeg(picture: Picture) -> bytes | None:
    """Return `picture` as a JPEG file of at most `MOST_SIDE_PX` a side, without what a camera writes into its files
    besides; None where it cannot be read.

    JPEG, because the PNG of a photograph is ten times as long, and a model waits for it to be sent.
    """
    from PIL import Image

    try:
        image = _opened(picture)
        if image is None:
            return None
        image.thumbnail((MOST_SIDE_PX, MOST_SIDE_PX), reducing_gap=2.0)
        file = io.BytesIO()
        image.convert("L" if image.mode == "L" else "RGB").save(file, "JPEG", quality=QUALITY)
    except (*_BROKEN, Image.DecompressionBombError):
        return None
    return file.getvalue()


def _opened(picture: Picture) -> Image.Image | None:
    from PIL import Image

    if picture.encoding in ("jpeg", "png"):
        opened = Image.open(io.BytesIO(picture.data), formats=(picture.encoding.upper(),))
        return opened if opened.width * opened.height <= MOST_PIXELS else None
    mode, order = {"rgb8": ("RGB", "RGB"), "bgr8": ("RGB", "BGR"), "mono8": ("L", "L")}[picture.encoding]
    size = (picture.width_px, picture.height_px)
    return Image.frombytes(mode, size, picture.data, "raw", order, picture.row_bytes)
