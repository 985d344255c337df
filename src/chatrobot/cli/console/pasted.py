"""Several lines that came at once: one turn after the other, as in a pipe, where a typed line would replace."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from textwrap import shorten

from chatrobot.cli.lines import GOODBYES
from chatrobot.core.errors import PlanTextError
from chatrobot.core.events import Outcome
from chatrobot.language.phrases import say
from chatrobot.link.envelope import QUEUE_LIMIT
from chatrobot.plan.text import parse_plan
from chatrobot.reflex import is_stop

MOST_TEXTS = QUEUE_LIMIT + 1
"""One runs, the others wait."""
_GOES_ON: frozenset[Outcome] = frozenset({"completed", "answered"})
_STOPS = frozenset({"/stop", "/estop"})
_TYPED_ALONE = ("release", "limit")
_SHOWN_CHARS = 60


class Pasted:
    """The texts that wait for the turn before them. The lock is the caller's."""

    def __init__(self) -> None:
        self._texts: deque[str] = deque()
        self._turn = 0
        self.is_behind_command = False
        """What waits comes after a command that has not said its turn yet."""

    @property
    def is_waiting(self) -> bool:
        """Something waits."""
        return bool(self._texts)

    def keep(self, texts: Sequence[str]) -> None:
        """Have them wait, in their order."""
        self._texts.extend(texts)

    def next(self) -> str | None:
        """Take the first; None where nothing waits."""
        return self._texts.popleft() if self._texts else None

    def follow(self, turn: int) -> None:
        """Have what waits come after this turn."""
        self._turn, self.is_behind_command = turn, False

    def follow_command(self) -> None:
        """Have what waits come after the turn of the command that is done now."""
        self._turn, self.is_behind_command = 0, True

    def is_after(self, turn: int) -> bool:
        """Tell whether this is the turn that is waited for."""
        return self.is_waiting and turn == self._turn

    def drop(self) -> tuple[str, ...]:
        """Forget what waits; it is returned."""
        dropped = tuple(self._texts)
        self._texts.clear()
        self.is_behind_command = False
        return dropped


def goes_on_after(outcome: Outcome) -> bool:
    """Tell whether what follows may be done. From where a robot should not be, the rest is another way."""
    return outcome in _GOES_ON


def cut_at_stop(
    texts: Sequence[str], is_stop: Callable[[str], bool]
) -> tuple[Sequence[str], str, Sequence[str]]:
    """Return what stands before the last stop, the stop (empty where there is none), and what comes after it."""
    for number in range(len(texts) - 1, -1, -1):
        text = texts[number].strip().casefold()
        if text in _STOPS or (is_stop(text) and not text.startswith("/")):
            return texts[:number], texts[number], texts[number + 1 :]
    return (), "", texts


def ends_a_paste(command: str) -> bool:
    """Tell whether nothing can follow this command."""
    return command.casefold().startswith("/quit")


def takes_turn(command: str) -> bool:
    """Tell whether what this command begins is a turn, which what is behind it waits for."""
    word, *argument = command[1:].casefold().split()[:2] or [""]
    return word == "run-plan" or (word == "program" and argument not in ([], ["list"]))


def must_be_typed(command: str) -> str:
    """Return the command's name where it must be typed by itself: what is pasted may be anybody's words."""
    word = (command[1:].casefold().split() or [""])[0]
    return word if word in _TYPED_ALONE else ""


def as_goodbye(text: str, moves: Callable[[], bool]) -> str:
    """Return `/quit` for `exit` and `quit`, which leave other programs; where the robot may move, "quit" is a stop."""
    leaves = text.casefold() in GOODBYES and (text.startswith("/") or not (is_stop(text) and moves()))
    return "/quit" if leaves else text


def quoted(texts: Sequence[str], language: str) -> str:
    """Return the texts in quotation marks, each on one line and not too long."""
    shown = (shorten(text, _SHOWN_CHARS, placeholder=" …") for text in texts)
    return say(language, "list_comma").join(say(language, "quoted", text=text) for text in shown)


def is_plan(text: str) -> bool:
    """Tell whether several lines are the text of one plan, such as one that was saved."""
    try:
        parse_plan(text)
    except PlanTextError:
        return False
    return True


LONGEST_CHARS = 4000
"""One instruction or one edited plan; what is longer is a mistake."""


def clean(text: str) -> str:
    """Make `text` printable and valid Unicode: what else it held becomes "�"; line breaks and tabs stay."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    if text.isascii() and text.isprintable():
        return text
    return "".join(char if _is_fine(char) else "�" for char in text)


def _is_fine(char: str) -> bool:
    return char.isprintable() or char in "\n\t\u3000\u00a0"
