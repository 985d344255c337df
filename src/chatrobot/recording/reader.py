"""Reads a recording into memory: what `replay` shows again and `report` draws.

A bag of somebody else's, with the same topics and no metadata of ours, is read as well.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from operator import itemgetter
from pathlib import Path
from typing import Any, TypeVar

from chatrobot.core.errors import UsageError
from chatrobot.recording.repair import TOLD_EVERY, Tell, errors_of_broken_files, tell_nobody
from chatrobot.recording.topics import (
    CMD_VEL,
    EVENTS,
    GROUND_TRUTH,
    MESSAGE_ENCODING,
    METADATA,
    ODOM,
    SCAN,
    STAMPED_VELOCITY,
    TOPICS,
    USER_INPUT,
)
from chatrobot.wire.messages import LaserScan, Message, Odometry, Text, TwistMessage

NS_PER_S = 1e9
Kind = TypeVar("Kind", bound=Message)
Timed = list[tuple[float, Kind]]
MOST_NAMED = 8
"""So many topics of a file without ours are named."""
ALLOWED = "an .mcap file that chatrobot, or ros2 bag record --storage mcap, has written"


@dataclass
class Recording:
    """All of a recording, each message with its seconds since the first one.

    `meta` is the metadata record, empty where the file has none; `began_ns` is when the first message was received,
    nanoseconds since 1970. `words` are what a person said.
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


def read(path: Path, copy_of: Path | None = None, tell: Tell = tell_nobody) -> Recording:
    """Read the recording in a file that is whole (`repair` sees to that), or that is a whole copy of another.

    Raises:
        UsageError: it is no recording, or another's in which nothing can be shown.
        OSError: it cannot be read.
    """
    from mcap.reader import make_reader

    recording = Recording(copy_of or path)
    with path.open("rb") as file:
        try:
            reader = make_reader(file)
            ours = [about.metadata for about in reader.iter_metadata() if about.name == METADATA]
            recording.meta = dict(ours[-1]) if ours else {}
            statistics = getattr(reader.get_summary(), "statistics", None)
            # The library's order by time would take as long as the rest: a file has nearly that order already.
            messages = reader.iter_messages([topic.name for topic in TOPICS], log_time_order=False)
            is_empty = not _take_all(recording, messages, tell, statistics.message_count if statistics else 0)
            there = _content(reader.get_summary()) if is_empty else ""
        except errors_of_broken_files() as error:
            raise UsageError(
                "is not a recording, or is broken", where=str(recording.path), allowed=ALLOWED
            ) from error
    if is_empty and not ours:
        wanted = ", ".join(f"{topic.name} ({topic.form.type_name})" for topic in TOPICS[:3])
        raise UsageError(
            f"holds nothing to show: {there}", where=str(recording.path), allowed=f"one of {wanted} …"
        )
    return recording


def _content(summary: Any) -> str:
    """Say which topics are in a file."""
    channels = summary.channels.values() if summary is not None else ()
    types = {id_: schema.name for id_, schema in summary.schemas.items()} if summary is not None else {}
    told = sorted(f"{one.topic} ({types.get(one.schema_id, one.message_encoding)})" for one in channels)
    if not told or not summary.statistics or not summary.statistics.message_count:
        return "no message"
    return "only " + ", ".join(told[:MOST_NAMED]) + (" …" if len(told) > MOST_NAMED else "")


def _take_all(
    recording: Recording, messages: Iterable[tuple[Any, Any, Any]], tell: Tell, total_count: int
) -> int:
    """Put every message of a type of ours that can be read where it belongs, in the order of time; how many did."""
    from chatrobot.wire.dds.definitions import MALFORMED, RosDefinitions

    definitions = RosDefinitions()
    forms = {(topic.name, topic.form.type_name): topic.form for topic in TOPICS}
    forms[CMD_VEL.name, STAMPED_VELOCITY.type_name] = STAMPED_VELOCITY
    found: list[tuple[int, str, Message | None]] = []
    for count, (schema, channel, message) in enumerate(messages):
        if total_count and count % TOLD_EVERY == 0:
            tell(count / total_count)
        form = forms.get((channel.topic, schema.name)) if schema is not None else None
        if form is None or channel.message_encoding != MESSAGE_ENCODING:
            continue
        try:
            content = form.from_ros(definitions.read(form.type_name, message.data))
        except (*MALFORMED, AttributeError):
            continue
        found.append((message.log_time, channel.topic, content))
    found.sort(key=itemgetter(0))
    for log_time_ns, topic, content in found:
        _take(recording, topic, (log_time_ns - found[0][0]) / NS_PER_S, content)
    if found:
        recording.began_ns, recording.duration_s = found[0][0], (found[-1][0] - found[0][0]) / NS_PER_S
    return len(found)


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
