"""Protocols: what rehearsal and route planning ask of a world and of a governor, so that neither is imported here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from chatrobot.core.geometry import Pose, Twist

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from chatrobot.sim.shapes import Polygon
    from chatrobot.sim.world import Bounds

    Floats = NDArray[np.float64]
else:
    Floats = Any


@dataclass(frozen=True)
class Contact:
    """Says where along a path the footprint comes too close: the row of the path, and the point that is too close."""

    row: int
    x_m: float
    y_m: float


GovernorKernel = Callable[[Twist, Twist, float], Twist]
"""(what was sent last, what is asked now, seconds since) -> what may be sent now. Pure."""


class SeenWorld(Protocol):
    """Knows what the lidar has seen around the robot, as the governor does, in the odom frame."""

    def allowed_share(self, twist: Twist, pose: Pose) -> float:
        """Return the share of a twist, 0 to 1, allowed at that pose where the lidar sees as much as it does now."""
        ...

    def free_ahead_m(self, pose: Pose, direction_rad: float) -> float:
        """Return how far it is straight on to what was seen, from the front of the footprint; infinite for nothing."""
        ...

    def first_contact(self, poses: Floats) -> Contact | None:
        """Return the first of [n, 3] poses, from where the robot stands, that the governor would not allow."""
        ...


class KnownWorld(Protocol):
    """Knows what stands around the robot, in the odom frame."""

    @property
    def is_empty(self) -> bool:
        """Return True where nothing is known to stand anywhere."""
        ...

    @property
    def allowed_area(self) -> Polygon | None:
        """Return where the robot has to stay, if anybody said so."""
        ...

    @property
    def bounds(self) -> Bounds | None:
        """Return the box that holds all that is known; None in an empty world."""
        ...

    def clearance_m(self, points: Floats) -> Floats:
        """Return metres from each of [n, 2] points to the nearest obstacle, never more than it is; negative inside."""
        ...

    def obstacle_names_at(self, x_m: float, y_m: float) -> tuple[str, ...]:
        """Return the names of the obstacle nearest to a point, the main one first; empty where nobody knows one."""
        ...


def obstacle_values(names: tuple[str, ...]) -> dict[str, str]:
    """Return what a reason says of an obstacle with these names; those after the first are of other languages."""
    if not names:
        return {}
    others = {"obstacle_aliases": ", ".join(names[1:])} if len(names) > 1 else {}
    return {"obstacle": names[0], **others}
