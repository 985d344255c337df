"""The map of ROS's map_server as walls: `map.yaml` and its picture, a PGM or PNG.

Occupied cells are merged into rectangles, so that what is known of worlds holds for maps: rehearsal, lidar, contact and
drawing ask for shapes. What is free and what nobody knows are alike: nothing stands there.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.core.geometry import Pose
from chatrobot.sim.fields import Field
from chatrobot.sim.shapes import Polygon, rectangle
from chatrobot.sim.world import Obstacle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")
"""Of a map.yaml; the keys of a world may stand beside them."""
WALL, WALL_ALIASES = "wall", ("墙",)
"""What occupied cells are called."""
MAX_CELLS = 16_000_000
MAX_RECTANGLES = 20_000
"""Of a picture that is no map, a photograph for one, there are more."""
_OCCUPIED_SHARE = 0.65
"""The `occupied_thresh` of a file without one, as map_server has it."""


def walls_of(fields: dict[str, Field], folder: Path) -> tuple[Obstacle, ...]:
    """Return what is occupied, in the frame of the map.

    Args:
        fields: those of `KEYS` that the file has; image, resolution and origin at least.
        folder: what the image's path is relative to.

    Raises:
        WorldError: a field, or the picture, cannot be used.
    """
    resolution_m = fields["resolution"].number(0.001, 10.0)
    origin = _origin(fields["origin"])
    rectangles = _merged(_occupied(fields, folder))
    if len(rectangles) > MAX_RECTANGLES:
        raise fields["image"].error(
            f"has {len(rectangles)} separate pieces of wall: is this a map?", f"{MAX_RECTANGLES} at most"
        )
    walls = []
    for row, column, height, width in rectangles:
        length_m, width_m = width * resolution_m, height * resolution_m
        centre = origin.compose(
            Pose(column * resolution_m + length_m / 2.0, row * resolution_m + width_m / 2.0)
        )
        shape: Polygon = rectangle(centre.x_m, centre.y_m, length_m, width_m, origin.yaw_rad)
        walls.append(Obstacle(WALL, shape, WALL_ALIASES))
    return tuple(walls)


def _origin(field: Field) -> Pose:
    """Where the lower left corner of the picture lies."""
    numbers = field.items()
    if len(numbers) != 3:
        raise field.error(f"has {len(numbers)} numbers", "[x, y, yaw]: metres and radians")
    x, y, yaw = (number.number() for number in numbers)
    return Pose(x, y, math.remainder(yaw, math.tau))


def _occupied(fields: dict[str, Field], folder: Path) -> NDArray[np.bool_]:
    """[rows, columns], the lowest row first."""
    import numpy as np

    if "mode" in fields:
        fields["mode"].choice("trinary", "scale")
    negate = "negate" in fields and fields["negate"].choice("0", "1", "false", "true") in ("1", "true")
    share = fields["occupied_thresh"].number(0.0, 1.0) if "occupied_thresh" in fields else _OCCUPIED_SHARE
    if "free_thresh" in fields and fields["free_thresh"].number(0.0, 1.0) > share:
        raise fields["free_thresh"].error("is above occupied_thresh", "less than that")
    grey, is_opaque = _pixels(fields["image"], folder)
    occupied = (grey if negate else 1.0 - grey) > share
    occupied &= is_opaque
    upright: NDArray[np.bool_] = np.flipud(occupied)
    return upright


def _pixels(field: Field, folder: Path) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """How bright each pixel is, 0 to 1, and where the picture is not transparent: there nothing is known."""
    import numpy as np
    from PIL import Image, UnidentifiedImageError

    path = folder / field.text()
    try:
        with Image.open(path) as picture:
            if picture.width * picture.height > MAX_CELLS:
                raise field.error(f"has {picture.width} × {picture.height} pixels", f"{MAX_CELLS} at most")
            if picture.mode == "F":
                raise field.error(f"{path} has fractions for pixels", "a PGM or PNG of 8 or 16 bits")
            is_wide = picture.mode.startswith("I")  # 16 bits a pixel
            pixels = np.asarray(picture if is_wide else picture.convert("RGBA"), dtype=float)
    except FileNotFoundError:
        raise field.error(f"there is no file {path}", "a path beside this file") from None
    except (OSError, UnidentifiedImageError, Image.DecompressionBombError, ValueError) as error:
        raise field.error(
            f"{path} is no picture: {getattr(error, 'strerror', None) or error}", "a PGM or PNG"
        ) from error
    if is_wide:
        return pixels / 65535.0, np.ones(pixels.shape, dtype=bool)
    return pixels[..., :3].mean(axis=2) / 255.0, pixels[..., 3] > 0


Piece = tuple[int, int, int, int]
"""The lowest row, the first column, how many rows and columns."""


def _merged(occupied: NDArray[np.bool_]) -> list[Piece]:
    """Cover all occupied cells with rectangles that do not overlap: by rows or by columns, whichever are fewer."""
    by_rows = _runs(occupied)
    by_columns = [(column, row, width, height) for row, column, height, width in _runs(occupied.T)]
    return min(by_rows, by_columns, key=len)


def _runs(occupied: NDArray[np.bool_]) -> list[Piece]:
    """Runs of cells along a row; those of the same columns in rows on top of each other are one."""
    import numpy as np

    edges = np.diff(np.pad(occupied.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    rows, begins = np.nonzero(edges == 1)
    ends = np.nonzero(edges == -1)[1]
    done: list[Piece] = []
    growing: dict[tuple[int, int], int] = {}
    last = -1
    before: dict[tuple[int, int], int] = {}
    for row, begin, end in zip(rows.tolist(), begins.tolist(), ends.tolist()):
        if row != last:
            # Only what was there in the row just below can grow.
            growing, before = {}, growing if row == last + 1 else {}
            last = row
        key = (begin, end)
        first = before.pop(key, None)
        growing[key] = len(done) if first is None else first
        if first is None:
            done.append((row, begin, 1, end - begin))
        else:
            low, column, height, width = done[first]
            done[first] = (low, column, height + 1, width)
    return done


def is_map(root: Field) -> bool:
    """Return whether a file is a map.yaml."""
    return root.has("image") or root.has("resolution")
