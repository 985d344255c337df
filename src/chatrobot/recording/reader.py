"""Reads a recording into memory: what `replay` shows again and `report` draws.

A bag of somebody else's, with the same topics and no metadata of ours, is read as well.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from chatrobot.core.errors import UsageError
from chatrobot.recording.topics import (
    CMD_VEL,
    EVENTS,
    GROUND_TRUTH,
    MESSAGE_ENCODING,
    METADATA,
    ODOM,
    SCAN,
    TOPICS,
    USER_INPUT,
)
from chatrobot.wire.messages import LaserScan, Message, Odometry, Text, TwistMessage

NS_PER_S = 1e9
Kind = TypeVar("Kind", bound=Message)
Timed = list[tuple[float, Kind]]
ALLOWED = "an .mcap file that chatrobot, or ros2 bag record --storage mcap, has written"


@dataclass
class Recording:
    """All of a recording, each message with its seconds since the first one.

    `meta` is the metadata record, empty where the file has none; `began_ns` is when the first message was received,
    nanoseconds since 1970, 0 in a recording of nothing. `words` are what a person said.
    """

    path: Path
    meta: Mapping[str, str] = field(default_factory=dict)
    began_ns: int = 0
    duration_s: float = 0.0
    events: list[tuple[float, dict[str, Any]]] = field(default_factory=list)
    odometry: Timed[Odometry] = field(default_factory=list)
    truth: Timed[Odometry] = field(default_factory=list)
    commands: Timed[TwistMessage] = field(default_factory=list)
    scans: Timed[LaserScan] = field(default_factory=list)
    words: list[tuple[float, str]] = field(default_factory=list)


def read(path: Path) -> Recording:
    """Read the recording in a file that is whole (`repair` sees to that).

    Raises:
        UsageError: it is no recording.
        OSError: it cannot be read.
    """
    from mcap.exceptions import McapError
    from mcap.reader import make_reader

    recording = Recording(path)
    with path.open("rb") as file:
        try:
            reader = make_reader(file)
            for about in reader.iter_metadata():
                if about.name == METADATA:
                    recording.meta = dict(about.metadata)
            by_name = {topic.name: topic for topic in TOPICS}
            _take_all(recording, reader.iter_messages(topics=list(by_name)))
        except (McapError, ValueError, UnicodeDecodeError) as error:
            raise UsageError("is not a recording, or is broken", where=str(path), allowed=ALLOWED) from error
    return recording


def _take_all(recording: Recording, messages: Iterable[tuple[Any, Any, Any]]) -> None:
    """Put every message where it belongs. What has another type than ours, or is broken, is left out."""
    from chatrobot.wire.dds.definitions import MALFORMED, RosDefinitions

    definitions = RosDefinitions()
    forms = {topic.name: topic.form for topic in TOPICS}
    for schema, channel, message in messages:
        form = forms[channel.topic]
        if schema is None or schema.name != form.type_name or channel.message_encoding != MESSAGE_ENCODING:
            continue
        try:
            found = form.from_ros(definitions.read(form.type_name, message.data))
        except (*MALFORMED, AttributeError):
            continue
        recording.began_ns = recording.began_ns or message.log_time
        t_s = (message.log_time - recording.began_ns) / NS_PER_S
        recording.duration_s = max(recording.duration_s, t_s)
        _take(recording, channel.topic, t_s, found)


def _take(recording: Recording, topic: str, t_s: float, found: Message | None) -> None:
    if isinstance(found, TwistMessage) and topic == CMD_VEL.name:
        recording.commands.append((t_s, found))
    elif isinstance(found, Odometry) and topic in (ODOM.name, GROUND_TRUTH.name):
        (recording.odometry if topic == ODOM.name else recording.truth).append((t_s, found))
    elif isinstance(found, LaserScan) and topic == SCAN.name:
        recording.scans.append((t_s, found))
    elif isinstance(found, Text) and topic == USER_INPUT.name:
        recording.words.append((t_s, found.data))
    elif isinstance(found, Text) and topic == EVENTS.name:
        event = _event(found.data)
        if event is not None:
            recording.events.append((t_s, event))


def _event(text: str) -> dict[str, Any] | None:
    """Return the event in that JSON; None where it is none."""
    try:
        event = json.loads(text)
    except ValueError:
        return None
    return event if isinstance(event, dict) and isinstance(event.get("event"), str) else None
