"""A camera's picture as a model is shown it: a JPEG of bounded size, whatever it was on the wire."""

from __future__ import annotations

import io
import struct
from typing import TYPE_CHECKING

from chatrobot.wire.messages import Picture

if TYPE_CHECKING:
    from PIL import Image

MOST_SIDE_PX = 640
"""VGA: every model that can see reads as much in it as in a larger one that it would shrink by itself; with Anthropic
it costs 410 tokens (width times height over 750)."""
MOST_PIXELS = 33_177_600
"""8K. A file that claims more is not unpacked."""
QUALITY = 80
_BROKEN = (OSError, ValueError, SyntaxError, EOFError, IndexError, TypeError, struct.error, MemoryError)
"""What pillow raises over a file that is none."""


def as_jpeg(picture: Picture) -> bytes | None:
    """`picture` as a JPEG file of at most `MOST_SIDE_PX` a side, without what a camera writes into its files besides;
    None where it cannot be read.

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
