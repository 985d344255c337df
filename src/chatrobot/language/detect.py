"""Which language a text is in: it is read and answered in that."""

from __future__ import annotations

import re
from functools import lru_cache

from chatrobot.language.compiled import compiled
from chatrobot.language.context import Context
from chatrobot.language.gloss_tables import letters_of, shared_words, words_of
from chatrobot.language.interpretation import LanguageCode
from chatrobot.language.lexicon import lexicon
from chatrobot.language.normalise import MAX_CHARACTERS, has_chinese

_WORD = re.compile(r"[^\W\d_]+")


@lru_cache(maxsize=256)
def language_of(text: str, before: LanguageCode = "en") -> LanguageCode:
    """The language of `text`: that of most of its words. `before`: the one spoken before, which a tie keeps."""
    if has_chinese(text[:MAX_CHARACTERS]):
        return "zh"
    words = _WORD.findall(text[:MAX_CHARACTERS].casefold())
    german = sum(map(_is_german, words))
    if not german and before != "de":
        return "en"
    english = sum(map(_is_english, words))
    return "de" if german > english or (german == english and before == "de") else "en"


def spoken(text: str, context: Context) -> LanguageCode:
    """The language of `text`; where it may be two, that of what was said before."""
    if context.language is not None:
        return language_of(text, context.language)
    language: LanguageCode = "en"
    for turn in context.dialogue.turns:
        language = language_of(turn.text, language)
    return language_of(text, language)


def told_in(text: str, language: LanguageCode, context: Context) -> LanguageCode:
    """The language in which to ask back about `text`: without a word of English, that which was spoken before."""
    is_strange = language == "en" and not any(
        map(_is_english, _WORD.findall(text[:MAX_CHARACTERS].casefold()))
    )
    return context.language or language if is_strange else language


def _is_german(word: str) -> bool:
    """Whether a word is German and no English one."""
    only, _, letters = _words()
    return word in only or not letters.isdisjoint(word)


def _is_english(word: str) -> bool:
    """Whether a word is English and no German one."""
    return word in lexicon().known and word not in _words()[1]


@lru_cache(maxsize=1)
def _words() -> tuple[frozenset[str], frozenset[str], frozenset[str]]:
    """The words that only German has, those that English has, too, and the letters that English has not."""
    return compiled("german", _sorted)


def _sorted() -> tuple[frozenset[str], frozenset[str], frozenset[str]]:
    words, letters, english = words_of("de"), letters_of("de"), lexicon().known
    return words - english, words & english | shared_words("de"), letters
