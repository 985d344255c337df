"""What a model is shown when it asks to look: numbers and quoted names, a line each, marked as data."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from chatrobot.core.events import Finished, Looked
from chatrobot.core.geometry import Pose
from chatrobot.dialogue.llm.prompt import place_lines, pose_line
from chatrobot.models.seam import Message

_SECTORS = ("ahead", "ahead left", "left", "behind left", "behind", "behind right", "right", "ahead right")
ATTACHED = "data: the camera picture is attached"
SEEN = "data: there was a camera picture here"
NOTHING = "data: no camera picture to be had"


def observation(
    looks: tuple[str, ...],
    *,
    pose: Pose | None,
    places: Mapping[str, Pose],
    looked: Looked | None,
    finished: Finished | None,
    take: Callable[[], bytes | None],
) -> Message:
    """The answer to a `look` line. What became of the last motion always comes first. `take` takes a picture."""
    lines = [outcome_line(finished)] if finished is not None or "outcome" in looks else []
    picture: bytes | None = None
    for look in looks:
        if look == "pose":
            lines.append(pose_line(pose))
        elif look == "scan":
            lines.append(scan_line(looked))
        elif look == "places":
            lines += place_lines(places) or ["data: no places are known"]
        elif look == "camera":
            picture = take()
            lines.append(ATTACHED if picture else NOTHING)
    lines.append("Go on with plan text; end without `look` when the task is done.")
    return Message("user", "\n".join(lines), picture)


def without_pictures(messages: Sequence[Message]) -> list[Message]:
    """The same in words alone: an older picture is sent again with no later call."""
    return [
        replace(message, picture=None, text=message.text.replace(ATTACHED, SEEN))
        if message.picture
        else message
        for message in messages
    ]


def outcome_line(finished: Finished | None) -> str:
    """What the robot has measured of its last motion, never what was asked for."""
    if finished is None:
        return "data: nothing has moved yet"
    why = f" ({finished.reason.code})" if finished.reason is not None else ""
    return (
        f"data: the last motion was {finished.outcome}{why}: {measured(finished)}; "
        f"{finished.steps_done} of {finished.steps} steps done"
    )


def measured(finished: Finished) -> str:
    """What odometry shows, in numbers."""
    if not finished.measured:
        return "nobody knows how far, this robot does not measure its motion"
    of_all = "" if finished.open_ended else f" of {finished.planned_m:.2f} m"
    return f"drove {finished.path_m:.2f} m{of_all}, turned {math.degrees(finished.turned_rad):.0f} deg"


def scan_line(looked: Looked | None) -> str:
    """The free way in each direction."""
    if looked is None or not looked.sectors_m:
        return "data: no lidar scan to be had"
    told = (f"{name} {'free' if d is None else f'{d:.2f} m'}" for name, d in zip(_SECTORS, looked.sectors_m))
    return f"data: free way to the nearest thing seen: {', '.join(told)}"
