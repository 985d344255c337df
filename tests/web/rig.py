"""A web console on real ports with a session that only notes what it is told, and pages that talk to it."""

from __future__ import annotations

import contextlib
import json
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from types import SimpleNamespace
from typing import Any

import httpx
from websockets.sync.client import ClientConnection, connect

from chatrobot.cli.web import listen
from chatrobot.core.errors import LinkError
from chatrobot.core.events import Event
from chatrobot.core.geometry import Twist
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.web.access import Access
from chatrobot.web.room import Room
from chatrobot.web.server import WebServer

PATIENCE_S = 10.0
BEAT_S = 0.05


class NotingSession:
    """Notes what it is told, and when; a turn is open until a test says how it ended."""

    def __init__(self) -> None:
        self.log: list[tuple[Any, ...]] = []
        self.times_s: list[float] = []
        self.results: dict[int, Any] = {}
        self.options = SimpleNamespace(approve=False)
        self.understanding = SimpleNamespace(places=SimpleNamespace(all=dict))
        self.authoring: Any = None
        self.is_lost = False
        self.turn = 0
        self.noted = threading.Condition()

    def _note(self, *what: Any) -> None:
        if self.is_lost:
            raise LinkError("Motion is gone")
        with self.noted:
            self.log.append(what)
            self.times_s.append(time.monotonic())
            self.noted.notify_all()

    def _take(self, *what: Any) -> int:
        self._note(*what)
        self.turn += 1
        return self.turn

    def say(self, text: str) -> int:
        return self._take("say", text)

    def say_plan(self, plan_text: str) -> int:
        return self._take("say_plan", plan_text)

    def say_edited_plan(self, plan_text: str, instead_of: str = "") -> int:
        return self._take("say_edited_plan", plan_text, instead_of)

    def say_source(self, name: str, source: str) -> int:
        return self._take("say_source", name, source)

    def say_draft(self, draft: Any) -> int:
        return self._take("say_draft", draft)

    def resume(self) -> int:
        return self._take("resume")

    def change_obstacle(self, **request: Any) -> None:
        self._note("obstacle", request)

    def pause(self, why: str = "") -> None:
        self._note("pause", why)

    def stop(self, why: str = "") -> None:
        self._note("stop", why)

    def emergency_stop(self, why: str = "") -> None:
        self._note("emergency_stop", why)

    def release(self) -> None:
        self._note("release")

    def approve(self, turn: int, yes: bool, *, edited: bool = False) -> None:
        self._note("approve", turn, yes, *(["edited"] if edited else []))

    def steer(self, twist: Twist) -> None:
        self._note("steer", *twist)

    def watch_scans(self, wanted: bool) -> None:
        self.is_watched = wanted

    def wait_for(self, *what: Any, timeout_s: float = PATIENCE_S) -> float:
        """Return when that was first noted."""
        with self.noted:
            assert self.noted.wait_for(lambda: what in self.log, timeout_s), f"{what} not in {self.log[-10:]}"
            return self.times_s[self.log.index(what)]


class Client:
    """A page: what it is told is kept; `hold` it alive and it beats as a page's worker does."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket
        self.heard: list[dict[str, Any]] = []
        self._beating = threading.Event()

    def say(self, do: str, **fields: Any) -> None:
        self.socket.send(json.dumps({"do": do, **fields}))

    def wait_for(self, kind: str, timeout_s: float = PATIENCE_S, **fields: Any) -> dict[str, Any]:
        """Return the next message of that kind with those fields."""
        ends_s = time.monotonic() + timeout_s
        while True:
            told = json.loads(self.socket.recv(max(0.0, ends_s - time.monotonic())))
            self.heard.append(told)
            if told["is"] == kind and fields.items() <= told.items():
                return told

    def wait_for_event(self, name: str, timeout_s: float = PATIENCE_S) -> dict[str, Any]:
        """Return the next message of an event of that name."""
        while (told := self.wait_for("event", timeout_s))["event"]["event"] != name:
            pass
        return told

    def hold(self) -> None:
        """Begin to beat."""
        if not self._beating.is_set():
            self._beating.set()
            threading.Thread(target=self._beat, daemon=True).start()
            time.sleep(BEAT_S)

    def freeze(self) -> None:
        """Beat no more; the connection stays."""
        self._beating.clear()

    def _beat(self) -> None:
        with contextlib.suppress(Exception):  # it was closed
            while self._beating.is_set():
                self.say("beat", held=False)
                time.sleep(BEAT_S)


class WebRig:
    """One robot by default; `rooms` for more."""

    def __init__(self, access: Access, rooms: Sequence[str] = ("",), camera: Any = None) -> None:
        self.access = access
        self.sessions = {name: NotingSession() for name in rooms}
        self.rooms = {name: Room(name) for name in rooms}
        for name, room in self.rooms.items():
            connection: Any = SimpleNamespace(
                session=self.sessions[name],
                profile=load_profile("wheeltec_mini_mec"),
                world=load_world("home"),
                camera=camera,
            )
            room.open(connection, lambda job: job(), is_simulated=True)
        self.server = WebServer(access, self.rooms)
        self._open = contextlib.ExitStack()

    @property
    def session(self) -> NotingSession:
        return self.sessions[""]

    @property
    def room(self) -> Room:
        return self.rooms[""]

    def call(self, job: Callable[[], None]) -> None:
        """Have `job` done by the event loop of the pages."""
        _, pages = self.server._threads
        pages.loop.call_soon_threadsafe(job)

    def revoke(self, token: str) -> None:
        """Let nobody in with that token any more, and close what it had opened, as a class does."""
        self.access.revoke(token)
        for face in self.room.drop(token):
            self.call(face.close)

    def tell(self, event: Event) -> None:
        """Have something happen."""
        self.room.hear(event)

    @contextlib.contextmanager
    def telling(self, event: Event) -> Iterator[None]:
        """Have it happen ten times a second, as telemetry does."""
        ends = threading.Event()

        def tell() -> None:
            while not ends.wait(0.1):
                self.tell(event)

        thread = threading.Thread(target=tell)
        thread.start()
        try:
            yield
        finally:
            ends.set()
            thread.join()

    @property
    def origin(self) -> str:
        return f"http://127.0.0.1:{self.access.port}"

    def http(self, **how: Any) -> httpx.Client:
        return self._open.enter_context(httpx.Client(base_url=self.origin, trust_env=False, **how))

    def dial(self, path: str = "/ws", port: int = 0, **how: Any) -> ClientConnection:
        how = {"origin": self.origin, "proxy": None, "max_size": 2**22, "close_timeout": 0.5, **how}
        address = f"ws://127.0.0.1:{port or self.access.port}{path}"
        return self._open.enter_context(connect(address, **how))

    def page(self, path: str = "/ws", *, beats: bool = True, **how: Any) -> Client:
        """Open a page and wait until it is in."""
        client = Client(self.dial(path, **how))
        client.wait_for("hello")
        if beats:
            client.hold()
        return client

    def stop_line(self, path: str = "/stop", **how: Any) -> Client:
        return Client(self.dial(path, self.access.stop_port, **how))

    def close(self) -> None:
        self._open.close()
        self.server.close()


@contextlib.contextmanager
def serving(
    access: Access | None = None, rooms: Sequence[str] = ("",), camera: Any = None
) -> Iterator[WebRig]:
    """Serve a robot that only notes what it is told."""
    access = access or Access("127.0.0.1")
    rig = WebRig(access, rooms, camera)
    rig.server.start(listen(access.host, 0), listen(access.host, 0))
    try:
        yield rig
    finally:
        rig.close()
