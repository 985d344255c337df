"""What Tab completes: commands, what they take, places and the words one often begins with."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from functools import cache

from prompt_toolkit.completion import CompleteEvent, Completer, Completion, PathCompleter
from prompt_toolkit.document import Document

from chatrobot.cli.console.commands import BY_NAME, COMMANDS, Command
from chatrobot.cli.console.words import Words
from chatrobot.language.data_files import REPLY_LANGUAGES, load_table
from chatrobot.language.detect import language_of
from chatrobot.language.lexicon import cut, lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import by_language

_WORD = re.compile(r"[\[|]([a-z]+)(?=[\]|])")
_LONGEST_JOINT = 3
"""Units of what joins two clauses."""
_PATHS = PathCompleter(expanduser=True)


@cache
def phrases_of(*languages: str) -> tuple[str, ...]:
    """What one often says in these languages; what a name has to follow comes last."""
    tables = [load_table(language, "completion") for language in languages]
    return tuple(phrase for name in ("phrases", "before_name") for table in tables for phrase in table[name])


@cache
def _before_name() -> frozenset[str]:
    return frozenset(
        phrase for code in REPLY_LANGUAGES for phrase in load_table(code, "completion")["before_name"]
    )


class ChatCompleter(Completer):
    """Completes what the text ends with.

    Args:
        places: the names of each place that can be gone to, as of now.
        commands: those of this conversation alone, such as a lesson's.
        can_do: whether a text is an order that is understood; of what stands within a sentence only that is offered.
    """

    def __init__(
        self,
        words: Words,
        places: Callable[[], Iterable[Sequence[str]]],
        can_do: Callable[[str], bool],
        commands: Sequence[Command] = (),
    ) -> None:
        self._words = words
        self._places = places
        self._can_do = can_do
        self._commands_here = (*COMMANDS, *commands)

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterable[Completion]:
        """Commands as they are typed; everything else only when Tab asks for it."""
        text = document.text_before_cursor
        if text.startswith("/") and " " not in text:
            yield from self._commands(text)
        elif complete_event.text_inserted:
            return
        elif text.startswith("/"):
            yield from self._arguments(text, complete_event)
        else:
            yield from self._sayings(text)

    def _commands(self, text: str) -> Iterable[Completion]:
        for command in self._commands_here:
            if f"/{command.name}".startswith(text.casefold()):
                meta = self._words.say(command.help_code)
                yield Completion(f"/{command.name}", -len(text), display_meta=meta)

    def _arguments(self, text: str, event: CompleteEvent) -> Iterable[Completion]:
        """Offer what a command takes: a file, or one of the words that it lists."""
        name, _, argument = text[1:].partition(" ")
        takes = BY_NAME[name.casefold()].takes if name.casefold() in BY_NAME else ""
        if takes == "FILE":
            yield from _PATHS.get_completions(Document(argument), event)
        else:
            typed = argument.rpartition(" ")[2]
            words = (word for word in _WORD.findall(takes) if word.startswith(typed.casefold()))
            yield from (Completion(word, -len(typed)) for word in words)

    def _sayings(self, text: str) -> Iterable[Completion]:
        """Offer what is begun; where nothing is, what may follow. Of a place with several names, one of them."""
        is_empty = not text.strip()
        language = self._words.language if is_empty else language_of(text, self._words.language)
        phrases = [(phrase,) for phrase in phrases_of(*((language,) if is_empty else REPLY_LANGUAGES))]
        places = [by_language(names, language) for names in self._places()]
        begun = [ending for names in (*phrases, *places) if (ending := _begun(text, names))]
        is_within_word = text[-1:].isascii() and text[-1:].isalnum()
        if not begun and not is_within_word:
            begun = [(names[0], 0) for names in (*(phrases if is_empty else ()), *places)]
        for name, size in begun:
            if self._is_understood(text[: len(text) - size], name):
                yield Completion(name, -size)

    def _is_understood(self, before: str, name: str) -> bool:
        """Tell whether the whole is understood; within a sentence a phrase begins a clause."""
        if not before.strip():
            return True
        if name in phrases_of(*REPLY_LANGUAGES) and not ends_clause(before):
            return False
        place = next((names[0] for names in self._places()), "") if name in _before_name() else ""
        return self._can_do(f"{before}{name} {place}".strip())


def _begun(text: str, names: Sequence[str]) -> tuple[str, int] | None:
    """Return the first name whose beginning `text` ends with, and how much of it; None where one is there whole."""
    if any(_size_of_beginning(text, f"{name} ") == len(name) for name in names):
        return None
    return next(((name, size) for name in names if (size := _size_of_beginning(text, name))), None)


def ends_clause(text: str) -> bool:
    """Tell whether another clause may begin behind it: `forward 1 m, then `."""
    units = cut(normalise(text))
    ends = (lexicon().words.get(units[-size:], ()) for size in range(1, _LONGEST_JOINT + 1))
    return units[-1:] == (",",) or any(kind in ("conn", "sep") for end in ends for kind, _ in end)


def _size_of_beginning(text: str, name: str) -> int:
    """Count the characters at the end of `text` that are the beginning of `name`, from where a word may begin."""
    typed, whole = text.casefold(), name.casefold()
    if len(whole) != len(name):
        return 0
    return next((n for n in range(min(len(whole), len(typed)), 0, -1) if _begins(typed, whole, n)), 0)


def _begins(typed: str, whole: str, char_count: int) -> bool:
    at = len(typed) - char_count
    within_word = at > 0 and typed[at - 1].isalnum() and typed[at - 1].isascii() and whole[0].isascii()
    return not within_word and char_count < len(whole) and whole.startswith(typed[at:])
