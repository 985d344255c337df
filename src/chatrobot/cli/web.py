"""`chatrobot web`: one robot, a page for people; it ends with Ctrl-C, and the robot stands."""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import socket
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.cli.choices import setup_from
from chatrobot.cli.console.words import language_of_environment
from chatrobot.cli.entry import STOPPED
from chatrobot.cli.recorder import Connect, class_recordings, recorded
from chatrobot.cli.signals import SignalWatch
from chatrobot.compose import Connection, Setup
from chatrobot.core.errors import LinkError, UsageError
from chatrobot.core.events import Event, Notice, TruePose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.pump import Pump
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.language.phrases import render_reason
from chatrobot.link.processes import SIMULATED
from chatrobot.robots.load import profile_argument, profile_dirs
from chatrobot.sim.robot import TRUTH_TOPIC
from chatrobot.wire.runtime_dir import runtime_dir

if TYPE_CHECKING:
    from chatrobot.lessons.sheet import Sheet
    from chatrobot.mcp_server.host import AgentHost
    from chatrobot.web.access import Access
    from chatrobot.web.class_recordings import ClassRecordings
    from chatrobot.web.classroom import Classroom
    from chatrobot.web.lesson import RoomLesson
    from chatrobot.web.room import Room
    from chatrobot.web.server import WebServer

PORT, MOST_TRIED = 8080, 20
_ANYWHERE = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}
"""Hosts that listen at every address of this machine, and the one of them that it has for itself."""
Sockets = tuple[socket.socket, socket.socket]
_TOKEN = re.compile(r"[A-Za-z0-9._~-]{4,128}")


def run(args: argparse.Namespace) -> int:
    """Serve the page until Ctrl-C.

    Raises:
        UsageError: it cannot be served as chosen.
    """
    _check(args)
    try:
        from chatrobot.lessons.run import LessonRun
        from chatrobot.web.classroom import Classroom
        from chatrobot.web.lesson import RoomLesson
        from chatrobot.web.pupils import check_class
        from chatrobot.web.room import Room
        from chatrobot.web.server import WebServer
    except ImportError as error:
        problem = f"the web console is not installed: {error.name} is missing"
        raise UsageError(problem, allowed="pip install 'chatrobot[web]'") from error
    setup, sheet = _chosen(args)
    access = _access(args)
    recordings = None
    if args.pupils is not None:
        check_class(setup, args.pupils)
        recordings = class_recordings(args, lambda: access.tokens)
    certificate = (args.tls_cert, args.tls_key) if args.tls_cert else None
    tell = partial(_tell, args, access, sheet, recordings)
    sockets = (listen(args.host, args.port), listen(args.host, 0))
    with contextlib.closing(sockets[0]), contextlib.closing(sockets[1]):
        if args.pupils:
            classroom = Classroom(args.pupils, access, args.token, sheet, recordings)
            server = WebServer(access, classroom.rooms, certificate, classroom)
            with tempfile.TemporaryDirectory(prefix="class-", dir=runtime_dir()) as kept:
                robot = profile_argument(setup.robot, profile_dirs(setup.folder))
                setup = replace(
                    setup, robot=robot, folder=Path(kept)
                )  # no pupil meets the last class's programs
                return _serve_class(setup, classroom, server, sockets, tell)
        room = Room()
        server = WebServer(access, {room.name: room}, certificate)
        meet = recorded(args, unasked=True, tokens=lambda: access.tokens)
        lesson: RoomLesson | None = None
        if sheet is not None:
            lesson = RoomLesson(LessonRun(sheet, setup.profile.footprint), room, setup.profile.title)
        return _serve(setup, room, server, sockets, tell, meet, lesson)


def _chosen(args: argparse.Namespace) -> tuple[Setup, Sheet | None]:
    """Return what was chosen, and the lesson, if one was.

    Raises:
        LessonError: there is no such lesson, or its sheet cannot be used.
        UsageError: what was chosen does not exist, or does not fit the lesson.
    """
    sheet = None
    if args.lesson:
        from chatrobot.cli.lesson.command import check_robot, setup_of
        from chatrobot.lessons.sheet import load_sheet

        check_robot(args)
        sheet = load_sheet(args.lesson)
        setup = setup_of(args, sheet)
    else:
        setup = setup_from(args, programs=True)
    options = replace(setup.options, while_moving="replace", ask_new=not setup.yes)
    return replace(setup, options=options), sheet


def _serve(
    setup: Setup,
    room: Room,
    server: WebServer,
    sockets: Sockets,
    tell: Callable[[], None],
    meet: Connect,
    lesson: RoomLesson | None,
) -> int:
    connection = meet(replace(setup, trace=lesson is not None), lambda event: _hear(room, lesson, event))
    problems: list[Exception] = []

    def lose(error: Exception) -> None:
        room.lose(error)
        problems.append(error)

    agents: AgentHost | None = None
    connection.session.understanding.warm(*REPLY_LANGUAGES)  # a page's first sentence is in any of them
    pump = Pump(connection.session, lose)
    room.open(connection, pump.post, is_simulated=setup.on in SIMULATED)
    if lesson is not None:
        lesson.open(connection.session)
    try:
        with SignalWatch(connection.session.stop) as watch:
            server.start(*sockets)
            tell()
            pump.start()
            agents = _host_agents(connection, server.access, setup, room)
            _wait_for_end(watch, problems)
            server.close()
    finally:
        if agents is not None:
            agents.close()
        with contextlib.suppress(LinkError):  # Motion is gone, and its guard halts the robot
            connection.session.stop("the web console has ended")
        pump.stop()
        connection.close()
    if problems:
        raise problems[0]
    return STOPPED


def _wait_for_end(watch: SignalWatch, problems: list[Exception]) -> None:
    while not (watch.is_leaving or problems):
        time.sleep(0.1)


def _hear(room: Room, lesson: RoomLesson | None, event: Event) -> None:
    """Have the page told and the lesson judge it, and the terminal told what concerns a recording."""
    if isinstance(event, TruePose):
        if lesson is not None:
            lesson.hear(event)  # from the moment of connecting on
        return
    if isinstance(event, Notice) and event.reason.code.startswith("recording"):
        print(render_reason(event.reason, language_of_environment()), flush=True)
        if event.reason.code == "recording":  # who has a page needs no path of this machine
            event = Notice(
                event.turn, Reason("recording_here", {"file": Path(str(event.reason.values["path"])).name})
            )
    room.hear(event)
    if lesson is not None:
        lesson.hear(event)


def _serve_class(
    setup: Setup, classroom: Classroom, server: WebServer, sockets: Sockets, tell: Callable[[], None]
) -> int:
    from chatrobot.web.pupils import RobotWires, connect_class

    robots = connect_class(setup, list(classroom.rooms), lambda name: classroom.seats[name].hear)
    problems: list[Exception] = []

    def lose(error: Exception) -> None:
        problems.append(error)

    robots[0].connection.session.understanding.warm(*REPLY_LANGUAGES)
    is_heard = classroom.sheet is not None or classroom.recordings is not None
    classroom.open(robots, lose, RobotWires(robots, TRUTH_TOPIC) if is_heard else None)
    try:
        with SignalWatch(classroom.stop) as watch:
            server.start(*sockets)
            tell()
            _wait_for_end(watch, problems)
            server.close()
    finally:
        classroom.close()
    if problems:
        raise problems[0]
    return STOPPED


def _host_agents(connection: Connection, access: Access, setup: Setup, room: Room) -> AgentHost | None:
    """Let `chatrobot mcp` attach to this robot, whose person says yes in the page; None without the extra `mcp`."""
    from chatrobot.mcp_server.host import host_agents

    address = f"{access.origin(_reachable(access.host))}/"  # without the token: agents are told it
    host = host_agents(
        connection, lambda: address, is_simulated=setup.on in SIMULATED, is_latched=lambda: room.is_latched
    )
    if host is not None:
        room.plans.on_edited = host.note_edit
    return host


def _check(args: argparse.Namespace) -> None:
    if args.fast:
        raise UsageError(
            "the web console runs in real time", where="--fast", allowed='chatrobot do "…" --fast'
        )
    if bool(args.tls_cert) != bool(args.tls_key):
        raise UsageError(
            "a certificate and its key belong together", allowed="--tls-cert FILE --tls-key FILE"
        )
    for option, path in (("--tls-cert", args.tls_cert), ("--tls-key", args.tls_key)):
        if path and not os.access(path, os.R_OK):
            raise UsageError(f"{path} cannot be read", where=option, allowed="a file in PEM")
    if args.token and not _TOKEN.fullmatch(args.token):
        raise UsageError(
            "a token has 4 to 128 letters, digits, '-', '.', '_' or '~'",
            where="--token",
            allowed="leave it out for one that nobody guesses",
        )


def _access(args: argparse.Namespace) -> Access:
    """Say who may come in: at this machine everybody, unless a token was chosen; elsewhere, or to a class, by token."""
    from chatrobot.web.access import Access, is_loopback

    needs_token = bool(args.token or args.pupils) or not is_loopback(args.host)
    access = Access(args.host, is_secure=bool(args.tls_cert), needs_token=needs_token)
    if needs_token and not args.pupils:
        access.issue("steerer", token=args.token)
        access.issue("watcher")
    return access


def listen(host: str, port: int | None) -> socket.socket:
    """Listen on that port; where none was chosen on the first free one from `PORT` on.

    Raises:
        UsageError: nobody can listen there.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    tried = range(PORT, PORT + MOST_TRIED) if port is None else (port,)
    problem = ""
    for number in tried:
        try:
            return socket.create_server((host, number), family=family, backlog=128)
        except OSError as error:
            problem = f"cannot listen on {host}:{number}: {error.strerror or error}"
    allowed = "--port 0: any that is free" if port is not None or len(tried) > 1 else "--host 127.0.0.1"
    raise UsageError(problem, allowed=allowed)


def _tell(
    args: argparse.Namespace, access: Access, sheet: Sheet | None, recordings: ClassRecordings | None
) -> None:
    """Print the address; where a token is needed as a link and as a QR code, and the link of those who watch."""
    from chatrobot.lessons.words import say
    from chatrobot.web.words import web_words

    language = language_of_environment()
    path = "teacher" if args.pupils else ""

    def links_by(name: str) -> list[str]:
        return [f"{access.origin(name)}/{path}#{token}" for token in access.tokens] or [
            f"{access.origin(name)}/"
        ]

    links = links_by(_reachable(args.host))
    here = links_by(_ANYWHERE[args.host])[0] if args.host in _ANYWHERE else links[0]
    print(web_words(language, "teacher_address" if args.pupils else "address", url=links[0]), flush=True)
    if access.needs_token:
        import segno

        if sys.stdout.isatty():
            segno.make(links[0], error="m").terminal(compact=True)
        if here != links[0]:
            print(web_words(language, "local_address", url=here), flush=True)
        if not args.pupils:
            print(web_words(language, "watch_address", url=links[1]), flush=True)
    if sheet is not None:
        title, count = sheet.title.in_language(language), len(sheet.tasks)
        print(say(language, "lesson_of", title=title, count=count), flush=True)
    if recordings is not None:
        pattern = recordings.folder / "…_class_pupil_….mcap"
        print(web_words(language, "class_recorded", path=pattern), flush=True)
    if not args.no_open:
        _open(here)


def _open(link: str) -> None:
    """Open the page in a browser where there is a screen, and a person at it."""
    may_open = sys.stdout.isatty() and (
        sys.platform == "darwin" or "DISPLAY" in os.environ or "WAYLAND_DISPLAY" in os.environ
    )
    if may_open:
        import webbrowser

        threading.Thread(target=webbrowser.open, args=(link,), daemon=True).start()


def _reachable(host: str) -> str:
    """Return the name by which another machine reaches a server that listens there."""
    if host in _ANYWHERE:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe, contextlib.suppress(OSError):
            probe.connect(("10.255.255.255", 9))  # asks for the way there; sends nothing
            return str(probe.getsockname()[0])
        return socket.gethostname()
    return f"[{host}]" if ":" in host else host
