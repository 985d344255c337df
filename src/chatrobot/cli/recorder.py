"""What a command records, and where: `--record [FILE]`, `--no-record`, and what the console and the page do unasked."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.cli.status_line import status_line
from chatrobot.compose import Connection, OnEvent, Setup, connect
from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.events import Event, Notice
from chatrobot.core.reason import Reason
from chatrobot.core.sensed_events import TruePose
from chatrobot.language.phrases import render_reason
from chatrobot.recording.shelf import MOST_BYTES, SUFFIX, check_new, make_folder, make_room, new_path, tidy
from chatrobot.sim.robot import TRUTH_TOPIC

if TYPE_CHECKING:
    from chatrobot.recording.reader import Recording
    from chatrobot.recording.recorder import Recorder
    from chatrobot.web.class_recordings import ClassRecordings

Connect = Callable[[Setup, OnEvent], Connection]
EXTRA = "pip install 'chatrobot[record]'"
_LIBRARIES = ("mcap", "rosbags")
SHOWN_EVERY_S = 0.2
"""So often a terminal is told how much of a recording has been read."""
MOST_NAMED = 8
"""So many recordings of a folder are named, the last ones."""


def data_folder(config_dir: str | None) -> Path:
    """Return the folder that holds the folder of recordings: `--config-dir`, or the user's folder of data."""
    if config_dir is not None:
        return Path(config_dir).expanduser()
    from platformdirs import user_data_path

    return user_data_path("chatrobot")


def require_extra() -> None:
    """Check that recordings can be written and read here.

    Raises:
        UsageError: they cannot.
    """
    if missing := _missing():
        raise UsageError(f"recordings are not installed: {missing[0]} is missing", allowed=EXTRA)


def read_recording(name: str) -> tuple[Recording, str]:
    """Read the recording in that file, or in that folder of `ros2 bag record`.

    A word of `report.toml` comes with it, which says what was amiss: `repaired`, `unfinished`, or "" for nothing.

    Raises:
        InputError: there is none, it cannot be read, or nothing in it can be shown.
    """
    require_extra()
    from chatrobot.recording.reader import read
    from chatrobot.recording.repair import copy_whole, is_whole

    path = Path(name).expanduser()
    try:
        if path.is_dir():
            path = _only_file(path)
        elif path.exists() and not path.is_file():  # a pipe cannot be read twice, and may wait for ever
            raise UsageError("this is not a file", where=str(path), allowed="an .mcap file")
        with _progress(path.name) as tell:
            was_mended = _mended(path, tell)
            if is_whole(path):
                return read(path, tell=tell), "repaired" if was_mended else ""
            with tempfile.NamedTemporaryFile(suffix=SUFFIX) as copy:
                with Path(copy.name).open("wb") as whole:
                    copy_whole(path, whole, tell)
                return read(Path(copy.name), path, tell), "unfinished"
    except OSError as error:
        raise UsageError(error.strerror or str(error), where=str(path), allowed="an .mcap file") from error


def _mended(path: Path, tell: Callable[[float], None]) -> bool:
    """Mend a recording that was cut off, where it can be written; it is read from a copy where it cannot."""
    from chatrobot.recording.repair import repair

    with contextlib.suppress(OSError):  # of others, on a medium that is read only, or a full one
        return repair(path, tell) is not None
    return False


@contextlib.contextmanager
def _progress(name: str) -> Iterator[Callable[[float], None]]:
    """Show how much of that file has been read, while it is entered."""
    shown_s = time.monotonic()

    def tell(share: float) -> None:
        nonlocal shown_s
        if (now_s := time.monotonic()) - shown_s >= SHOWN_EVERY_S:
            shown_s = now_s
            line.show(f"{name}: {share:.0%}")

    with status_line() as line:
        yield tell


def _only_file(folder: Path) -> Path:
    """Return the one recording in a folder: so `ros2 bag record` leaves it.

    Raises:
        UsageError: there are more, or none.
    """
    found = sorted(folder.glob(f"*{SUFFIX}"))
    if len(found) != 1:
        names = ", ".join(str(path) for path in found[-MOST_NAMED:])
        raise UsageError(
            f"a folder with {len(found)} recordings", where=str(folder), allowed=names or f"one {SUFFIX} file"
        )
    return found[0]


def recorded(
    args: argparse.Namespace, *, unasked: bool = False, tokens: Callable[[], Iterable[str]] = tuple
) -> Connect:
    """Return what connects to the robot, and records what happens where that was chosen.

    Args:
        unasked: this command records unless a person says no.
        tokens: the tokens in use; no recording has them.

    Raises:
        UsageError: it cannot be recorded as chosen.
    """
    if not _is_wanted(args, unasked=unasked):
        return connect
    chosen = check_new(Path(args.record)) if args.record else None

    def connect_recorded(setup: Setup, on_event: OnEvent) -> Connection:
        tap = _Tap(on_event)
        connection = connect(setup, tap.hear)
        try:
            _record(connection, tap, chosen or _free_path(args, setup), tokens)
        except (OSError, WireError) as error:
            problem = getattr(error, "strerror", None) or str(error)
            if args.record is not None:
                connection.close()
                raise UsageError(f"cannot record: {problem}", where="--record") from error
            tap.waiting.append(Notice(0, Reason("recording_not_begun", {"problem": problem})))
        return connection

    return connect_recorded


def class_recordings(args: argparse.Namespace, tokens: Callable[[], Iterable[str]]) -> ClassRecordings | None:
    """Return what records a class, a file for each pupil; None where nothing is recorded.

    Raises:
        UsageError: it cannot be recorded as chosen.
    """
    if args.record:
        raise UsageError("each pupil has a file of their own", where="--record", allowed="--record alone")
    if not _is_wanted(args, unasked=True):
        return None
    from chatrobot.web.class_recordings import CLASS_BYTES, ClassRecordings

    try:
        return ClassRecordings(_prepared_folder(args, CLASS_BYTES), tokens)
    except OSError as error:
        problem = error.strerror or str(error)
        if args.record is not None:
            raise UsageError(f"cannot record: {problem}", where="--record") from error
        print(render_reason(Reason("recording_not_begun", {"problem": problem}), "en"), file=sys.stderr)
        return None


def _is_wanted(args: argparse.Namespace, *, unasked: bool) -> bool:
    """Tell whether to record.

    Raises:
        UsageError: it cannot be recorded as chosen.
    """
    if args.record is None:
        return unasked and not args.no_record and not _missing()
    if args.no_record:
        raise UsageError("either of both", where="--record --no-record", allowed="leave one out")
    require_extra()
    return True


def _missing() -> list[str]:
    return [library for library in _LIBRARIES if find_spec(library) is None]


def _free_path(args: argparse.Namespace, setup: Setup) -> Path:
    """Make room in the folder of recordings, and mend there what was cut off, while the robot is already there.

    Raises:
        OSError: there can be no such folder.
    """
    return new_path(_prepared_folder(args, MOST_BYTES * 0.1), setup.profile.name)


def _prepared_folder(args: argparse.Namespace, free_bytes: float) -> Path:
    folder = make_folder(data_folder(args.config_dir))
    make_room(folder, MOST_BYTES - free_bytes)
    threading.Thread(target=tidy, args=(folder,), name="recordings", daemon=True).start()
    return folder


class _Tap:
    """Stands where events are heard: the recorder hears them, too, and what it has to tell comes in between."""

    def __init__(self, on_event: OnEvent) -> None:
        self._on_event = on_event
        self.recorder: Recorder | None = None
        self.waiting: list[Notice] = []

    def hear(self, event: Event) -> None:
        """Take an event in."""
        if self.recorder is not None:
            self.recorder.hear(event)
        if not isinstance(event, TruePose):  # one comes on the wire's thread, and before there is a display
            self.waiting += self.recorder.notices() if self.recorder is not None else ()
            while self.waiting:
                self._on_event(self.waiting.pop(0))
        self._on_event(event)


def _record(connection: Connection, tap: _Tap, path: Path, tokens: Callable[[], Iterable[str]]) -> None:
    """Begin to record that connection, until it is closed."""
    from chatrobot.recording.about import about_of
    from chatrobot.recording.recorder import Recorder
    from chatrobot.recording.redactor import Redactor

    setup, session = connection.prepared.setup, connection.session

    def in_use() -> tuple[str, ...]:
        secret = getattr(setup.model, "secret", None)
        return (*tokens(), *([secret.reveal()] if secret is not None else ()))

    wire, clock = connection.prepared.listen()
    try:
        recorder = Recorder(path, Redactor(in_use, os.environ), clock=clock, limit_bytes=MOST_BYTES)
    except OSError:
        wire.close()
        raise
    recorder.listen(wire, connection.profile.wiring, TRUTH_TOPIC)
    language = session.understanding.language
    recorder.start(lambda: about_of(connection.profile, connection.world, on=setup.on, language=language))
    tap.recorder, session.on_said, close = recorder, recorder.said, connection.close

    def close_both() -> None:
        try:
            close()
        finally:
            recorder.close()
            for notice in recorder.notices():  # nobody hears events any more
                print(render_reason(notice.reason, language), file=sys.stderr)

    connection.close = close_both
