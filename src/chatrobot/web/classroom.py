"""A class: a room for each pupil, and what the page of whoever teaches shows of all of them and may do to them."""

from __future__ import annotations

import asyncio
import contextlib
import sys
import threading
import traceback
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

from starlette.websockets import WebSocket

from chatrobot.core.errors import LinkError
from chatrobot.core.events import Event, Interpreted, Result, Telemetry
from chatrobot.dialogue.pump import Pump
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.language.interpretation import LanguageCode
from chatrobot.lessons.run import LessonRun
from chatrobot.lessons.sheet import Sheet
from chatrobot.web.access import EMERGENCY_BUTTON, STOP_BUTTON, Access
from chatrobot.web.class_recordings import ClassRecordings
from chatrobot.web.connection import Conversation, Page
from chatrobot.web.lesson import RoomLesson
from chatrobot.web.outbox import Face, Message
from chatrobot.web.protocol import MOST_TEXT_CHARS, Fields, is_text
from chatrobot.web.pupils import PupilsRobot, RobotWires
from chatrobot.web.room import Room
from chatrobot.web.words import refused, told, web_words
from chatrobot.wire.messages import Odometry

TELL_S = 0.25
"""So often the teacher's page is told of all robots."""
_MOST_SHOWN_CHARS = 300
"""Of a plan or a reply."""
_DIGITS = 3
LINK_ENDED = "the teacher has ended this link"


class Seat:
    """One pupil's room, and what was last heard of the robot in it. `hear` is called on the pumping thread.

    Args:
        token: what the pupil's link has to bring.
    """

    def __init__(self, name: str, token: str) -> None:
        self.room = Room(name)
        self.token = token
        self.lesson: RoomLesson | None = None
        self.record: Callable[[Event], None] = lambda _: None
        self._telemetry: Telemetry | None = None
        self._plan_text = self._reply = self._outcome = ""

    def hear(self, event: Event) -> None:
        """Take an event in, and tell the pupil's page."""
        if isinstance(event, Telemetry):
            self._telemetry = event
        elif isinstance(event, Interpreted):
            self._plan_text, self._reply, self._outcome = event.plan_text, event.reply, ""
        elif isinstance(event, Result):
            self._plan_text, self._reply, self._outcome = "", event.reply, event.outcome
        self.record(event)
        self.room.hear(event)
        if self.lesson is not None:
            self.lesson.hear(event)

    def facts(self, language: LanguageCode = "en") -> dict[str, Any]:
        """Return what the teacher's page shows of it."""
        seen = self._telemetry
        roles = [face.pass_.role for face in self.room.faces]
        return {
            "name": self.room.name,
            "link": f"/#{self.token}",
            "pages": len(roles) - roles.count("teacher"),
            "is_looked_at": "teacher" in roles,
            "pose": [round(value, _DIGITS) for value in seen.pose] if seen is not None else None,
            "moving": seen is not None and seen.moving,
            "emergency": self.room.is_latched,
            "gone": self.room.is_over,
            "said": self.room.last_said[:_MOST_SHOWN_CHARS],
            "plan_text": self._plan_text[:_MOST_SHOWN_CHARS],
            "reply": self._reply[:_MOST_SHOWN_CHARS],
            "outcome": self._outcome,
            "lesson": self.lesson.facts(language) if self.lesson is not None else None,
        }


class Classroom:
    """See the module. From any thread; `stop` and `emergency_stop` wait for nothing.

    Args:
        access: gives each pupil a token that is good for their own robot, and the teacher one for all.
        token: the teacher's, where one was chosen.
        sheet: the lesson that every pupil takes.
        recordings: keeps what every pupil's robot does.
    """

    def __init__(
        self,
        count: int,
        access: Access,
        token: str = "",
        sheet: Sheet | None = None,
        recordings: ClassRecordings | None = None,
    ) -> None:
        names = [str(place) for place in range(1, count + 1)]
        self._access = access
        self.token = access.issue("teacher", token=token)
        self.seats = {name: Seat(name, access.issue("pupil", name)) for name in names}
        self.rooms: Mapping[str, Room] = {name: seat.room for name, seat in self.seats.items()}
        self.sheet, self.recordings = sheet, recordings
        self._wires: RobotWires | None = None
        self.task = ""
        self.stop_port = 0
        self._faces: dict[str, Face] = {}
        self._robots: Sequence[PupilsRobot] = ()
        self._pumps: list[Pump] = []
        self._ended = threading.Event()

    def open(
        self,
        robots: Sequence[PupilsRobot],
        on_gone: Callable[[Exception], None],
        wires: RobotWires | None = None,
    ) -> None:
        """Let pupils in, each to their own robot, and begin to pump its session.

        Args:
            wires: what lesson and recordings hear the robots by; closed with the class.
            on_gone: told why a robot is gone, and with it all of them, for they share their processes. What goes wrong
                in one pupil's conversation ends that one alone.
        """
        self._robots = robots
        for robot in robots:
            room = self.rooms[robot.name]
            pump = Pump(robot.connection.session, partial(_lose, room, robot, on_gone))
            room.open(robot.connection, pump.post, is_simulated=True, release=robot.release)
            self._pumps.append(pump)
        if wires is not None:
            self._wires = wires
            self._listen(robots, wires)
        for pump in self._pumps:
            pump.start()
        threading.Thread(target=self._tell_all, name="class", daemon=True).start()

    def _listen(self, robots: Sequence[PupilsRobot], wires: RobotWires) -> None:
        """Have what the robots do recorded, and judged by the lesson."""
        if self.recordings is not None:
            for robot in robots:
                self.seats[robot.name].record = partial(self.recordings.hear, robot.name)
            self.recordings.open(((robot, self.rooms[robot.name]) for robot in robots), wires)
        if self.sheet is not None:
            for robot in robots:
                self._begin_lesson(self.sheet, robot, wires)
        wires.start()

    def _begin_lesson(self, sheet: Sheet, robot: PupilsRobot, wires: RobotWires) -> None:
        profile, name = robot.connection.profile, robot.name
        run, up_to_date = LessonRun(sheet, profile.footprint), partial(wires.bring_up_to_date, name)
        lesson = RoomLesson(run, self.rooms[name], profile.title, up_to_date, self.seats[name].record)
        wires.subscribe(name, wires.truth_topic, Odometry, lesson.hear_truth)
        lesson.open(robot.connection.session)
        self.seats[name].lesson = lesson

    def close(self) -> None:
        """Stop the robots, and end what they stand on."""
        self._ended.set()
        for pump, robot in zip(self._pumps, self._robots):
            with contextlib.suppress(LinkError):  # Motion is gone, and its guard halts the robot
                robot.connection.session.stop("the web console has ended")
            pump.stop()
        if self._wires is not None:
            self._wires.close()
        if self.recordings is not None:
            self.recordings.close()
        with ThreadPoolExecutor(
            max(1, len(self._robots))
        ) as pool:  # each waits for the Motion that all share
            list(pool.map(lambda robot: robot.connection.close(), self._robots))

    # --- a teacher's page; it joins and leaves as a pupil's does a room ---

    def join(self, face: Face) -> None:
        """Let a teacher's page in."""
        self._faces[face.id] = face
        hello = {
            "you": face.id,
            "name": face.name,
            "role": "teacher",
            "stop_port": self.stop_port,
            "task": self.task,
            "recorded": self.recordings is not None,
        }
        face.put(told("hello", **hello, may=["stop", "emergency_stop", "release"], steering=None, history=[]))
        face.put(self._message())

    def leave(self, face: Face) -> None:
        """Take note that it is gone. Nothing stops by that: the pupils go on."""
        self._faces.pop(face.id, None)

    def stop(self, why: str = STOP_BUTTON) -> None:
        """Stop all robots now."""
        self._each(lambda room: room.stop(why))

    def emergency_stop(self, why: str = EMERGENCY_BUTTON) -> None:
        """Stop all robots now, and keep them stopped until they are released."""
        self._each(lambda room: room.emergency_stop(why))

    def release(self) -> None:
        """Release the emergency stops that are set."""
        self._each(lambda room: room.release() if room.is_latched else None)

    def revoke(self, name: str) -> None:
        """End a pupil's link, with the pages that it opened and what they do, and have another one for that robot.

        Nothing else changes: the robot stays where it is, with its places and programs. For the event loop.
        """
        seat = self.seats[name]
        old, seat.token = seat.token, self._access.issue("pupil", name)
        self._access.revoke(old)
        for face in seat.room.drop(old):
            with contextlib.suppress(LinkError):  # that one is gone, and the guard halts it
                if seat.room.steers(face):
                    seat.room.take(None, LINK_ENDED)
            if isinstance(face, Page):
                face.close()
        for teacher in list(self._faces.values()):
            teacher.put(self._message())

    def hand_out(self, text: str) -> None:
        """Show a task to every pupil, also to one who comes later."""
        self.task = text
        self._each(
            lambda room: room.tell_people(
                Message(lambda language: {"is": "task", "text": text, "title": web_words(language, "task")})
            )
        )

    def move_to(self, number: int) -> None:
        """Have everybody leave out the tasks before that one; who is further already stays there."""
        for seat in self.seats.values():
            if seat.lesson is not None:
                seat.lesson.move_to(number)

    def _each(self, act: Callable[[Room], None]) -> None:
        for room in self.rooms.values():
            with contextlib.suppress(LinkError):  # that one is gone, and the guard halts it
                act(room)

    def _message(self) -> Message:
        def facts(language: LanguageCode) -> dict[str, Any]:
            robots = [seat.facts(language) for seat in self.seats.values()]
            return {"is": "class", "robots": robots, "lesson": self._lesson_facts(language)}

        return Message(facts, is_droppable=True)

    def _lesson_facts(self, language: LanguageCode) -> dict[str, Any] | None:
        if (sheet := self.sheet) is None:
            return None
        tasks = [task.title.in_language(language) for task in sheet.tasks]
        return {"title": sheet.title.in_language(language), "tasks": tasks}

    def _tell_all(self) -> None:
        while not self._ended.wait(TELL_S):
            if self._faces:
                message = self._message()
                for face in list(self._faces.values()):
                    face.put(message)


def _lose(room: Room, robot: PupilsRobot, on_gone: Callable[[Exception], None], error: Exception) -> None:
    """Tell whom it concerns that a conversation has ended with that; called by the thread that pumped it."""
    room.lose(error)
    if isinstance(error, LinkError):
        on_gone(error)
        return
    # A mistake of ours in one conversation: its robot stops, and the nineteen others go on.
    print(f"chatrobot: pupil {room.name}:", file=sys.stderr)
    traceback.print_exception(error)
    with contextlib.suppress(LinkError):
        robot.connection.session.stop("the conversation has ended")


_ROOM = is_text(8)
FIELDS: Fields = {
    "stop": {"room?": _ROOM},
    "emergency_stop": {"room?": _ROOM},
    "release": {"room?": _ROOM},
    "task": {"text": is_text(MOST_TEXT_CHARS)},
    "revoke": {"room": _ROOM},
    "record": {"room": _ROOM},
    "move_to": {"number": lambda value: type(value) is int and value >= 1},
    "language": {"code": lambda value: value in REPLY_LANGUAGES},
}
"""What a teacher's page may say; without a room it is about all of them."""


def serve_teacher(websocket: WebSocket, classroom: Classroom, page: Page) -> Conversation:
    """Return the conversation of a teacher's page with the class."""

    def do(message: dict[str, Any]) -> None:
        word = message["do"]
        about: Classroom | Room | None = classroom
        if "room" in message:
            about = classroom.rooms.get(message["room"])
        if about is None:
            page.put(refused("malformed", word, problem=f"there is no robot {message['room']!r}"))
        elif word == "revoke":
            classroom.revoke(message["room"])
        elif word == "record":
            if classroom.recordings is not None:  # it waits for the disk
                asyncio.get_running_loop().run_in_executor(None, classroom.recordings.record, message["room"])
        elif word == "move_to":
            classroom.move_to(message["number"])
        elif word == "task":
            classroom.hand_out(message["text"])
        elif word == "language":
            page.language = message["code"]
        else:
            try:
                {
                    "stop": lambda: about.stop(page.pass_.pressed(STOP_BUTTON)),
                    "emergency_stop": lambda: about.emergency_stop(page.pass_.pressed(EMERGENCY_BUTTON)),
                    "release": about.release,
                }[word]()
            except LinkError as error:
                page.put(refused("robot_gone", word, problem=str(error)))

    return Conversation(websocket, classroom, page, FIELDS, do)
