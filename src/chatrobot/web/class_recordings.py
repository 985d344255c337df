"""The recordings of a class: a file for each pupil's robot, and what whoever teaches may do with them.

All are written by one thread, in turns (decision 63), and less is in each than in that of a single robot: no scans,
and what changes ten times a second (decision 56). A recording that is deleted ends, and that pupil is not recorded
until the teacher says so.

Only a teacher's token fetches and deletes them. A name is looked up among the recordings of this class, and never
becomes a path.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import threading
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from chatrobot.core.errors import ChatRobotError
from chatrobot.core.events import Event, Notice
from chatrobot.core.reason import Reason
from chatrobot.language.interpretation import language_of_tags
from chatrobot.language.phrases import render_reason
from chatrobot.recording.about import about_of
from chatrobot.recording.recorder import LOOK_OF_MANY_S, Recorder, WritingThread
from chatrobot.recording.redactor import Redactor
from chatrobot.recording.repair import read_whole, report_on
from chatrobot.recording.shelf import MOST_BYTES, make_room, new_path
from chatrobot.recording.topics import CMD_VEL, GROUND_TRUTH, ODOM, Topic
from chatrobot.web.access import Access, Refusal
from chatrobot.web.outbox import Message
from chatrobot.web.pupils import PupilsRobot, RobotWires
from chatrobot.web.room import Room
from chatrobot.web.words import noted, web_words
from chatrobot.wire.messages import Message as WireMessage

CLASS_BYTES = MOST_BYTES // 2
"""What the recordings of a class take at most, all together: the rest is left to those that are there."""
PATH = "/recordings"
UNKEPT = {"Cache-Control": "no-store"}
REPORT = ".html"
_TYPES = {REPORT: "text/html; charset=utf-8", ".mcap": "application/octet-stream"}
Serve = Callable[[Request], Awaitable[Response]]


@dataclass(frozen=True)
class _File:
    path: Path
    pupil: str
    recorder: Recorder


class _Pupil:
    """One pupil's robot, and the recording of it that is being written, if one is."""

    def __init__(self, robot: PupilsRobot, room: Room) -> None:
        self.robot, self.room = robot, room
        self.recorder: Recorder | None = None

    def listen(self, wires: RobotWires) -> None:
        """Take in what is told to that robot and what it says, but for its scans."""
        wiring, session = self.robot.connection.profile.wiring, self.robot.connection.session
        told_before = session.on_said
        names = (
            (CMD_VEL, wiring.cmd_vel_topic),
            (ODOM, wiring.odom_topic),
            (GROUND_TRUTH, wires.truth_topic),
        )
        for topic, name in names:
            if name:
                wires.subscribe(self.robot.name, name, topic.kind, self._taker(topic))

        def on_said(turn: int, text: str) -> None:
            told_before(turn, text)
            if (recorder := self.recorder) is not None:
                recorder.said(turn, text)

        session.on_said = on_said

    def _taker(self, topic: Topic) -> Callable[[WireMessage], None]:
        def take(message: WireMessage) -> None:
            if (recorder := self.recorder) is not None:
                recorder.take(topic, message)

        return take

    @property
    def is_recorded(self) -> bool:
        """Something is being written."""
        return self.recorder is not None and not self.recorder.is_over

    def about(self) -> dict[str, str]:
        """Describe the recording."""
        connection = self.robot.connection
        language = connection.session.understanding.language
        about = about_of(connection.profile, connection.world, on="sim", language=language)
        return {**about, "pupil": self.robot.name}


class ClassRecordings:
    """See the module. `open` it, then anything from any thread; what ends a recording waits until it is written.

    Args:
        folder: where recordings are.
        in_use: gives the keys and tokens in use; no recording has them.
    """

    def __init__(self, folder: Path, in_use: Callable[[], Iterable[str]]) -> None:
        self.folder = folder
        self._in_use = in_use
        self._thread = WritingThread(LOOK_OF_MANY_S)
        self._lock = threading.RLock()
        self._pupils: dict[str, _Pupil] = {}
        self._files: dict[str, _File] = {}

    def open(self, robots: Iterable[tuple[PupilsRobot, Room]], wires: RobotWires) -> None:
        """Begin to record every pupil. Waits until what writes is loaded: no robot moves as yet."""
        from chatrobot.recording.writer import ros_definitions

        ros_definitions()
        for robot, room in robots:
            self._pupils[robot.name] = pupil = _Pupil(robot, room)
            pupil.listen(wires)
        for name in self._pupils:
            self.record(name)

    def record(self, name: str) -> None:
        """Begin a recording of that pupil, unless there is one; where it cannot be, the pupil's page says so."""
        with self._lock:
            pupil = self._pupils[name]
            if pupil.is_recorded:
                return
            try:
                recorder = self._new_recorder(name)
            except OSError as error:
                problem = error.strerror or str(error)
                pupil.room.pin(
                    "recording", _spoken(Notice(0, Reason("recording_not_begun", {"problem": problem})))
                )
                return
            recorder.start(pupil.about)
            recorder.notices()  # where it is written is told in words of our own
            file_name = recorder.path.name
            self._files[file_name] = _File(recorder.path, name, recorder)
            pupil.recorder = recorder
            pupil.room.pin("recording", noted("pupil_recorded", file=file_name))

    def _new_recorder(self, name: str) -> Recorder:
        make_room(self.folder, CLASS_BYTES)
        return Recorder(
            new_path(self.folder, f"class_pupil_{name:0>2}"),
            Redactor(self._in_use, os.environ),
            limit_bytes=CLASS_BYTES // len(self._pupils),
            among=self._thread,
        )

    def hear(self, name: str, event: Event) -> None:
        """Take in what happened at that pupil's robot; tell the pupil what became of the recording."""
        pupil = self._pupils.get(name)
        if pupil is None or (recorder := pupil.recorder) is None:
            return
        recorder.hear(event)
        for notice in recorder.notices():
            if recorder.is_over:
                pupil.room.pin("recording", _spoken(notice))
            else:
                pupil.room.tell_people(_spoken(notice))

    # --- for whoever teaches ---

    def facts(self) -> dict[str, Any]:
        """Return what there is, oldest first, and who is not recorded."""
        with self._lock:
            files = []
            for name, file in self._files.items():
                with contextlib.suppress(OSError):  # it was too old, or too much
                    size_bytes = file.path.stat().st_size
                    is_written = not file.recorder.is_over
                    files.append(
                        {"name": name, "pupil": file.pupil, "size_bytes": size_bytes, "written": is_written}
                    )
            unrecorded = [name for name, pupil in self._pupils.items() if not pupil.is_recorded]
            return {"folder": str(self.folder), "files": files, "unrecorded": unrecorded}

    def find(self, file_name: str) -> tuple[Path, bool] | None:
        """Return where that recording of this class is, and whether it is being written; None where there is none.

        Waits for nothing: the event loop asks.
        """
        file = self._files.get(file_name)
        return (file.path, not file.recorder.is_over) if file is not None else None

    def delete(self, file_name: str) -> bool:
        """Delete a recording of this class; one that is being written ends by that. False where there is none.

        Raises:
            OSError: it cannot be deleted.
        """
        with self._lock:
            file = self._files.get(file_name)
            if file is None:
                return False
            pupil = self._pupils[file.pupil]
            if pupil.recorder is file.recorder:
                pupil.recorder = None
            file.recorder.close()
            file.path.unlink(missing_ok=True)
            del self._files[file_name]
            if pupil.recorder is None:
                pupil.room.pin("recording", noted("pupil_not_recorded"))
            return True

    def delete_all(self) -> None:
        """Delete every recording of this class, and end those that are being written.

        Raises:
            OSError: one cannot be deleted.
        """
        with self._lock:
            for file_name in list(self._files):
                self.delete(file_name)

    def close(self) -> None:
        """Write what has come. Waits for it."""
        with self._lock:
            for file in self._files.values():
                file.recorder.close()


def _spoken(notice: Notice) -> Message:
    """Tell a pupil without where it is on the teacher's computer."""
    reason: Reason = notice.reason
    values = {**reason.values, "path": Path(str(reason.values.get("path", ""))).name}
    told = Reason(reason.code, values)
    return Message(lambda language: {"is": "note", "text": render_reason(told, language)})


def recording_routes(access: Access, recordings: ClassRecordings | None) -> list[Route]:
    """Return the routes; none where nothing is recorded."""
    if recordings is None:
        return []
    files = _Files(recordings)
    return [
        Route(PATH, _for_teachers(access, files.list_all), methods=["GET"]),
        Route(PATH, _for_teachers(access, files.delete_all), methods=["DELETE"]),
        Route(f"{PATH}/{{name}}", _for_teachers(access, files.fetch), methods=["GET"]),
        Route(f"{PATH}/{{name}}", _for_teachers(access, files.delete), methods=["DELETE"]),
    ]


def _for_teachers(access: Access, serve: Serve) -> Serve:
    async def serve_teacher(request: Request) -> Response:
        admitted = access.admit(request.scope)
        if isinstance(admitted, Refusal):
            return _refuse(admitted.status, admitted.text)
        if admitted.role != "teacher":
            return _refuse(403, "recordings are the teacher's: open the link that the server printed")
        return await serve(request)

    return serve_teacher


class _Files:
    """Belongs to the event loop; whatever waits for a disk or a process is done in another thread."""

    def __init__(self, recordings: ClassRecordings) -> None:
        self._recordings = recordings
        self._turn = asyncio.Lock()

    async def list_all(self, _: Request) -> Response:
        return JSONResponse(await asyncio.to_thread(self._recordings.facts), headers=UNKEPT)

    async def delete_all(self, request: Request) -> Response:
        return await self._done(request, self._recordings.delete_all)

    async def delete(self, request: Request) -> Response:
        name = request.path_params["name"]
        if self._recordings.find(name) is None:
            return _no_such_file()
        return await self._done(request, lambda: self._recordings.delete(name))

    async def _done(self, request: Request, act: Callable[[], object]) -> Response:
        try:
            await asyncio.to_thread(act)
        except OSError as error:
            return _refuse(500, error.strerror or str(error))
        return await self.list_all(request)

    async def fetch(self, request: Request) -> Response:
        name = Path(request.path_params["name"])
        found = self._recordings.find(name.with_suffix(".mcap").name)
        if found is None or name.suffix not in _TYPES:
            return _no_such_file()
        path, is_written = found
        language = language_of_tags(request.query_params.get("language", ""))
        try:
            async with self._turn:
                body = await asyncio.to_thread(
                    report_on if name.suffix == REPORT else read_whole, path, is_written, language
                )
        except ChatRobotError as error:
            return _refuse(500, web_words(language, "file_failed", problem=str(error)))
        except OSError as error:
            problem = error.strerror or str(error)
            return _refuse(500, web_words(language, "file_failed", problem=problem))
        attached = f'attachment; filename="{name.name}"'
        return Response(body, 200, {**UNKEPT, "Content-Disposition": attached}, _TYPES[name.suffix])


def _no_such_file() -> Response:
    return _refuse(404, "this class has no such recording")


def _refuse(status: int, text: str) -> Response:
    return JSONResponse({"text": text}, status, headers=UNKEPT)
