"""What a model is told besides its prompt: earlier turns, and what it asked to look at, marked as data.

Earlier turns are bounded, and shortened by half at a time, so that a provider's cache hits for many turns in a row.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from chatrobot.core.events import Finished, Looked
from chatrobot.core.geometry import Pose
from chatrobot.core.shown import one_line
from chatrobot.dialogue.llm.prompt import place_lines, pose_line
from chatrobot.models.seam import Message

BUDGET_CHARS = 2400
"""About 600 tokens of earlier turns in a prompt."""

SUMMARY_CHARS = 240
ANSWER_CHARS = 800


@dataclass(frozen=True)
class Exchange:
    """One turn. `request` is the message as the model got it, empty where it was not asked; `answer` is its reply or
    the plan that was understood without it; `end` is what became of it."""

    text: str
    answer: str
    end: str
    request: str = ""

    @property
    def chars(self) -> int:
        return len(self.request or self.text) + len(self.answer) + len(self.end)


class History:
    """The exchanges of one conversation. `pinned` ones stay whatever happens (the tutorial's first instruction)."""

    def __init__(self) -> None:
        self._pinned: list[Exchange] = []
        self._kept: list[Exchange] = []
        self._forgotten: list[str] = []
        self._count = 0

    def add(self, exchange: Exchange, *, pin: bool = False) -> None:
        (self._pinned if pin else self._kept).append(exchange)
        if sum(kept.chars for kept in self._kept) > BUDGET_CHARS:
            while len(self._kept) > 1 and sum(kept.chars for kept in self._kept) > BUDGET_CHARS / 2:
                self._forget(self._kept.pop(0))

    def _forget(self, exchange: Exchange) -> None:
        self._count += 1
        self._forgotten.append(f"{one_line(exchange.text, 40)} ({one_line(exchange.end, 40)})")
        while len("; ".join(self._forgotten)) > SUMMARY_CHARS:
            self._forgotten.pop(0)

    def messages(self) -> tuple[list[Message], list[str]]:
        """Earlier messages, and the news since the model last spoke, a line each, for the next one."""
        messages: list[Message] = []
        news = (
            [f"data: {self._count} earlier turns, the last: {'; '.join(self._forgotten)}"]
            if self._count
            else []
        )
        for exchange in (*self._pinned, *self._kept):
            if exchange.request:
                messages.append(Message("user", "\n".join([*news, exchange.request])))
                messages.append(Message("assistant", exchange.answer[:ANSWER_CHARS] or "# nothing"))
                news = [f"data: that ended: {one_line(exchange.end, 200)}"] if exchange.end else []
            else:
                said, did = one_line(exchange.text, 120), one_line(exchange.answer, 160)
                news.append(f"data: understood without you: {said} → {did}: {one_line(exchange.end, 160)}")
        return messages, news


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
