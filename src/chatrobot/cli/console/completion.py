"""What Tab completes: commands, places and the words one often begins with."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping

from prompt_toolkit.completion import CompleteEvent, Completer, Completion
from prompt_toolkit.document import Document

from chatrobot.cli.console.commands import COMMANDS
from chatrobot.cli.console.words import Words

COMMON: Mapping[str, tuple[str, ...]] = {
    "en": (
        *("forward", "backward", "turn left", "turn right", "turn around", "go to the", "come back"),
        *("drive in a square of one metre", "draw a circle", "face the other way", "remember this place as"),
        *("stop", "undo", "redo", "again", "faster", "slower"),
    ),
    "zh": (
        *("前进", "后退", "左转", "右转", "掉头", "去", "回来", "停", "再来一次", "撤销", "重做"),
        *("走一个正方形", "画一个圆", "记住这里叫"),
    ),
}
_HAN_TAIL = re.compile(r"[\u4e00-\u9fff]+$")
_WORD_TAIL = re.compile(r"[^\s,;，；。、]+$")


class ChatCompleter(Completer):
    """Completes the last word.

    Args:
        place_names: every name of a place as of now.
    """

    def __init__(self, words: Words, place_names: Callable[[], Iterable[str]]) -> None:
        self._words = words
        self._place_names = place_names

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterable[Completion]:
        """Commands as they are typed; everything else only when Tab asks for it."""
        text = document.text_before_cursor
        if text.startswith("/"):
            yield from self._commands(text)
        elif complete_event.text_inserted:
            return
        elif _HAN_TAIL.search(text):
            yield from self._ending(text, ("zh",))
        else:
            yield from self._beginning(text)

    def _commands(self, text: str) -> Iterable[Completion]:
        for command in COMMANDS:
            if f"/{command.name}".startswith(text.casefold()):
                meta = self._words.say(command.help_code)
                yield Completion(f"/{command.name}", -len(text), display_meta=meta)

    def _beginning(self, text: str) -> Iterable[Completion]:
        tail = _WORD_TAIL.search(text)
        word = tail.group().casefold() if tail else ""
        begins = not text[: len(text) - len(word)].strip()
        phrases = (*COMMON["en"], *(COMMON["zh"] if not word else ())) if begins else COMMON["en"]
        for phrase in (*phrases, *self._place_names()):
            if phrase.casefold().startswith(word) and (word or begins):
                yield Completion(phrase, -len(word))

    def _ending(self, text: str, languages: tuple[str, ...]) -> Iterable[Completion]:
        """Chinese has no spaces: whatever suffix of the text begins a phrase is completed."""
        phrases = [phrase for language in languages for phrase in COMMON[language]]
        for phrase in (*phrases, *(name for name in self._place_names() if not name.isascii())):
            size = next((n for n in range(len(phrase) - 1, 0, -1) if text.endswith(phrase[:n])), 0)
            if size:
                yield Completion(phrase, -size)
