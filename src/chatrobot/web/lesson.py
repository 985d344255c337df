"""A lesson in a room: its pages see the task, and after each turn what is achieved and what is missing.

`hear` gets every event of the session and the true poses; the robot is moved only for a page that asks for that.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from chatrobot.core.events import Event, Notice, Result, TruePose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.session import Session
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.language.interpretation import LanguageCode
from chatrobot.lessons.run import LessonRun, Verdict
from chatrobot.lessons.words import (
    describe_end,
    describe_hint,
    describe_lesson,
    describe_task,
    describe_verdict,
    say,
)
from chatrobot.web.outbox import Face, Message
from chatrobot.web.room import Room
from chatrobot.web.words import web_words
from chatrobot.wire.messages import Odometry

COMMANDS = ("/task", "/hint", "/again", "/skip")
"""What a pupil may type, as at the console; the page's buttons say the same."""


class RoomLesson:
    """See the module. Any thread.

    Args:
        bring_up_to_date: has every true pose heard that has come by now: a verdict needs the last one.
        record: keeps what the lesson says, beside what the session does.
    """

    def __init__(
        self,
        run: LessonRun,
        room: Room,
        robot_title: str,
        bring_up_to_date: Callable[[], None] = lambda: None,
        record: Callable[[Event], None] = lambda _: None,
    ) -> None:
        self.run = run
        self._room, self._robot_title, self._bring_up_to_date = room, robot_title, bring_up_to_date
        self._record = record
        self._is_returning = False
        self._said: deque[tuple[int, str]] = deque()
        self._last: Verdict | None = None

    def open(self, session: Session) -> None:
        """Begin: show the first task."""
        self._session, self._note_said = session, session.on_said

        def on_said(turn: int, text: str) -> None:
            if not self._is_returning:  # nobody said the plan of the way back
                self._note_said(turn, text)
            self._said.append((turn, text))

        session.on_said = on_said
        self._room.take_command = self._obey
        self._show()

    # --- what happens ---

    def hear_truth(self, sample: Odometry) -> None:
        """Take in where the simulated robot truly is."""
        self.run.hear(TruePose(0, *sample))

    def hear(self, event: Event) -> None:
        """Have an event judged, and tell what comes of it."""
        while self._said:  # noted here, for a room that is told what was said has its lock
            self.run.note_said(*self._said.popleft())
        is_end = isinstance(event, Result)
        if is_end:
            self._bring_up_to_date()
        verdict = self.run.hear(event, goes_on=is_end and not self._session.is_idle)
        if verdict is not None:
            self._last = verdict
            self._room.tell_people(Message(lambda language: _verdict_facts(verdict, language)))
            self._keep(lambda language: describe_verdict(verdict, language))
            self._show()

    def _show(self) -> None:
        """Show the task that is to be done; where there is none any more, what became of each."""
        self._room.pin("lesson", Message(self._message))

    def _message(self, language: str) -> dict[str, Any]:
        run, about = self.run, []
        if lines := describe_task(run, language):
            head, *lines = lines
            about = describe_lesson(run, self._robot_title, language)[:-1] if run.number == 1 else []
        else:
            *lines, head = describe_end(run, language)
        shown: dict[str, Any] = {"head": head, "lines": lines, "about": about}
        verdict = _verdict_facts(self._last, language) if self._last is not None else None
        over, count = run.task is None, len(run.records)
        return {"is": "lesson", "over": over, "count": count, **shown, "verdict": verdict}

    def facts(self, language: str) -> dict[str, Any]:
        """Return where this pupil is, for whoever teaches."""
        run, task = self.run, self.run.task
        last = _verdict_facts(self._last, language) if self._last is not None else {}
        return {
            "number": run.number,
            "title": task.title.in_language(language) if task is not None else "",
            "states": [record.state for record in run.records],
            "verdict": last.get("text", ""),
            "verdict_state": last.get("state", ""),
        }

    # --- what a page asks for ---

    def _obey(self, face: Face, text: str) -> bool:
        """Do what a pupil typed, or a button sent, where it is one of the lesson's commands; False where it is not."""
        command, _, argument = text.strip().casefold().partition(" ")
        if command not in COMMANDS:
            return False
        self._room.note_said(0, text, face.id, face.name)
        self._note_said(0, text)
        task, number = self.run.task, self.run.number
        if command == "/task" and argument:
            self._go_back(argument.strip())
        elif task is None or command == "/task":
            texts = {
                each: self._where(each) for each in REPLY_LANGUAGES
            }  # as it is now, whoever reads it later
            self._tell(texts.__getitem__)
        elif command == "/hint":
            self.run.hint()
            self._tell(lambda language: describe_hint(task, language))
        elif command == "/skip":
            self.run.skip()
            self._last = None
            self._tell(lambda language: say(language, "skipped", number=number))
        else:
            self._begin_anew(face)
        self._show()
        return True

    def _go_back(self, number: str) -> None:
        if self.run.go_to(int(number) if number.isdecimal() else 0):
            self._last = None
            self._tell(self._where)
        else:
            self._tell(lambda language: say(language, "task_unknown", count=len(self.run.records)))

    def _where(self, language: str) -> str:
        """Say what is to be done; at the end of the lesson what became of it."""
        return "\n".join(describe_task(self.run, language) or describe_end(self.run, language))

    def _begin_anew(self, face: Face) -> None:
        """Have the robot drive to where the task begins."""

        def drive(plan_text: str) -> int:
            self._tell(lambda language: say(language, "returning"))
            self._is_returning = True
            try:
                return self._room.drive(face, plan_text)
            finally:
                self._is_returning = False

        if self.run.again(drive):
            self._tell(lambda language: say(language, "task_begins"))

    def move_to(self, number: int) -> None:
        """Leave out the tasks before that one. Whoever is further already stays there."""
        was = self.run.number
        while self.run.task is not None and self.run.number < number:
            self.run.skip()
        if self.run.number != was:
            self._last = None
            self._tell(lambda language: web_words(language, "teacher_moved", number=number))
            self._show()

    def _tell(self, text: Callable[[LanguageCode], str]) -> None:
        self._room.tell_people(Message(lambda language: {"is": "note", "text": text(language)}))
        self._keep(text)

    def _keep(self, text: Callable[[LanguageCode], str]) -> None:
        said = text(self._session.understanding.language)
        self._record(Notice(0, Reason("lesson", {"text": said}), said))


def _verdict_facts(verdict: Verdict, language: str) -> dict[str, Any]:
    state = "passed" if verdict.is_passed else "broken" if verdict.is_broken else "missing"
    return {"is": "verdict", "state": state, "text": describe_verdict(verdict, language)}
