"""Who else drives this robot: other Motions, which must be gone or accepted, and other publishers, who are named."""

from __future__ import annotations

import json
import os
import socket
import time
import uuid
from typing import Any

from chatrobot.core.reason import Reason
from chatrobot.link.envelope import PROTOCOL
from chatrobot.link.topic_link import CONTROL, read_beat
from chatrobot.wire.messages import Text
from chatrobot.wire.wire import Wire

MANY_SOURCES = 20
MANY_MOTIONS = 20
SILENT_S = 1.0
"""A Motion that has not been heard for so long has left, or was killed; discovery may take longer to see it."""
NODES = ("chatrobot_motion", "chatrobot_control")
"""How our own Motions appear on a wire that knows names."""
GUARDS = ("chatrobot_guard",)


class CompetingControllers:
    """Tells others that this Motion is there, and hears who else is.

    Args:
        node: our own name on the wire.
        topic: where velocities go.
        open_loop: what a person should know of a robot that is driven open loop; None for any other.
    """

    def __init__(self, wire: Wire, node: str, topic: str, open_loop: Reason | None = None) -> None:
        self._wire = wire
        self._topic = topic
        self._id = uuid.uuid4().hex
        self._about: dict[str, Any] = {
            "id": self._id,
            "node": node,
            "host": socket.gethostname(),
            "pid": os.getpid(),
            "protocol": PROTOCOL,
        }
        if open_loop is not None:
            self._about["open_loop"] = dict(open_loop.values)
        self._hears: dict[str, None] = {}
        self._said = ""
        self._said_of: dict[str, None] | None = None
        self._heard: dict[str, tuple[float, str]] = {}
        wire.advertise(CONTROL, Text)
        wire.subscribe(CONTROL, Text, self._hear)

    def note_source(self, lease: str) -> None:
        """A source has been heard; it may wait for that before it says anything that matters. From any thread."""
        if lease not in self._hears:
            self._hears = dict.fromkeys([*self._hears, lease][-MANY_SOURCES:])

    def beat(self) -> None:
        """Say that we are there, and whom we hear; every `PRESENCE_S`."""
        hears = self._hears
        if hears is not self._said_of:
            about = {**self._about, "hears": list(hears)}
            self._said, self._said_of = json.dumps(about, separators=(",", ":")), hears
        self._wire.publish(CONTROL, Text(self._said))

    def motions(self) -> list[str]:
        """The other Motions on this robot, by name."""
        now_s = time.monotonic()
        beating = {name for at_s, name in tuple(self._heard.values()) if now_s - at_s < SILENT_S}
        return sorted(beating) or [name for name in self._publishers() if _node(name) in NODES]

    def others(self) -> list[str]:
        """Who else publishes velocities and is none of ours."""
        return [name for name in self._publishers() if _node(name) not in (*NODES, *GUARDS)]

    def _publishers(self) -> list[str]:
        return self._wire.publishers_of(self._topic)

    def _hear(self, message: Text) -> None:
        if message.data == self._said:
            return  # we hear ourselves
        about = read_beat(message.data)
        if about is not None and about.id != self._id:
            # As a whole, for another thread reads it; the longest-silent stand first.
            heard = {id: news for id, news in self._heard.items() if id != about.id}
            heard[about.id] = (time.monotonic(), about.name)
            self._heard = dict(list(heard.items())[-MANY_MOTIONS:])


def _node(name: str) -> str:
    return name.rpartition("/")[2]
