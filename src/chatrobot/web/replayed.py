"""A recording in the room of a robot: pages are told what happened, and may only watch.

The room asks its session little, and what would move a robot has nobody to go to: a stop ends the replay.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from chatrobot.compose import Connection
from chatrobot.core.events import Notice, Telemetry
from chatrobot.core.reason import Reason
from chatrobot.dialogue.options import Options
from chatrobot.recording.playback import Heard, Shown
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.world import World
from chatrobot.web.access import Access
from chatrobot.web.room import Room

_PERSON = "recorded"
"""Who said what was said then: none of those who look now."""


def watching() -> Access:
    """Let everybody at this machine in, to watch."""
    return Access("127.0.0.1", open_as="watcher")


class ReplayRoom(Room):
    """A room that `show` fills. `is_halted`: somebody who watches has pressed Stop."""

    def __init__(self, profile: RobotProfile, world: World) -> None:
        super().__init__()
        self.is_halted = False
        self._last: Telemetry | None = None
        replayed = _Replayed(replace(profile, title=f"▷ {profile.title}"), world, self._halt)
        self.open(cast(Connection, replayed), lambda job: job(), is_simulated=True)
        self.hear(Notice(0, Reason("replay_begins")))

    def show(self, _t_s: float, item: Shown) -> None:
        """Tell everybody one thing of the recording."""
        if isinstance(item, Heard):
            if item.text:
                self.note_said(item.turn, item.text, _PERSON, "")
        else:
            self._last = item if isinstance(item, Telemetry) else self._last
            self.hear(item)

    def tell_again(self) -> None:
        """Tell where the robot is, as one that is there does all the time: somebody may just have come."""
        if self._last is not None:
            self.hear(self._last)

    def tell_end(self) -> None:
        """Tell everybody that there is no more."""
        self.hear(Notice(0, Reason("replay_ended")))

    def _halt(self) -> None:
        self.is_halted = True


class _Replayed:
    """Connection and session at once, as far as a room and those who watch ask."""

    authoring = camera = None
    is_moving = is_plan_paused = False

    def __init__(self, profile: RobotProfile, world: World, halt: Any) -> None:
        self.profile, self.world, self._halt = profile, world, halt
        self.options = Options()
        self.results: dict[int, Any] = {}
        self.session = self.understanding = self.places = self

    def all(self) -> dict[str, Any]:
        """Return the places that were remembered: those of that time are not kept."""
        return {}

    def watch_scans(self, _: bool) -> None:
        """Scans come anyway."""

    def stop(self, _: str = "") -> None:
        """End the replay."""
        self._halt()

    emergency_stop = stop

    def release(self) -> None:
        """There is nothing to be released."""
