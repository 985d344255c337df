"""One page's WebSocket: it joins a room, reads what the page says and does it, sends what the page is to be told."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from chatrobot.core.errors import LinkError
from chatrobot.core.geometry import Twist
from chatrobot.language.interpretation import LanguageCode, language_of_tags
from chatrobot.link.envelope import OBSTACLE_RADIUS_M
from chatrobot.plan.steps import Go
from chatrobot.reflex import is_release, leads_with_stop
from chatrobot.web.access import EMERGENCY_BUTTON, STOP_BUTTON, Pass
from chatrobot.web.limits import ABORT, UNREAD, Rate
from chatrobot.web.outbox import Face, Message, Outbox
from chatrobot.web.protocol import FIELDS, Fields, MalformedError, read_message
from chatrobot.web.room import Room
from chatrobot.web.words import command_message, refused, web_words

CLOSE_S = 0.5
"""So long a page may take to read why it is closed."""
COSTS = {"history": 10, "programs": 5, "program": 5}
"""What is answered with much counts as so many messages."""
MOST_MALFORMED = 10
"""A page that says so much that is not understood is none of ours."""
UNSUPPORTED, POLICY, TRY_LATER = 1003, 1008, 1013
"""Codes of a closed WebSocket (RFC 6455, section 7.4): it sent bytes; it went too far; it reads too slowly."""
_BROWSERS = (("Edg", "Edge"), ("Firefox", "Firefox"), ("Chrome", "Chrome"), ("Safari", "Safari"))
_numbers = itertools.count(1)


class Page:
    """Somebody's browser: a `Face` of a room."""

    def __init__(self, websocket: WebSocket, pass_: Pass) -> None:
        self.id = f"page-{next(_numbers)}"
        self.pass_ = pass_
        wants = websocket.headers.get("accept-language", "")
        self.language: LanguageCode = language_of_tags(wants)
        agent = websocket.headers.get("user-agent", "")
        browser = next((name for mark, name in _BROWSERS if mark in agent), "page")
        number, code = self.id.partition("-")[2], "teacher_name" if pass_.role == "teacher" else "page_name"
        self.name = web_words(self.language, code, browser=browser, number=number)
        self._has_to_go = asyncio.Event()
        self.outbox = Outbox(self.close)
        self.unread_bytes: Callable[[], int] = websocket.scope["extensions"][UNREAD]

    @property
    def is_local(self) -> bool:
        """It is at this machine."""
        return self.pass_.is_local

    def put(self, message: Message) -> None:
        """Have it told. From any thread."""
        self.outbox.put(message)

    def close(self) -> None:
        """Have its connection end. For the event loop."""
        self._has_to_go.set()

    async def wait_for_close(self) -> None:
        """Wait until somebody has it ended."""
        await self._has_to_go.wait()


class Joined(Protocol):
    """What a page joins: a room, or a class."""

    def join(self, face: Face) -> None:
        """Let a page in."""

    def leave(self, face: Face) -> None:
        """Take note that it is gone."""


class Conversation:
    """Serves one page, whatever it may say. Belongs to the event loop.

    Args:
        fields: what it may say.
        do: does what a message that was read says.
    """

    def __init__(
        self,
        websocket: WebSocket,
        joined: Joined,
        page: Page,
        fields: Fields,
        do: Callable[[dict[str, Any]], None],
    ) -> None:
        self._socket = websocket
        self._joined = joined
        self._fields, self._do = fields, do
        self._page = page
        self._rates = {"steer": Rate(), "beat": Rate(), "": Rate()}
        self._malformed = 0
        self._code = TRY_LATER

    async def serve(self) -> None:
        """Serve the page until it or we have had enough."""
        self._joined.join(self._page)
        tasks = [
            asyncio.ensure_future(task) for task in (self._read(), self._send(), self._page.wait_for_close())
        ]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._joined.leave(self._page)
            for task in tasks:
                task.cancel()
            results = await asyncio.gather(*tasks, return_exceptions=True)
            await self._close()
        for result in results:
            if isinstance(result, Exception) and not isinstance(result, WebSocketDisconnect):
                raise result

    async def _close(self) -> None:
        if self._socket.application_state is not WebSocketState.CONNECTED:
            return
        with contextlib.suppress(RuntimeError, WebSocketDisconnect, OSError):  # the page was faster
            try:
                await asyncio.wait_for(self._socket.close(self._code), CLOSE_S)
            except asyncio.TimeoutError:  # it does not read
                self._socket.scope["extensions"][ABORT]()

    async def _send(self) -> None:
        while True:
            for message in await self._page.outbox.take():
                await self._socket.send_text(message.text_in(self._page.language))

    async def _read(self) -> None:
        while True:
            received = await self._socket.receive()
            if received["type"] == "websocket.disconnect":
                return
            text = received.get("text")
            if text is None:
                self._code = UNSUPPORTED
                return
            if not self._take(text):
                self._code = POLICY
                return

    def _take(self, text: str) -> bool:
        """Do what a message says. False where this page has gone too far."""
        page = self._page
        try:
            message = read_message(text, self._fields)
        except MalformedError as error:
            self._malformed += 1
            page.put(refused("malformed", problem=str(error)))
            return self._malformed <= MOST_MALFORMED
        do = message["do"]
        if not self._rates.get(do, self._rates[""]).allows(COSTS.get(do, 1)) and do not in (
            "stop",
            "emergency_stop",
        ):
            page.put(refused("too_many", do))
            return False
        self._do(message)
        return True


def serve_room(websocket: WebSocket, room: Room, page: Page) -> Conversation:
    """Return the conversation of a page with a room."""

    def do(message: dict[str, Any]) -> None:
        word = message["do"]
        if word in _BEATS:
            room.steering.beat(page)
        is_release_typed = word == "say" and page.pass_.may_steer and is_release(message["text"])
        why = "" if is_release_typed else why_not(room, page, word)  # its button asks for no steering either
        if why and word == "say" and leads_with_stop(message["text"]):
            word, why = "stop", ""  # from whoever watches, too, as by the button
        if why:
            page.put(refused(why, word))
            return
        try:
            ACTIONS[word](room, page, message)
        except LinkError as error:
            room.lose(error)

    return Conversation(websocket, room, page, FIELDS, do)


_BEATS = ("beat", "steer")
_FREE = frozenset({"stop", "emergency_stop", "beat", "programs", "program", "language", "history", "look"})
"""What anybody may say who may see the robot."""
_NEEDS_BEATS = frozenset({"say", "say_plan", "edit", "go", "resume", "run_program", "edit_program"})


def why_not(room: Room, page: Page, do: str) -> str:
    """Return the code of why this page may not say that just now; "" where it may."""
    if do in _FREE:
        return ""
    if do == "release":
        elsewhere = "release_elsewhere" if page.pass_.role == "steerer" else "not_for_you"
        return "" if page.pass_.may_release else elsewhere
    if not page.pass_.may_steer:
        return "may_only_watch"
    if do == "take":
        return ""
    if do == "obstacle" and page.pass_.role == "teacher":
        return ""
    if not room.steers(page):
        return "not_steering" if room.steering.steerer is not None else "nobody_steers"
    return "silent" if do in _NEEDS_BEATS and not room.steering.is_alive else ""


def _steer(room: Room, page: Page, said: dict[str, Any]) -> None:
    room.steering.stick(page, Twist(said["vx_mps"], said["vy_mps"], said["wz_radps"]))


def _go(room: Room, page: Page, said: dict[str, Any]) -> None:
    """`text` is how the page puts it where it goes to a place by its name."""
    yaw_rad = said.get("yaw_rad")
    where = Go(round(said["x_m"], 3), round(said["y_m"], 3), yaw_rad, place=said.get("place", ""))
    room.go(page, where, said.get("text", ""), asks=said.get("ask", True))


def _obstacle(room: Room, page: Page, said: dict[str, Any]) -> None:
    """Without a place it is taken away."""
    is_put = "x_m" in said and "y_m" in said
    circle = (
        [said["x_m"], said["y_m"], abs(said.get("radius_m", OBSTACLE_RADIUS_M)) or OBSTACLE_RADIUS_M]
        if is_put
        else None
    )
    room.change_obstacle(page, said["name"], circle)


def _say(room: Room, page: Page, said: dict[str, Any]) -> None:
    """A command of the terminal is answered with what does the same at a page."""
    text = said["text"]
    if room.take_command(page, text):
        return
    if message := command_message(text):
        room.note_said(0, text, page.id, page.name)
        room.tell_people(message)
        return
    room.say(page, text)


def _language(_: Room, page: Page, said: dict[str, Any]) -> None:
    page.language = said["code"]


def _history(room: Room, page: Page, _: dict[str, Any]) -> None:
    page.put(Message(lambda language: {"is": "history", "history": room.history(language)}))


ACTIONS: Mapping[str, Callable[[Room, Page, dict[str, Any]], None]] = {
    "say": _say,
    "say_plan": lambda room, page, said: room.say_plan(page, said["plan_text"]),
    "approve": lambda room, page, said: room.answer(page, said["turn"], said["yes"]),
    "edit": lambda room, page, said: room.say_edited(page, said["plan_text"], said["turn"]),
    "go": _go,
    "obstacle": _obstacle,
    "pause": lambda room, _, __: room.session.pause("pause()"),
    "resume": lambda room, page, _: room.resume(page),
    "stop": lambda room, page, _: room.stop(page.pass_.pressed(STOP_BUTTON)),
    "emergency_stop": lambda room, page, _: room.emergency_stop(page.pass_.pressed(EMERGENCY_BUTTON)),
    "release": lambda room, _, __: room.release(),
    "steer": _steer,
    "beat": lambda _, __, ___: None,  # that it came is all
    "take": lambda room, page, _: room.take(page),
    "give": lambda room, _, __: room.take(None),
    "programs": lambda room, page, _: room.programs.list_all(page),
    "program": lambda room, page, said: room.programs.show(page, said["name"]),
    "run_program": lambda room, page, said: room.run_program(page, said["name"]),
    "edit_program": lambda room, page, said: room.edit_program(page, said["name"], said["source"]),
    "language": _language,
    "history": _history,
    "look": lambda room, page, _: room.camera.ask(page) if room.camera is not None else None,
}
