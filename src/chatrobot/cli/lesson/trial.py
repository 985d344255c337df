"""`chatrobot lesson FILE --test`: whether a sheet is right. Each solution has to pass, each mistake must not."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

from chatrobot.cli.console.words import language_of_environment
from chatrobot.cli.json_lines import Output
from chatrobot.cli.lesson.check import LessonConversation, Referee, verdict_json
from chatrobot.compose import Setup
from chatrobot.lessons.run import LessonRun, Verdict
from chatrobot.lessons.sheet import Sheet
from chatrobot.lessons.words import describe_verdict, say

Kind = Literal["solution", "mistake"]


@dataclass(frozen=True)
class Trial:
    """One try of a sheet's own texts, and what the checks said last; without a verdict nothing moved."""

    number: int
    kind: Kind
    language: str
    texts: tuple[str, ...]
    verdict: Verdict | None
    sentence: str

    @property
    def is_right(self) -> bool:
        """A solution passes; a mistake moves the robot, and does not."""
        if self.verdict is None:
            return False
        return self.verdict.is_passed == (self.kind == "solution")

    def to_json(self) -> dict[str, Any]:
        """Make the object of one `--json` line."""
        told = {"event": "trial", "task": self.number, "kind": self.kind, "language": self.language}
        verdict = verdict_json(self.verdict, self.sentence, self.language) if self.verdict is not None else {}
        return {
            **verdict,
            **told,
            "texts": list(self.texts),
            "right": self.is_right,
            "sentence": self.sentence,
        }


def run(sheet: Sheet, setup: Setup, *, is_json: bool) -> int:
    """Try all of a sheet; 0 where it is right."""
    output, language = Output(), language_of_environment()
    printer = Referee(LessonRun(sheet, setup.profile.footprint), output, is_json=is_json)
    count = wrong_count = 0
    for trial in trials(sheet, setup):
        count += 1
        wrong_count += not trial.is_right
        title = sheet.tasks[trial.number - 1].title.in_language(language)
        head = say(language, f"trial_{trial.kind}", number=trial.number, title=title, code=trial.language)
        code = "right" if trial.is_right else f"wrong_{trial.kind}"
        printer.write(f"{head}\n  {say(language, f'trial_{code}', sentence=trial.sentence)}", trial.to_json())
    printer.write(say(language, "trials", count=count, wrong=wrong_count))
    return 1 if wrong_count else 0


def trials(
    sheet: Sheet, setup: Setup, is_tried: Callable[[int, Kind, str], bool] = lambda *_: True
) -> Iterator[Trial]:
    """Try each solution and each mistake, in each language that it is given in, with a robot of its own. What is the
    same in several languages is tried once."""
    for number, task in enumerate(sheet.tasks, 1):
        kinds: tuple[tuple[Kind, Any], ...] = (("solution", task.solution), ("mistake", task.mistake))
        for kind, by_language in kinds:
            first_of = {texts: language for language, texts in reversed(by_language.items())}
            for texts, language in reversed(first_of.items()):
                if is_tried(number, kind, language):
                    yield _try(sheet, setup, number, kind, language, texts)


def _try(sheet: Sheet, setup: Setup, number: int, kind: Kind, language: str, texts: tuple[str, ...]) -> Trial:
    referee = Referee(LessonRun(sheet, setup.profile.footprint, number), Output(), is_quiet=True)
    with LessonConversation(setup, referee) as conversation:
        for text in texts:
            if referee.run.number == number:
                conversation.take(text)
    judged = [verdict for verdict in referee.verdicts if verdict.findings]
    if not judged:
        reply = say(language, "trial_unjudged", reply=referee.last_reply)
        return Trial(number, kind, language, texts, None, reply)
    return Trial(number, kind, language, texts, judged[-1], describe_verdict(judged[-1], language))
