"""`chatrobot lesson NAME --check FILE`: the lines of a pupil, without the pupil, in simulated time."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from chatrobot.cli.approver import Approver
from chatrobot.cli.console.pasted import is_plan
from chatrobot.cli.console.words import Words, language_of_environment
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.json_lines import Output, json_line
from chatrobot.cli.lines import texts_in
from chatrobot.compose import Setup
from chatrobot.core.errors import UsageError
from chatrobot.core.events import Event, Result
from chatrobot.dialogue.session import Session
from chatrobot.language.interpretation import LanguageCode
from chatrobot.lessons.run import LessonRun, Verdict
from chatrobot.lessons.sheet import Sheet
from chatrobot.lessons.words import describe_end, describe_hint, describe_task, describe_verdict, say

_HEAD = re.compile(r"#\D*(\d+)")
"""`# task 2`: what follows is for that task."""


def run(sheet: Sheet, setup: Setup, name: str, *, is_json: bool) -> int:
    """Do the lines of that file; 0 where they pass the lesson."""
    texts = list(texts_of(read_lines(name)))
    referee = Referee(LessonRun(sheet, setup.profile.footprint), Output(), is_json=is_json)
    with LessonConversation(setup, referee) as conversation:
        for text in texts:
            if not conversation.is_leaving:
                conversation.take(text)
        language = conversation.language
    referee.tell_end(language)
    return 0 if referee.run.is_passed else 1


def read_lines(name: str) -> str:
    """Return what a file holds, or standard input where it is called `-`.

    Raises:
        UsageError: it cannot be read.
    """
    try:
        return sys.stdin.read() if name == "-" else Path(name).expanduser().read_text(encoding="utf-8-sig")
    except OSError as error:
        raise UsageError(error.strerror or "cannot be read", where=name) from error
    except UnicodeDecodeError as error:
        raise UsageError(
            "is no text", where=name, allowed="lines in UTF-8, as a pupil would type them"
        ) from error


def texts_of(content: str) -> Iterator[str]:
    """Split what a file holds as the console would if it were pasted: a paragraph that is the text of one plan is one
    text; else each line is."""
    for paragraph in re.split(r"\n[ \t]*\n", content.replace("\r\n", "\n")):
        heads = [line for line in paragraph.splitlines() if line.lstrip().startswith("#")]
        body = "\n".join(line for line in paragraph.splitlines() if line not in heads)
        if "\n" in body.strip() and is_plan(body):
            yield from heads
            yield body.strip()
        else:
            yield from texts_in(paragraph)


class Referee:
    """A `Printer` that has a lesson judge what happens, and tells the replies and verdicts."""

    def __init__(
        self, run: LessonRun, output: Output, *, is_json: bool = False, is_quiet: bool = False
    ) -> None:
        self.run = run
        self.words = Words(language_of_environment())
        self.verdicts: list[Verdict] = []
        self.last_reply = ""
        self._output = output
        self._is_json = is_json
        self._is_quiet = is_quiet

    @property
    def is_broken(self) -> bool:
        """Nobody reads what is written."""
        return self._output.is_broken

    def turn(self, text: str) -> None:
        """Show what begins a turn."""
        self.write(f"> {text.replace(chr(10), f'{chr(10)}  ')}")

    def show(self, event: Event, language: LanguageCode) -> None:
        """Judge an event, and tell what comes of it, in the language of what the pupil types."""
        del language  # of the reply: of plan text it is English
        verdict = self.run.hear(event)
        if isinstance(event, Result):
            self.last_reply = event.reply
            self.write(f"  {event.reply}")
        if verdict is not None:
            self.verdicts.append(verdict)
            self.tell(verdict, self.words.language)

    def tell(self, verdict: Verdict, language: LanguageCode) -> None:
        """Tell a verdict; that the robot was driven to where the task begins is told by its reply."""
        sentence = describe_verdict(verdict, language)
        if not verdict.returned:
            self.write(
                f"  {'✓' if verdict.is_passed else '→'} {sentence}", verdict_json(verdict, sentence, language)
            )

    def tell_end(self, language: LanguageCode) -> None:
        """Tell what became of the lesson."""
        lines = describe_end(self.run, language)
        self.write("\n".join(["", *lines]), lesson_json(self.run, language))

    def write(self, text: str, as_json: dict[str, Any] | None = None) -> None:
        """Write a line for people, or its JSON object for programs, if it has one."""
        if self._is_quiet:
            return
        if not self._is_json:
            self._output.write(f"{text}\n")
        elif as_json is not None:
            self._output.write(json_line(as_json))


class LessonConversation:
    """Enter it to connect; nothing is kept in a person's own folder. The robot is driven to where a task begins."""

    def __init__(self, setup: Setup, referee: Referee) -> None:
        self._referee = referee
        self._folder = TemporaryDirectory(prefix="chatrobot-lesson-")
        setup = replace(setup, folder=Path(self._folder.name))
        self._conversation = Conversation(setup, referee, Approver(can_ask=False))

    def __enter__(self) -> LessonConversation:
        self._conversation.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self._conversation.__exit__(*error)
        self._folder.cleanup()

    @property
    def is_leaving(self) -> bool:
        """A signal has ended it."""
        return self._conversation.is_leaving

    @property
    def language(self) -> LanguageCode:
        """Of what the pupil types."""
        return self._referee.words.language

    @property
    def _session(self) -> Session:
        """Plans that are taken as they are get their reply in that language, too."""
        session = self._conversation.session
        session.understanding.language = self.language
        return session

    def take(self, text: str) -> None:
        """Do one text, as a pupil types it."""
        run = self._referee.run
        if text.startswith("#"):
            self._turn_to(text)
            return
        if run.task is None and not text.startswith("/task"):
            return
        if run.task is not None and not run.has_begun:
            self._begin_anew()
        self._referee.turn(text)
        self._referee.words.follow("" if text.startswith("/") else text)
        if text.startswith("/"):
            self._command(text)
            return
        session = self._session
        turn = session.say_plan(text) if "\n" in text else session.say(text)
        run.note_said(turn, text)
        self._conversation.see_through(turn)

    def _turn_to(self, text: str) -> None:
        """Leave the tasks out that stand before the one of that head."""
        head, run = _HEAD.match(text), self._referee.run
        while head is not None and run.task is not None and run.number < int(head[1]):
            run.skip()

    def _command(self, text: str) -> None:
        run, language = self._referee.run, self.language
        match text.split()[0].casefold():
            case "/again":
                self._begin_anew()
            case "/skip":
                self._referee.write(f"  {say(language, 'skipped', number=run.number)}")
                run.skip()
            case "/hint":
                self._referee.write(f"  {describe_hint(run.hint(), language)}")
            case "/task" if (number := text.split()[-1]).isdecimal() and run.go_to(int(number)):
                self._referee.write("\n".join(f"  {line}" for line in describe_task(run, language)))
            case command:
                self._referee.write(f"  {command}: /again, /skip, /hint, /task 2")

    def _begin_anew(self) -> None:
        session = self._session
        turns: list[int] = []

        def drive(plan_text: str) -> int:
            turns.append(session.say_plan(plan_text))
            return turns[0]

        if not self._referee.run.again(drive):
            self._referee.write(f"  {say(self.language, 'returning')}")
            self._conversation.see_through(turns[0])


def verdict_json(verdict: Verdict, sentence: str, language: str) -> dict[str, Any]:
    """Make the object of one `--json` line."""
    return {
        "event": "verdict",
        "task": verdict.number,
        "title": verdict.task.title.in_language(language),
        "passed": verdict.is_passed,
        "broken": verdict.is_broken,
        "sentence": sentence,
        "checks": [finding.to_json() for finding in verdict.findings],
    }


def lesson_json(run: LessonRun, language: str) -> dict[str, Any]:
    """Make the object of the last `--json` line."""
    tasks = [
        {
            "task": number,
            "title": task.title.in_language(language),
            "state": record.state,
            "tries": record.try_count,
            "hints": record.hint_count,
        }
        for number, (task, record) in enumerate(zip(run.sheet.tasks, run.records), 1)
    ]
    return {"event": "lesson_ended", "name": run.sheet.name, "passed": run.is_passed, "tasks": tasks}
