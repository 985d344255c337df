"""Mends a recording whose writer was killed: what reached the disk is written anew, with index and summary.

For a server that has others to serve there are copies and reports, made by a process of its own at lower priority.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from chatrobot.core.errors import ChatRobotError, InputError

if TYPE_CHECKING:
    from mcap.records import Header

Tell = Callable[[float], None]
"""Hears now and then which share of a file has been read."""
TOLD_EVERY = 500
"""So many messages: a hundredth of a second."""
MAGIC = b"\x89MCAP0\r\n"
LIBRARY = "chatrobot "
"""How a file begins to say who wrote it, where we did; our version follows."""
_FOOTER_BYTES = 9 + 20
NICENESS, LONGEST_S = 10, 120.0
"""Of what is made for a server, and how long that may take."""
_LARGEST_RECORD_BYTES = 1 << 28
"""A length beyond it is no length: the file ends within it."""


def is_whole(path: Path) -> bool:
    """Tell whether the file has its end: the index, and the mark behind it.

    Raises:
        OSError: it cannot be read.
    """
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            return False
        size = file.seek(0, os.SEEK_END)
        if size < 2 * len(MAGIC) + _FOOTER_BYTES:
            return False
        file.seek(-len(MAGIC) - _FOOTER_BYTES, os.SEEK_END)
        end = file.read()
    return end.endswith(MAGIC) and end[0] == 2 and int.from_bytes(end[1:9], "little") == _FOOTER_BYTES - 9


@contextlib.contextmanager
def held(path: Path) -> Iterator[bool]:
    """Within it nobody else writes or mends that file; false where somebody does.

    Raises:
        OSError: it cannot be opened.
    """
    with path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
            return
        yield True


def tell_nobody(_share: float) -> None:
    """Say nothing."""


def repair(path: Path, tell: Tell = tell_nobody) -> int | None:
    """Write a truncated file anew; how many messages it holds then. None where nothing was to be done.

    A file that is being written just now is left alone, and so is one that another program began: it may be at work,
    and holds no lock of ours.

    Raises:
        InputError: it is no recording, or nothing in it can be read.
        OSError: it cannot be read, or the disk is full; then it stays as it is.
    """
    with held(path) as is_ours:
        if not is_ours or is_whole(path) or not _header(path).library.startswith(LIBRARY):
            return None
        beside = path.with_name(f".{path.name}.mending")
        try:
            descriptor = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_NOFOLLOW, 0o600)
            with os.fdopen(descriptor, "wb") as mended:
                count = copy_whole(path, mended, tell)
            os.utime(beside, ns=(path.stat().st_atime_ns, path.stat().st_mtime_ns))  # its age stays
            os.replace(beside, path)
        finally:
            beside.unlink(missing_ok=True)
    return count


def repair_elsewhere(path: Path) -> None:
    """Have a truncated file of ours written anew by a process of its own: it takes seconds, and robots may move.

    Raises:
        ChatRobotError: nothing in it can be read.
        OSError: it cannot be read.
    """
    with held(path) as is_ours:
        is_due = is_ours and not is_whole(path) and _header(path).library.startswith(LIBRARY)
    if is_due:
        _run("chatrobot.recording.repair", str(path))


def copy_whole(path: Path, mended: BinaryIO, tell: Tell = tell_nobody) -> int:
    """Copy record by record, up to the first that is not whole, and write an end; how many messages there are.

    Raises:
        InputError: it is no recording.
        OSError: it cannot be read, or the copy not be written.
    """
    header = _header(path)
    with path.open("rb") as broken:
        return _copy(broken, mended, header, tell)


def _header(path: Path) -> Header:
    from mcap.records import Header

    with path.open("rb") as file:
        found = next(_records(file), None)
    if not isinstance(found, Header):
        raise InputError("is no recording: it does not begin as one", where=str(path), allowed="an MCAP file")
    return found


def _copy(broken: BinaryIO, mended: BinaryIO, header: Header, tell: Tell) -> int:
    from mcap import records
    from mcap.writer import Writer

    writer, count, size_bytes = Writer(mended), 0, os.fstat(broken.fileno()).st_size
    writer.start(header.profile, header.library)
    schemas: dict[int, int] = {0: 0}
    channels: dict[int, int] = {}
    for record in _records(broken):
        if isinstance(record, records.Metadata):
            writer.add_metadata(record.name, record.metadata)
        elif isinstance(record, records.Schema) and record.id not in schemas:
            schemas[record.id] = writer.register_schema(record.name, record.encoding, record.data)
        elif isinstance(record, records.Channel) and record.id not in channels:
            channels[record.id] = writer.register_channel(
                record.topic, record.message_encoding, schemas.get(record.schema_id, 0), record.metadata
            )
        elif isinstance(record, records.Message) and record.channel_id in channels:
            channel = channels[record.channel_id]
            writer.add_message(channel, record.log_time, record.data, record.publish_time, record.sequence)
            count += 1
            if count % TOLD_EVERY == 0:
                tell(broken.tell() / size_bytes)
    writer.finish()  # type: ignore[no-untyped-call]
    return count


def errors_of_broken_files() -> tuple[type[Exception], ...]:
    """Return what the library raises where bytes of a file are no record, or not what was written."""
    from mcap.exceptions import McapError
    from zstandard import ZstdError

    return (McapError, ZstdError, struct.error, ValueError, OverflowError, MemoryError, KeyError, EOFError)


def _records(file: BinaryIO) -> Iterator[Any]:
    """Give the records of the data section, up to its end or the first that cannot be read."""
    from mcap.records import DataEnd
    from mcap.stream_reader import StreamReader

    reader = iter(StreamReader(file, validate_crcs=True, record_size_limit=_LARGEST_RECORD_BYTES).records)
    while True:
        try:
            record = next(reader)
        except errors_of_broken_files():
            return
        if isinstance(record, DataEnd):
            return
        yield record


def read_whole(path: Path, is_written: bool, _: str = "") -> bytes:
    """Return a recording with its end; of one that is being written as much as has come by now.

    Raises:
        ChatRobotError: that cannot be made.
        OSError: it cannot be read.
    """
    if not is_written:
        return path.read_bytes()
    with _copied(path) as copy:
        _run("chatrobot.recording.repair", str(copy))
        return copy.read_bytes()


def report_on(path: Path, is_written: bool, language: str) -> bytes:
    """Return the page of `chatrobot report`.

    Raises:
        ChatRobotError: it cannot be made.
        OSError: the recording cannot be read.
    """
    with _copied(path) as copy:
        if is_written:  # it was not cut off, as the report would say
            _run("chatrobot.recording.repair", str(copy))
        made = copy.with_suffix(".html")
        _run("chatrobot", "report", str(copy), "--html", str(made), "--language", language)
        return made.read_bytes()


@contextlib.contextmanager
def _copied(path: Path) -> Iterator[Path]:
    """Give a copy that nobody writes, in a folder that only its owner can look into."""
    with tempfile.TemporaryDirectory(prefix="chatrobot-") as folder:
        copy = Path(folder) / path.name
        shutil.copyfile(path, copy)
        yield copy


def _run(module: str, *arguments: str) -> None:
    """Run a module of ours and wait for it.

    Raises:
        ChatRobotError: it failed; with its last words.
    """
    process = subprocess.Popen(
        [sys.executable, "-m", module, *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    with contextlib.suppress(OSError):  # it has ended already
        os.setpriority(os.PRIO_PROCESS, process.pid, NICENESS)
    try:
        _, said = process.communicate(timeout=LONGEST_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise ChatRobotError(f"not done after {LONGEST_S:.0f} s") from None
    if process.returncode != 0:
        raise ChatRobotError((said.strip().splitlines() or [f"exit code {process.returncode}"])[-1])


if __name__ == "__main__":  # in a process of its own, so that nobody waits for the interpreter meanwhile
    repair(Path(sys.argv[1]))
