"""A lesson at the console: the task above the prompt, a verdict after each turn, and the commands of a pupil."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.console import RenderableType
from rich.text import Text

from chatrobot.cli.console.commands import Command
from chatrobot.cli.console.controller import ChatController
from chatrobot.cli.console.lines import indented, marked
from chatrobot.core.events import Event
from chatrobot.lessons.run import LessonRun, Verdict
from chatrobot.lessons.words import describe_hint, describe_lesson, describe_task, describe_verdict, say


class ConsoleLesson:
    """Shows a lesson in a conversation. `hear` belongs to who pumps the session, the rest to the display's thread."""

    def __init__(self, run: LessonRun) -> None:
        self.run = run
        self._controller: ChatController | None = None

    def begin(self, controller: ChatController) -> Sequence[RenderableType]:
        """Join a conversation: return what stands at its beginning."""
        self._controller = controller
        controller.on_said.append(self.run.note_said)
        controller.commands = lesson_commands(self)
        lines = describe_lesson(self.run, controller.connection.profile.title, self.language)
        return [indented(Text(lines[0], "bold")), *(indented(Text(line)) for line in lines[1:-1]),
                indented(Text(lines[-1], "dim")), *self._task()]  # fmt: skip

    def hear(self, event: Event) -> None:
        """Have an event judged, and show what comes of it."""
        goes_on = self._controller is not None and not self._controller.session.is_idle
        verdict = self.run.hear(event, goes_on=goes_on)
        if verdict is not None:
            self._show(verdict)

    @property
    def language(self) -> str:
        """Of the last question."""
        return self._controller.words.language if self._controller is not None else "en"

    def _show(self, verdict: Verdict) -> None:
        mark, style = ("✓", "bold green") if verdict.is_passed else ("→", "yellow")
        sentence = Text(describe_verdict(verdict, self.language), "bold")
        self._print(marked(mark, style, sentence))
        if verdict.is_passed:
            self._go_on()

    def _go_on(self) -> None:
        """Show the task that follows; after the last one the lesson is over."""
        if self.run.task is not None:
            self._print(*self._task())
        elif self._controller is not None:
            self._controller.display.leave(0)

    def _task(self) -> list[RenderableType]:
        head, *rest = describe_task(self.run, self.language)
        return [Text(), indented(Text(head, "bold cyan")), *(indented(Text(line)) for line in rest)]

    def _print(self, *lines: RenderableType) -> None:
        if self._controller is not None:
            self._controller.display.print(*lines)

    def _say(self, text: str) -> None:
        self._print(indented(Text(text)))

    # --- the commands ---

    def show_task(self, controller: ChatController, number: str) -> None:
        """Show the task once more, or go to the one of that number."""
        if not number or self.run.go_to(int(number) if number.isdecimal() else 0):
            controller.display.print(*self._task())
        else:
            self._say(say(self.language, "task_unknown", count=len(self.run.records)))

    def hint(self, _: ChatController, __: str) -> None:
        """Show the hint."""
        self._say(describe_hint(self.run.hint(), self.language))

    def skip(self, _: ChatController, __: str) -> None:
        """Leave the task out."""
        self._say(say(self.language, "skipped", number=self.run.number))
        self.run.skip()
        self._go_on()

    def again(self, controller: ChatController, _: str) -> None:
        """Begin the task anew; the robot drives to where it begins."""

        def drive(plan_text: str) -> int:
            self._say(say(self.language, "returning"))
            return controller.session.say_plan(plan_text)

        def begin() -> None:
            if self.run.again(drive):
                self._say(say(self.language, "task_begins"))

        controller.attempt(begin)


def lesson_commands(lesson: ConsoleLesson) -> tuple[Command, ...]:
    """Return the slash commands of a lesson."""
    acts: dict[str, Callable[[ChatController, str], None]] = {
        "task": lesson.show_task, "hint": lesson.hint, "again": lesson.again, "skip": lesson.skip,
    }  # fmt: skip
    return tuple(Command(name, act) for name, act in acts.items())
