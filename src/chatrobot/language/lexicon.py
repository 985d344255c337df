"""All known words of all languages in one trie-like table, looked up by what they are written as.

Both languages share one table, since people mix them ("CW 转一圈半"). A word means one or several
`(kind, value)` pairs. Where one writing is listed twice, the earlier file of `FILES` decides.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from chatrobot.language.compiled import Key, PhraseTable, by_first, compiled
from chatrobot.language.data_files import LANGUAGES, expand, load_table
from chatrobot.language.normalise import COMMA

FILES = (
    "numbers", "units", "motion", "shapes", "dialogue", "refusals", "corrections", "asides", "compass",
    "filler",
)  # fmt: skip
UNIT = re.compile(
    r"\d+(?:,\d{3})+(?:\.\d+)?(?![\d,])|\d*\.?\d+(?:e[+-]?\d+)?(?![\d])|[a-zà-ÿ]+(?:'[a-z]+)*|\S|\n"
)
"""What text is cut into before words are looked up: a number, a Latin word, or a single character."""

_NO_WORDS = frozenset({"speaker", "clues", "convention"})
"""Tables beside the word classes: patterns, and words that are listed elsewhere."""
_NEVER_MEANT = frozenset(
    {
        "refuse",
        "filler",
        "glue",
        "reason",
        "doubt",
        "condition",
        "negation",
        "correction",
        "conn",
        "operator",
        "sep",
        "unknown",
    }
)
_POLITE = frozenset({"please", "then", "after", "robot", "thanks", "could", "would", "until"})
Meaning = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Lexicon:
    """`words` maps a written form, cut into units, to its meaning; `longest` is by the first unit.

    `guesses` holds what a speech recogniser writes for a word: looked up where the word itself is not found.
    A typo is only mended towards `core`. `latin` are single Latin words in any phrase; `known` has ordinary
    words besides, in which no typo is seen.
    """

    words: PhraseTable[Meaning]
    guesses: PhraseTable[Meaning]
    longest: dict[str, int]
    core: frozenset[str]
    latin: frozenset[str]
    known: frozenset[str]
    before_unit: dict[str, float]


_SIGN = re.compile(r"(?<![0-9a-z_)])[-](?=\.?\d)")
_LISTED = re.compile(
    r"(?:^|(?<=[\s;,.]))\(?[1-9]\)\s*|(?:^|(?<=\n)|(?<=[;,.] )|(?<=[\u4e00-\u9fff°] ))[1-9][.)] ?(?=[^\d\s])"
)
_FOLD = re.compile(
    r"((?:\d|[一二两三四五六七八九十百半]) ?(?:厘米|公分|米|度|秒|圈|cm|mm|m|s|°|deg)) ?"
    r"[x*] ?(\d{1,2})(?= ?(?:$|[;,!。]))"
)
_INCHES, _FEET = re.compile(r"(\d)\s?\""), re.compile(r"(\d)\s?'(?![a-z])")
_ORDINAL = re.compile(r"(\d+)(?:st|nd|rd|th)\b")


def cut(text: str) -> Key:
    """The units of a normalised text. A hyphen before a number is a sign, any other is a space."""
    text = _LISTED.sub(" ; ", text)
    if text.count('"') == 1 or (text.count("'") == 1 and _FEET.search(text)):
        text = _FEET.sub(r"\1 feet ", _INCHES.sub(r"\1 inches ", text))
    text = _FOLD.sub(r"\1, \2 times", COMMA.sub(".", text))
    return tuple(UNIT.findall(_ORDINAL.sub(r"\1", _SIGN.sub(" minus ", text)).replace("-", " ")))


@lru_cache(maxsize=1)
def lexicon() -> Lexicon:
    """The words of every language, read once."""
    words, guesses, *others = compiled("lexicon", _parts)
    return Lexicon(PhraseTable(words), PhraseTable(guesses), *others)


def _parts() -> tuple[Any, ...]:
    """The fields of the lexicon, from the data files."""
    words: dict[Key, Meaning] = {}
    for name in FILES:
        for language in LANGUAGES:
            for kind, table in load_table(language, name).items():
                if kind in _NO_WORDS:
                    continue
                for value, patterns in table.items():
                    for key in _keys(patterns):
                        words.setdefault(key, _meaning(kind, value))
    guesses = _guesses(words)
    longest: dict[str, int] = {}
    for key in (*words, *guesses):
        longest[key[0]] = max(longest.get(key[0], 0), len(key))
    latin = frozenset(unit for key in words for unit in key if unit[0].isalpha() and unit.isascii())
    core = frozenset(
        unit
        for key, meaning in words.items()
        if meaning[0][0] not in _NEVER_MEANT
        for unit in key
        if unit[0].isalpha() and unit.isascii()
    )
    ordinary = frozenset(
        word for name in ("words", "real_words") for word in str(load_table("en", name)["words"]).split()
    )
    before = {
        word: float(value)
        for value, listed in load_table("en", "homophones")["before_unit"].items()
        for word in listed
    }
    return by_first(words), by_first(guesses), longest, core | _POLITE, latin, latin | ordinary, before


def _keys(patterns: list[str]) -> list[Key]:
    return [key for pattern in patterns for written in expand(pattern) if (key := _cut_plain(written))]


def _cut_plain(written: str) -> Key:
    """`cut`, by the short way where there are only Latin letters: most of the data, read at every start."""
    words = written.split()
    return tuple(words) if written.isascii() and "".join(words).isalpha() else cut(written)


def _meaning(kind: str, value: str) -> Meaning:
    if kind != "combo":
        return ((kind, value),)
    return tuple((part.split(".", 1)[0], part.split(".", 1)[1]) for part in value.split())


def _guesses(words: dict[Key, Meaning]) -> dict[Key, Meaning]:
    guesses: dict[Key, Meaning] = {}
    for word, heard in load_table("en", "homophones")["words"].items():
        for written in heard:
            if cut(word) in words and cut(written) not in words:
                guesses[cut(written)] = words[cut(word)]
    sounds: dict[str, Any] = load_table("zh", "homophones")["characters"]
    for key, meaning in list(words.items()):
        if not 2 <= len(key) <= 4 or meaning[0][0] in ("filler", "glue", "reason", "doubt", "conn"):
            continue
        for i, character in enumerate(key):
            for other in sounds.get(character, ""):
                variant = (*key[:i], other, *key[i + 1 :])
                if variant not in words:
                    guesses.setdefault(variant, meaning)
    return guesses
