"""What a teacher's page fetches and deletes: the recordings of a class, whole, and a report on one.

Only a teacher's token comes in. A name is looked up among the recordings of this class and never becomes a path. What
takes long is done in a process of its own, at lower priority, one at a time: the class goes on beside it.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from chatrobot.core.errors import ChatRobotError
from chatrobot.language.interpretation import LanguageCode
from chatrobot.web.access import Access, Refusal
from chatrobot.web.class_recordings import ClassRecordings
from chatrobot.web.words import web_words

PATH = "/recordings"
NICENESS, LONGEST_S = 10, 120.0
UNKEPT = {"Cache-Control": "no-store"}
REPORT = ".html"
_TYPES = {REPORT: "text/html; charset=utf-8", ".mcap": "application/octet-stream"}
Serve = Callable[[Request], Awaitable[Response]]


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
        language: LanguageCode = "zh" if request.query_params.get("language") == "zh" else "en"
        try:
            async with self._turn:
                body = await asyncio.to_thread(
                    _report if name.suffix == REPORT else _whole, path, is_written, language
                )
        except ChatRobotError as error:
            return _refuse(500, web_words(language, "file_failed", problem=str(error)))
        except OSError as error:
            problem = error.strerror or str(error)
            return _refuse(500, web_words(language, "file_failed", problem=problem))
        attached = f'attachment; filename="{name.name}"'
        return Response(body, 200, {**UNKEPT, "Content-Disposition": attached}, _TYPES[name.suffix])


def _whole(path: Path, is_written: bool, _: str) -> bytes:
    """Return a recording with its end; of one that is being written as much as has come by now."""
    if not is_written:
        return path.read_bytes()
    with _copied(path) as copy:
        _run("chatrobot.recording.repair", str(copy))
        return copy.read_bytes()


def _report(path: Path, _: bool, language: str) -> bytes:
    """Return the page of `chatrobot report`."""
    with _copied(path) as copy:
        made = copy.with_suffix(REPORT)
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


def _no_such_file() -> Response:
    return _refuse(404, "this class has no such recording")


def _refuse(status: int, text: str) -> Response:
    return JSONResponse({"text": text}, status, headers=UNKEPT)
