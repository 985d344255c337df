"""One instruction of an agent, from its text to its measured end, with progress on the way.

Whoever gives up on a call (cancels it, or is gone) stops the robot: the zero is out before anything else is done.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Literal

from chatrobot.core.errors import LinkError
from chatrobot.core.events import (
    Event,
    Interpreted,
    Limited,
    Notice,
    Paused,
    ProgramLog,
    ProgramRehearsed,
    ProgramWritten,
    Progress,
    Rehearsed,
    Remembered,
    Result,
    Said,
)
from chatrobot.core.reason import Reason, one_line
from chatrobot.dialogue.session import Session
from chatrobot.mcp_server.record import words_of
from chatrobot.mcp_server.robot import SOURCE, AgentRobot
from chatrobot.reflex import is_emergency_stop, is_pause, is_stop, leads_with_stop

MOST_WAITING = 10
MOST_NOTES = 20
REPORT_S = 0.5
CANCELLED = "the call was cancelled"
CLIENT_GONE = "the agent's client is gone"

Report = Callable[[float, str], Awaitable[None]]
"""Tells the client how far a call is: 0 to 100, and in words."""


class Line:
    """The client's end of one call, as far as it can be seen: `hang_up` when it is gone before its answer."""

    def __init__(self) -> None:
        self.is_gone = False
        self.on_gone: Callable[[], None] = lambda: None

    def hang_up(self) -> None:
        """The client is gone. On the server's thread."""
        self.is_gone = True
        self.on_gone()


@dataclass
class Course:
    """What has come of an instruction.

    `state`: `done` with its `result`; `waiting` for a person's yes; `paused`, its plan kept; `dropped`, not begun
    because what came before it was not done; `busy`, too many wait already.
    """

    state: Literal["done", "waiting", "paused", "dropped", "busy"] = "done"
    turn: int = 0
    result: Result | None = None
    interpreted: Interpreted | None = None
    rehearsed: Rehearsed | None = None
    paused: Paused | None = None
    program: ProgramWritten | None = None
    program_rehearsed: ProgramRehearsed | None = None
    rehearse_only: bool = False
    resumed: int = 0
    """The paused turn that it goes on with."""
    is_program: bool = False
    """It was asked of `programs`."""
    is_plan: bool = False
    """It was given as a plan, not in words."""
    is_emergency: bool = False
    """An emergency stop is set, as far as is known."""
    lacks_person: bool = False
    """It needed a person's yes, and nobody is there to say it."""
    notes: list[str] = field(default_factory=list)

    def hear(self, event: Event, language: str) -> None:
        """Take in an event of its turn, or of none."""
        if isinstance(event, Interpreted) and (event.plan_text or self.interpreted is None):
            self.interpreted = event
        elif isinstance(event, Rehearsed):
            self.rehearsed = event
        elif isinstance(event, ProgramWritten):
            self.program = event
        elif isinstance(event, ProgramRehearsed):
            self.program_rehearsed = event
        elif isinstance(event, (Notice, Limited, Remembered, Said, ProgramLog)):
            words = one_line(words_of(event, language))
            if words and words not in self.notes and len(self.notes) < MOST_NOTES:
                self.notes.append(words)


class Calls:
    """Takes the instructions of one client, each when its turn has come. Belongs to the server's thread."""

    def __init__(self, robot: AgentRobot) -> None:
        self._robot = robot
        self._left_open: set[int] = set()
        """Turns whose calls have returned before their end: they wait for a yes, have had it, or are paused."""

    def leave(self) -> None:
        """The client is gone, and with it what it has asked for."""
        session = self._robot.session
        unfinished = [turn for turn in self._left_open if session is not None and turn not in session.results]
        if unfinished == [self._robot.waiting_turn] and session is not None:
            with contextlib.suppress(LinkError):  # Motion is gone: nothing waits there any more
                session.approve(unfinished[0], yes=False)
        elif unfinished:
            self._robot.stop(CLIENT_GONE)

    async def do(
        self,
        say: Callable[[Session], int],
        report: Report,
        line: Line | None = None,
        *,
        text: str = "",
        rehearse_only: bool = False,
    ) -> Course:
        """Say it when its turn comes, and see it through.

        Args:
            say: hands it to the session; gives the number of its turn.
            text: what is said, if it is words: a stop among them waits for nothing.
            rehearse_only: nothing moves.

        Raises:
            RobotGoneError: there is no robot.
        """
        setbacks = self._robot.setbacks
        session = (await self._robot.ready()).session
        if text and _is_urgent(text, session):
            self._robot.setbacks += 1
            if is_emergency_stop(text):
                self._robot.record.emergency = Reason("emergency_stop", {"source": SOURCE})
            return await self._see_through(session, say, report, line, rehearse_only=rehearse_only)
        if self._robot.waiting_turn is not None:
            return Course("waiting", self._robot.waiting_turn)
        turns = self._robot.turns
        if len(turns.waiting) >= MOST_WAITING:
            return Course("busy")
        async with turns.taken() as place:
            if line is not None and line.is_gone:
                turns.give_up(place)
            if self._robot.setbacks != setbacks or place.is_dropped:
                return Course("dropped")
            return await self._see_through(session, say, report, line, rehearse_only=rehearse_only)

    async def _see_through(
        self,
        session: Session,
        say: Callable[[Session], int],
        report: Report,
        line: Line | None,
        *,
        rehearse_only: bool,
    ) -> Course:
        news: asyncio.Queue[Event | None] = asyncio.Queue()
        course = Course(rehearse_only=rehearse_only)
        with self._robot.listening(news.put_nowait), self._watched(course, line, news):
            session.options = replace(session.options, rehearse_only=rehearse_only)
            course.turn = say(session)
            progress = _Reporter(report)
            while course.state == "done" and course.result is None:
                if line is not None and line.is_gone:
                    break
                event = await news.get()
                if event is None:
                    await self._robot.ready()  # raises where the robot is gone
                else:
                    self._take(event, course, session)
                    await progress.tell(event)
        if course.state != "done":
            self._left_open.add(course.turn)
        course.is_emergency = self._robot.is_emergency
        if course.result is not None and course.result.outcome not in ("completed", "answered"):
            self._robot.setbacks += 1
        return course

    @contextlib.contextmanager
    def _watched(
        self, course: Course, line: Line | None, news: asyncio.Queue[Event | None]
    ) -> Iterator[None]:
        """However it is left before its end, the robot is stopped first."""

        def hang_up() -> None:
            self._robot.stop(CLIENT_GONE)
            news.put_nowait(None)

        if line is not None:
            line.on_gone = hang_up
        try:
            yield
        finally:
            if line is not None:
                line.on_gone = lambda: None
            if course.state == "done" and course.result is None:
                self._robot.stop(CANCELLED)

    def _take(self, event: Event, course: Course, session: Session) -> None:
        if isinstance(event, Interpreted) and event.turn == self._robot.paused_turn:
            course.resumed = event.turn
        if event.turn in (course.turn, 0):
            course.hear(event, session.understanding.language)
        if event.turn != course.turn:
            return
        if isinstance(event, Result) and course.resumed:  # it was a word to go on: its motion is what counts
            course.turn, course.resumed = course.resumed, 0
        elif isinstance(event, Result):
            course.result = event
        elif isinstance(event, Paused):
            course.paused, course.state, self._robot.paused_turn = event, "paused", event.turn
        elif isinstance(event, Rehearsed) and event.needs_approval and not course.rehearse_only:
            if self._robot.approval_address():
                course.state = "waiting"
                self._robot.wait_for_yes(course.turn)
            else:
                course.lacks_person = True
                session.approve(course.turn, yes=False)


def _is_urgent(text: str, session: Session) -> bool:
    """It stops the robot, or may: it waits for no other call."""
    moves = session.is_moving and leads_with_stop(text)
    return moves or is_stop(text) or is_pause(text) or is_emergency_stop(text)


class _Reporter:
    """Tells the client how far a turn is, twice a second, in numbers that only grow."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._told_s = 0.0
        self._percent = 0.0

    async def tell(self, event: Event) -> None:
        """Tell, if it is time."""
        if not isinstance(event, Progress) or time.monotonic() - self._told_s < REPORT_S:
            return
        self._told_s = time.monotonic()
        known = 100.0 * event.fraction if event.fraction is not None else 0.0
        self._percent = max(known, self._percent + 0.01)
        pose = event.pose
        await self._report(
            self._percent, f"step {event.step} of {event.of}, at ({pose.x_m:.2f}, {pose.y_m:.2f}) m"
        )
