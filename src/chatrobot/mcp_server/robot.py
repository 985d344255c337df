"""The robot of an agent: a session in the name of `agent`, started in the background, and who listens to it."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import AsyncIterator, Callable, Iterator

from chatrobot.compose import Connection
from chatrobot.core.errors import ChatRobotError, LinkError
from chatrobot.core.events import Event, Finished, Rehearsed, Started
from chatrobot.core.process import wake_as_others_do
from chatrobot.dialogue.pump import Pump
from chatrobot.dialogue.session import Session
from chatrobot.mcp_server.record import Record

SOURCE = "agent"
Connect = Callable[[Callable[[Event], None]], Connection]
"""Meets the robot; its argument hears every event. Blocks until the robot is there."""
Listener = Callable[[Event | None], None]
"""Hears events on the server's thread; None: look again, something else has changed."""

_POLL_S = 0.02
_ENDING = "This server is ending."


class Place:
    """That of one instruction in the line."""

    is_dropped = False
    """One before it was given up: it is not begun."""


class Turns:
    """Whose turn it is: one instruction at a time, of all clients of a robot."""

    def __init__(self) -> None:
        self.lock = asyncio.Lock()
        self.waiting: list[Place] = []
        """Those that have been taken, in their order; the first may be under way."""

    @contextlib.asynccontextmanager
    async def taken(self) -> AsyncIterator[Place]:
        """Get in line, and wait for the turn: within it nobody else has it."""
        place = Place()
        self.waiting.append(place)
        try:
            async with self.lock:
                yield place
        except asyncio.CancelledError:
            self.give_up(place)
            raise
        finally:
            self.waiting.remove(place)

    def give_up(self, place: Place) -> None:
        """Nobody waits for that one any more: what was to begin where it ends is not begun."""
        for behind in self.waiting[self.waiting.index(place) :]:
            behind.is_dropped = True


class RobotGoneError(ChatRobotError):
    """There is no robot to talk to; the message says why, and the way out."""


class AgentRobot:
    """One session for all calls. `start` once there is a loop; `stop` and `close` from any thread.

    Args:
        connect: meets the robot, in a thread of its own.
        approval_address: where a person says yes to a plan, "" where nobody is there to say it.
        is_latched: whether a person beside it has set the emergency stop.
        is_shared: it is the robot of a person's web console.
    """

    def __init__(
        self,
        connect: Connect,
        approval_address: Callable[[], str] = lambda: "",
        is_latched: Callable[[], bool] = lambda: False,
        *,
        is_shared: bool = False,
    ) -> None:
        self._connect = connect
        self.is_shared = is_shared
        self.approval_address = approval_address
        self._is_latched = is_latched
        self.record = Record()
        self.turns = Turns()
        self.setbacks = 0
        """Steps with each stop and each instruction that was not done: what was asked for before it is not begun."""
        self.waiting_turn: int | None = None
        """The turn that waits for a person's yes, without a call that waits for it."""
        self._begun_turn: int | None = None
        """The turn that began or ended last, since it was rehearsed: a yes to it has come."""
        self.paused_turn: int | None = None
        """The turn whose plan is kept by a pause, without a call that waits for it."""
        self.connection: Connection | None = None
        self._pump: Pump | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._listeners: list[Listener] = []
        self._failure: Exception | None = None
        self._is_starting = self._is_refusing = self._is_closed = False
        self._changing = threading.Lock()

    # --- the server's thread ---

    def start(self) -> None:
        """Begin to meet the robot, unless that is under way or done."""
        self._loop = asyncio.get_running_loop()
        with self._changing:
            if self._is_starting or self._is_closed or self.connection is not None:
                return
            self._is_starting, self._failure = True, None
        threading.Thread(target=self._meet, name="meet", daemon=True).start()

    async def ready(self) -> Connection:
        """Wait until the robot is there.

        Raises:
            RobotGoneError: it cannot be met, or is gone.
        """
        self.start()
        if self._is_refusing:
            raise RobotGoneError(_ENDING)
        while self.connection is None:
            if self._failure is not None:
                raise RobotGoneError(f"{self._failure} The next call tries again.") from self._failure
            if self._is_closed:
                raise RobotGoneError(_ENDING)
            await asyncio.sleep(_POLL_S)
        if self._failure is not None:
            raise RobotGoneError(
                f"{self._failure} A person has to restart this MCP server."
            ) from self._failure
        return self.connection

    @contextlib.contextmanager
    def listening(self, listener: Listener) -> Iterator[None]:
        """Within it `listener` hears every event."""
        self._listeners.append(listener)
        try:
            yield
        finally:
            self._listeners.remove(listener)

    # --- from any thread ---

    @property
    def session(self) -> Session | None:
        """Return the session; None before the robot is there."""
        return self.connection.session if self.connection is not None else None

    @property
    def language(self) -> str:
        """Return the language of what was last said."""
        return self.session.understanding.language if self.session is not None else "en"

    @property
    def is_emergency(self) -> bool:
        """An emergency stop is set, as far as is known here."""
        return self.record.emergency is not None or self._is_latched()

    def wait_for_yes(self, turn: int) -> None:
        """Have that turn wait for a person's yes, which may have come already: the pumping thread hears of it first."""
        self.waiting_turn = turn
        if self._begun_turn == turn:
            self.waiting_turn = None

    def stop(self, why: str) -> None:
        """Stop the robot, and begin nothing that was asked for before. Waits for nothing."""
        self.setbacks += 1
        self.waiting_turn = None
        session = self.session
        if session is not None:
            with contextlib.suppress(LinkError):  # Motion is gone: its guard halts
                session.stop(why)

    def refuse(self, why: str) -> None:
        """Stop the robot, and take no call any more: what is under way can still tell how it ended."""
        self._is_refusing = True
        self.stop(why)

    def close(self, why: str = "the agent's client is gone") -> None:
        """Stop the robot and leave it. Closing twice does no harm."""
        with self._changing:
            if self._is_closed:
                return
            self._is_closed = True
        self.refuse(why)
        if self._pump is not None:
            self._pump.stop()
        if self.connection is not None:
            self.connection.close()

    # --- threads of its own ---

    def _meet(self) -> None:
        wake_as_others_do()  # whatever the thread that serves has
        try:
            connection = self._connect(self._hear)
        except (ChatRobotError, OSError) as error:
            self._failure = error
            self._is_starting = False
            return
        with self._changing:
            pump = Pump(connection.session, self._lose)
            self._pump, self.connection, self._is_starting = pump, connection, False
            is_late = self._is_closed
            if not is_late:
                pump.start()
        if is_late:  # nothing was asked of it
            connection.close()

    def _hear(self, event: Event) -> None:
        """On the pumping thread."""
        self.record.hear(event, self.language)
        if isinstance(event, Rehearsed):  # what was paused is asked about once more
            self._begun_turn = None
        elif isinstance(event, (Started, Finished)):
            self._begun_turn = event.turn
            self.waiting_turn = None if event.turn == self.waiting_turn else self.waiting_turn
            self.paused_turn = None if event.turn == self.paused_turn else self.paused_turn
        self._tell(event)

    def _lose(self, error: Exception) -> None:
        self._failure = error
        self._tell(None)

    def _tell(self, event: Event | None) -> None:
        if self._loop is not None and self._listeners:
            with contextlib.suppress(RuntimeError):  # the loop has ended: so have its calls
                self._loop.call_soon_threadsafe(self._pass_on, event)

    def _pass_on(self, event: Event | None) -> None:
        for listener in tuple(self._listeners):
            listener(event)
