"""`chatrobot --web`: the conversation of the terminal in a browser, too. Loaded once there is a prompt."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Any

from chatrobot.cli.console.controller import ChatController
from chatrobot.core.errors import ChatRobotError
from chatrobot.core.events import Event

if TYPE_CHECKING:
    from chatrobot.language.interpretation import LanguageCode
    from chatrobot.web.access import Pass
    from chatrobot.web.outbox import Message
    from chatrobot.web.room import Room
    from chatrobot.web.server import WebServer

AFTER_PROMPT_S = 0.5
"""The prompt is drawn, and the first key echoed, before anything is loaded."""
_EARLY = 200


class PageBeside:
    """Shows the session of a terminal to pages of this machine. What was told before it is there is told then.

    `hear` belongs to the pumping thread, `start` and `close` to that of the display.
    """

    def __init__(self, controller: ChatController, *, is_simulated: bool) -> None:
        self._controller = controller
        self._is_simulated = is_simulated
        self._early: deque[Event] = deque(maxlen=_EARLY)
        self._lock = threading.Lock()
        self._room: Room | None = None
        self._server: WebServer | None = None
        self.is_latched = False
        """What pages and terminal were last told of the emergency stop. Belongs to the pumping thread."""
        self._is_closed = threading.Event()
        self._thread = threading.Thread(target=self._load, name="web console", daemon=True)
        controller.on_said.append(self.note_said)

    def start(self) -> None:
        """Load it, in a thread of its own."""
        self._thread.start()

    def hear(self, event: Event) -> None:
        """Take an event in."""
        with self._lock:
            room = self._room
            if room is None and event.name != "telemetry":
                self._early.append(event)
        if room is None:
            return
        room.hear(event)
        if self._controller.latched != self.is_latched:
            self.is_latched = self._controller.latched
            room.note_alarm(self.is_latched)

    def note_said(self, turn: int, text: str) -> None:
        """Take in what was typed at the terminal."""
        if self._room is not None:
            self._room.note_said(turn, text, "terminal", self._controller.words.say("web_terminal"))

    def close(self) -> None:
        """Tell the pages that nobody serves them any more. What the terminal told the robot is still done."""
        self._is_closed.set()
        self._thread.join()
        if self._server is not None:
            self._server.close(stops=False)

    def _load(self) -> None:
        if self._is_closed.wait(AFTER_PROMPT_S):
            return
        try:
            from chatrobot.cli.web import listen
            from chatrobot.web.access import Access
            from chatrobot.web.room import Room
            from chatrobot.web.server import WebServer
        except ImportError as error:
            self._controller.tell("web_missing", library=error.name)
            return
        controller, access, room = self._controller, Access("127.0.0.1"), Room()
        room.open(controller.connection, controller.pump.post, is_simulated=self._is_simulated)
        server = WebServer(access, {room.name: room})
        try:
            server.start(listen(access.host, None), listen(access.host, 0))
        except ChatRobotError as error:
            controller.tell("web_failed", problem=error)
            return
        room.join(_Terminal(self, controller))
        with self._lock:
            for event in self._early:
                room.hear(event)
            self._room, self._server = room, server
        controller.tell("web_address", url=f"{access.origin(access.host)}/")


class _Terminal:
    """The terminal as one of those who are told: it prints what pages say, and knows of their alarms."""

    id = "terminal"

    def __init__(self, beside: PageBeside, controller: ChatController) -> None:
        from chatrobot.web.access import Pass

        self._beside = beside
        self._controller = controller
        self.name = controller.words.say("web_terminal")
        self.language: LanguageCode = controller.words.language
        self.pass_: Pass = Pass("watcher", is_local=True)
        self.is_local = True

    def unread_bytes(self) -> int:
        """Return 0: nothing of a terminal comes over the network, and it steers nothing here."""
        return 0

    def close(self) -> None:
        """Do nothing: the terminal has no connection that a server could end."""

    def put(self, message: Message) -> None:
        """Have it shown by the thread that shows all else: a terminal that was halted holds up no page."""
        self._controller.pump.post(lambda: self._show(message))

    def _show(self, message: Message) -> None:
        """Print what concerns a person at the terminal."""
        told: dict[str, Any] = message.object_in(self._controller.words.language)
        if told["is"] == "said" and told["by"] != self.id:
            self._controller.tell("web_said", name=told["name"], text=told["text"])
        elif told["is"] == "lost":
            self._controller.tell("web_lost", text=told["text"])
        elif told["is"] == "emergency":
            self._controller.latched = self._beside.is_latched = told["set"]
            self._controller.display.refresh()
