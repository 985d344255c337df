"""One robot with all who look at it: its session, what was told so far, and who steers.

A server holds one room a robot. Pages are one face of it; another one joins with anything that has `put`.
"""

from __future__ import annotations

import contextlib
import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from chatrobot.compose import Connection
from chatrobot.core.errors import LinkError
from chatrobot.core.events import RELEASED, Event, Finished, Notice, Remembered, Result
from chatrobot.core.reason import Reason
from chatrobot.language.interpretation import LanguageCode
from chatrobot.link.motion_link import TURNS
from chatrobot.plan.steps import Go, Plan
from chatrobot.plan.text import format_plan
from chatrobot.reflex import is_emergency_stop, is_release
from chatrobot.web.access import EMERGENCY_BUTTON, STOP_BUTTON
from chatrobot.web.facts import CameraView, place_facts, robot_facts, world_facts
from chatrobot.web.outbox import Face, Message
from chatrobot.web.programs import AskedPlans, Post, Programs
from chatrobot.web.steering import NOBODY, Steering
from chatrobot.web.words import PASSING, UNTOLD, event_message, noted, refused, told, web_words

_LOST = Message(lambda language: {"is": "lost", "text": web_words(language, "steerer_lost")})
HISTORY = 200
"""Messages that a page is told which comes later."""


class Room:
    """See the module. `hear` events from the moment of connecting on; `open` it once the robot is there.

    Anything may be called from any thread; `stop` and `emergency_stop` wait for nothing.
    """

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._lock = threading.RLock()
        self._faces: dict[str, Face] = {}
        self._history: deque[Message] = deque(maxlen=HISTORY)
        self._pinned: dict[str, Message] = {}
        self._turns: dict[int, str] = {}
        self.last_said = ""
        self.plans = AskedPlans()
        self.take_command: Callable[[Face, str], bool] = lambda _, __: False
        """Does what is no sentence for the robot; False where it is one. Ask it before `say`."""
        self.is_latched = self._release_is_due = False
        self.stop_port = 0
        """Where the line listens that stops."""
        self.is_over = False
        """Nothing can be asked of the robot any more."""

    def open(
        self,
        connection: Connection,
        post: Post,
        *,
        is_simulated: bool,
        release: Callable[[], None] | None = None,
    ) -> None:
        """Let people in.

        Args:
            post: has something done by the thread that pumps the session.
            release: releases an emergency stop, where the session itself may not.
        """
        self._release = release or connection.session.release
        self.connection, self.session = connection, connection.session
        self._is_simulated = is_simulated
        self.steering = Steering(self.session, lambda: bool(self._turns), self._tell_lost)
        self.programs = Programs(self.session, connection.profile, post)
        self.camera = CameraView(connection.camera) if connection.camera is not None else None

    # --- what happens ---

    def hear(self, event: Event) -> None:
        """Take an event in and tell everybody."""
        with self._lock:
            self.plans.hear(event)
            if event.name not in UNTOLD or event.turn >= TURNS:
                self._tell(event_message(event), is_kept=event.name not in PASSING)
            if isinstance(event, Finished) and event.turn >= TURNS:
                self._turns.pop(event.turn, None)
            elif isinstance(event, Result):
                self._turns.pop(event.turn, None)
                if event.outcome == "answered":  # it may have remembered a place, or forgotten one
                    self._tell_places()
                if event.reason is not None and event.reason.code == "emergency_stop":
                    self._set_alarm(True)
            elif isinstance(event, Remembered):
                self._tell_places()
            elif isinstance(event, Notice) and self._releases(event):
                self._set_alarm(False)

    def _releases(self, notice: Notice) -> bool:
        """No alarm goes by a release that was asked for before it was raised."""
        is_ours = notice.reason.values.get("source") == "console"
        return notice.reason.code in RELEASED and (self._release_is_due or not is_ours)

    def note_alarm(self, is_set: bool, why: str = "") -> None:
        """Take note that a face of the session has set the emergency stop, once, or had it released."""
        with self._lock:
            if is_set and not self.is_latched:  # Motion's notice tells the release, and nothing this
                about = {"source": "pupil" if self.name else "console", "why": why}  # a class has names
                self._tell(event_message(Notice(0, Reason("emergency_stop", about))), is_kept=True)
            self._set_alarm(is_set)

    def lose(self, error: Exception) -> None:
        """Tell everybody that the robot is gone."""
        self.is_over = True
        with self._lock:
            self._tell_gone("motion", "robot_gone", problem=str(error))

    def end(self, *, stops: bool) -> None:
        """Stop the robot, unless somebody else sees to it; tell everybody that nobody serves them any more."""
        with contextlib.suppress(LinkError):  # Motion is gone, and its guard halts the robot
            if stops:
                self.session.stop("the web console has ended")
        with self._lock:
            self._tell_gone("server", "server_ends" if stops else "server_leaves")

    def tell_people(self, message: Message) -> None:
        """Tell everybody who is here, and who comes later."""
        with self._lock:
            self._tell(message, is_kept=True)

    def pin(self, key: str, message: Message) -> None:
        """Tell everybody what stays true until it is told anew: who comes later hears it after all else."""
        with self._lock:
            self._pinned[key] = message
            self._tell(message)

    @property
    def faces(self) -> list[Face]:
        """Return who looks at it."""
        return list(self._faces.values())

    def _tell_gone(self, what: str, code: str, **values: object) -> None:
        self._tell(
            Message(
                lambda language: {"is": "gone", "what": what, "text": web_words(language, code, **values)}
            )
        )

    def _tell(self, message: Message, *, is_kept: bool = False) -> None:
        """Have the lock."""
        if is_kept:
            self._history.append(message)
        for face in self._faces.values():
            face.put(message)

    def _set_alarm(self, is_set: bool) -> None:
        self.is_latched, self._release_is_due = is_set, False
        self._tell(told("emergency", set=is_set))

    def _tell_places(self) -> None:
        self._tell(
            told("places", places=place_facts(self.connection.world, self.session.understanding.places.all()))
        )

    def _tell_lost(self) -> None:
        with self._lock:  # pages that tried in vain come all at once
            if not self._history or self._history[-1] is not _LOST:
                self._tell(_LOST, is_kept=True)

    # --- who is here ---

    def join(self, face: Face) -> None:
        """Let somebody in: they hear what was told so far, and steer if nobody does; a teacher only looks."""
        with self._lock:
            may_begin = face.pass_.may_steer and face.pass_.role != "teacher"
            if may_begin and self.steering.steerer is None:
                self.steering.take(face)
            face.put(Message(lambda language: self._hello(face, language)))
            self._faces[face.id] = face
            self._tell_steering()
            self._watch_scans()

    def leave(self, face: Face) -> None:
        """Take note that somebody is gone; where they steered, what they wanted ends."""
        with self._lock:
            self._faces.pop(face.id, None)
            self._watch_scans()
        with contextlib.suppress(LinkError):  # Motion is gone, and its guard halts the robot
            if self.steering.leave(face):
                with self._lock:
                    self._tell_steering()

    def drop(self, token: str) -> list[Face]:
        """Return those who came in with that token, which has been revoked."""
        return [face for face in self.faces if face.pass_.token == token]

    def take(self, face: Face | None, why: str = NOBODY) -> None:
        """Have somebody steer, or nobody; both sides hear of it. `why` is told of what ends by that."""
        with self._lock:
            self.steering.take(face, why)
            self._tell_steering()

    def steers(self, face: Face) -> bool:
        """Return whether it is that one who steers."""
        return self.steering.steerer is face

    def _tell_steering(self) -> None:
        steerer = self.steering.steerer
        by, name = (steerer.id, steerer.name) if steerer is not None else (None, "")
        for face in self._faces.values():
            face.put(told("steering", by=by, name=name, you=steerer is face, may=self.may(face)))

    def may(self, face: Face) -> list[str]:
        """List what somebody may do just now."""
        allowed = ["stop", "emergency_stop"]
        if face.pass_.may_steer:
            allowed += ["take"] if not self.steers(face) else ["say", "approve", "steer", "run", "give"]
        return [*allowed, "release"] if face.pass_.may_release else allowed

    def _hello(self, face: Face, language: LanguageCode) -> dict[str, Any]:
        steerer = self.steering.steerer
        session, connection = self.session, self.connection
        return {
            "is": "hello",
            "you": face.id,
            "language": language,
            "name": face.name,
            "role": face.pass_.role,
            "room": self.name,
            "may": self.may(face),
            "stop_port": self.stop_port,
            "steering": {"by": steerer.id, "name": steerer.name} if steerer is not None else None,
            "robot": robot_facts(
                connection.profile, is_simulated=self._is_simulated, has_camera=self.camera is not None
            ),
            "world": world_facts(connection.world, session.understanding.places.all()),
            "approval": {"asks": session.options.approve, "turn": self.plans.turn},
            "emergency": self.is_latched,
            "programs": self.programs.are_kept,
            "history": self.history(language),
        }

    def history(self, language: LanguageCode) -> list[dict[str, Any]]:
        """Return what was told so far, oldest first, and then what is so now."""
        with self._lock:
            kept = (*self._history, *self._pinned.values())
            return [message.object_in(language) for message in kept]

    def _watch_scans(self) -> None:
        with contextlib.suppress(LinkError):  # nothing is there to be looked at
            self.session.watch_scans(bool(self._faces))

    # --- what people do ---

    def stop(self, why: str = STOP_BUTTON) -> None:
        """Stop the robot now; `why` is told to whose plan it ends."""
        self.session.stop(why)

    def emergency_stop(self, why: str = EMERGENCY_BUTTON) -> None:
        """Stop the robot now, and keep it stopped until it is released."""
        self.session.emergency_stop(why)
        self.note_alarm(True, why)

    def release(self) -> None:
        """Ask Motion to release the emergency stop; its notice says what became of it."""
        self._release_is_due = True
        self._release()

    def say(self, face: Face, text: str) -> None:
        """Take a sentence in. A stop is out before this returns."""
        if is_release(text):
            self._release_for(face, text)
            return
        self._say_as(face, text, lambda: self.session.say(text))
        if is_emergency_stop(text):
            with self._lock:
                self._set_alarm(True)

    def _release_for(self, face: Face, text: str) -> None:
        """Do what the button does, for whom it is there; tell others who has it. No turn begins."""
        self.note_said(0, text, face.id, face.name)
        if face.pass_.may_release:
            self.release()
            return
        self.tell_people(noted("release_by_teacher" if face.pass_.role == "pupil" else "release_elsewhere"))

    def say_plan(self, face: Face, plan_text: str) -> None:
        """Take in a plan that a person wrote."""
        self._say_as(face, plan_text, lambda: self.session.say_plan(plan_text))

    def say_edited(self, face: Face, plan_text: str, turn: int) -> None:
        """Take in what a person made of the plan of that turn: it is asked about in its place."""
        self._say_as(face, plan_text, lambda: self.plans.edit(self.session, turn, plan_text))

    def go(self, face: Face, where: Go, text: str, *, asks: bool) -> None:
        """Have the robot go to a point of the floor; rehearsed first, and asked about unless a person waived that."""
        plan_text = format_plan(Plan((where,)))
        say = self.session.say_edited_plan if asks else self.session.say_plan
        self._say_as(face, text or plan_text, lambda: say(plan_text))

    def change_obstacle(self, face: Face, name: str, circle: list[float] | None) -> None:
        """Put an obstacle there (x, y and radius), move it, or take it away. Motion's notice says what came of it."""
        if not self._is_simulated:
            face.put(refused("obstacle_simulated_only", "obstacle"))
        elif circle is not None:
            self.session.change_obstacle(add=name, circle=circle)
        else:
            self.session.change_obstacle(remove=name)

    def run_program(self, face: Face, name: str) -> None:
        """Have a kept program rehearsed and run."""
        self.programs.run(face, name, lambda say: self._say_as(face, name, say))

    def edit_program(self, face: Face, name: str, source: str) -> None:
        """Take in what a person made of a program: it is rehearsed, and asked about before it runs."""
        self._say_as(face, name, lambda: self.session.say_source(name, source))

    def resume(self, face: Face) -> None:
        """Go on with what is paused."""
        self._say_as(face, "", self.session.resume)

    def answer(self, face: Face, turn: int, yes: bool) -> None:
        """Answer the plan that waits, if it still does."""
        if self.plans.turn == turn:
            if yes:
                self._turns[turn] = face.id  # an agent's, too, is now something that this page wants
            self.plans.answer(self.session, yes=yes)
        else:
            face.put(refused("question_over", "approve"))

    def drive(self, face: Face, plan_text: str) -> int:
        """Have the robot do what that page asked for by a button; the number of the turn."""
        return self._say_as(face, "", lambda: self.session.say_plan(plan_text))

    def _say_as(self, face: Face, text: str, say: Callable[[], int]) -> int:
        with self._lock:  # what was said is told before what it brings about
            turn = say()
            if turn not in self.session.results:
                self._turns[turn] = face.id
            if text:
                self.note_said(turn, text, face.id, face.name)
            return turn

    def note_said(self, turn: int, text: str, by: str, name: str) -> None:
        """Tell everybody what somebody said."""
        with self._lock:
            self.last_said = text
            self._tell(told("said", turn=turn, text=text, by=by, name=name), is_kept=True)
