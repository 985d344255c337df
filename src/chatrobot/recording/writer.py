"""Writes one recording: rosbag2-compatible MCAP, by the `mcap` library, with ROS's definitions from `rosbags`.

One thread owns a writer. What it was given is in the operating system's hands once `flush` returns, so that a process
that is killed loses no more than what came since.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import BinaryIO

from mcap.writer import Writer

from chatrobot import __version__
from chatrobot.recording.repair import LIBRARY
from chatrobot.recording.topics import (
    MESSAGE_ENCODING,
    METADATA,
    PROFILE,
    SCHEMA_ENCODING,
    TOPICS,
    Topic,
)
from chatrobot.wire.dds.definitions import RosDefinitions
from chatrobot.wire.messages import Message, Text


@cache
def ros_definitions() -> RosDefinitions:
    """Return ROS's definitions, which all recordings of a process share: the first call takes 0.1 s of a processor."""
    return RosDefinitions()


@cache
def _schema(type_name: str) -> tuple[bytes, str]:
    """Return a type's definition as text, and its hash."""
    definitions = ros_definitions()
    return definitions.text_of(type_name).encode(), definitions.hash_of(type_name)


class RecordingWriter:
    """One file; it is closed with the writer.

    Args:
        file: a new one, open for writing; nothing else writes there.
        about: the metadata record, text by text.
        redact: what every text passes before it is written.

    Raises:
        OSError: the disk is full; so do `write`, `flush` and `close`.
    """

    def __init__(self, file: BinaryIO, about: Mapping[str, str], redact: Callable[[str], str]) -> None:
        self._redact = redact
        self._definitions = ros_definitions()
        self._file = file
        self._writer = Writer(self._file)
        self._writer.start(PROFILE, library=f"{LIBRARY}{__version__}")
        self._writer.add_metadata(METADATA, {key: redact(value) for key, value in about.items()})
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        for topic in TOPICS:
            self._register(topic)
        self._file.flush()

    def write(self, topic: Topic, message: Message, time_ns: int) -> None:
        """Add a message of `topic`, received at `time_ns` since 1970; so are its stamps, if it has any."""
        if isinstance(message, Text):
            message = Text(self._redact(message.data))
        data = self._definitions.cdr(topic.form.type_name, topic.form.to_ros(message))
        self._writer.add_message(self._channels[topic.name], time_ns, data, time_ns)

    @property
    def size_bytes(self) -> int:
        """Return how long the file is, without what has not been flushed."""
        return self._file.tell()

    def flush(self) -> None:
        """Hand all that came so far to the operating system."""
        self._writer.flush()  # type: ignore[no-untyped-call]

    def close(self) -> None:
        """Write the index and the summary, and close the file, whatever goes wrong with them."""
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
        finally:
            self._file.close()

    def _register(self, topic: Topic) -> None:
        name = topic.form.type_name
        text, hash_ = _schema(name)
        if name not in self._schemas:
            self._schemas[name] = self._writer.register_schema(name, SCHEMA_ENCODING, text)
        self._channels[topic.name] = self._writer.register_channel(
            topic.name,
            MESSAGE_ENCODING,
            self._schemas[name],
            {"topic_type_hash": hash_},
        )
